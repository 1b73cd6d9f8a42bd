"""Columns with the same meaning in several tables. Imports nothing heavy."""

from __future__ import annotations

from dataclasses import replace

from .table import Column, Role

ENCODING = Column("encoding", "How a normal is turned into numbers.", Role.KEY)
STORAGE = Column("storage", "The texel format that the numbers are stored in.", Role.KEY)
ROUNDING = Column("rounding", "How the storage rounds.", Role.KEY)
ROUNDING_OR_DITHERED = Column(
    "rounding", "How the numbers are rounded; dithered adds one step of blue noise, then rounds to nearest.", Role.KEY
)
# Of tables that rounded to the nearest alone before they had the column.
ROUNDING_NOW_SAID = replace(ROUNDING_OR_DITHERED, before="nearest")
BACKEND = Column(
    "backend", "jax emulates the storage; glsl encodes in a shader into the real target and decodes from it.", Role.KEY
)
BITS = Column(
    "bits",
    "Bits of the code: all bits of the channels that it uses, plus one for each sign that is stored elsewhere.",
)
CODE_SPACE = Column(
    "code_space",
    "The space that a file's normals were encoded in: view, world or object. Vertex and point normals are in "
    "object space.",
    Role.HOW,
    drops=9,
)
PIPELINE = Column("pipeline", "The rendering pipeline.", Role.KEY)
LIGHT_TARGETS = Column(
    "light_targets",
    "2: diffuse and specular light; 1: diffuse light and the luminance of the specular light.",
    Role.KEY,
    drops=4,
)
SCENE = Column("scene", "The scene that was rendered.", Role.KEY)
SHADOW = Column("shadow", "Whether the sun's shadow map was drawn.", Role.KEY)
SCALE = Column("scale", "Size of the buffers of `inferred`, relative to the image.", Role.KEY)
SAMPLES_ASKED = Column("samples_asked", "Requested samples per pixel.", Role.HOW)
SCENE_SEED = Column("seed", "The random seed of the scene.", Role.HOW, drops=7)
CODES = Column("codes", "Number of codes: all values that the stored numbers can take.", Role.HOW, drops=4)
REACHED = (
    Column(
        "reached_mean_percent", "The bound as a percentage of the mean; 100 is ideal.", unit="%", better="more", drops=6
    ),
    Column("reached_rms_percent", "The bound as a percentage of the RMS; 100 is ideal.", unit="%", better="more"),
    Column(
        "reached_max_percent",
        "The bound as a percentage of the maximum; 100 is ideal.",
        unit="%",
        better="more",
        drops=5,
    ),
)
BELOW_LIMIT = Column(
    "below_limit",
    "Set when the error is below the theoretical minimum, which means the measurement is wrong.",
    Role.RAW,
    shown=False,
)
MSE = Column("mse", "Mean squared error of the displayed image.", better="less", drops=8)
EXACT = Column("exact", "Whether the error is exactly 0.", Role.RAW, shown=False)
DEVICE = Column("device", "The device, and the environment variables of JAX and Mesa that were set.", Role.HOW, drops=1)
ROUNDED_BY = Column(
    "rounded_by",
    "Where rounding was done: emulation; device, if the OpenGL driver rounds as requested; shader, if it does not and "
    "the shader rounds first.",
    Role.HOW,
    drops=2,
)
SEED = Column("seed", "The random seed.", Role.HOW, drops=8)
SKIPPED = Column("skipped", "Why there are no figures.", Role.REASON, shown=False)
ANGLE_COUNTS = Column(
    "angle_counts",
    "Histogram of the angles as `from:count`, eight bins per octave.",
    Role.RAW,
    shown=False,
    is_histogram=True,
)
