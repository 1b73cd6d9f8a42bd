"""Columns that mean the same in several tables. Imports nothing heavy."""

from __future__ import annotations

from dataclasses import replace

from .table import Column, Role

ENCODING = Column("encoding", "How a normal becomes a few numbers.", Role.KEY)
STORAGE = Column("storage", "The texel format that the numbers are stored in.", Role.KEY)
ROUNDING = Column("rounding", "How the storage rounds.", Role.KEY)
ROUNDING_OR_DITHERED = Column(
    "rounding", "How the numbers are rounded; dithered adds blue noise of a step before the nearest.", Role.KEY
)
# Of tables that rounded to the nearest alone before they had the column.
ROUNDING_NOW_SAID = replace(ROUNDING_OR_DITHERED, before="nearest")
BACKEND = Column(
    "backend", "jax emulates the storage; glsl encodes in a shader into the real target and decodes from it.", Role.KEY
)
BITS = Column(
    "bits",
    "Bits that the code occupies: all bits of the channels that it uses, and a bit for each sign kept elsewhere.",
)
CODE_SPACE = Column(
    "code_space",
    "The space that a file's normals were encoded in: view, world, or object, as those of vertices and points are.",
    Role.HOW,
    drops=9,
)
PIPELINE = Column("pipeline", "The order of passes that rendered it.", Role.KEY)
LIGHT_TARGETS = Column(
    "light_targets", "2: diffuse and specular light; 1: diffuse, and the luminance of the specular.", Role.KEY, drops=4
)
SCENE = Column("scene", "What was rendered.", Role.KEY)
SHADOW = Column("shadow", "Whether the sun's shadow map was drawn.", Role.KEY)
SCALE = Column("scale", "Size of inferred's buffers relative to the image's.", Role.KEY)
SAMPLES_ASKED = Column("samples_asked", "Samples per pixel that were asked for.", Role.HOW)
SCENE_SEED = Column("seed", "The random seed of the scene.", Role.HOW, drops=7)
CODES = Column("codes", "How many codes there are: every value that the stored numbers can take.", Role.HOW, drops=4)
REACHED = (
    Column("reached_mean_percent", "The bound's share of the mean; 100 is ideal.", unit="%", better="more", drops=6),
    Column("reached_rms_percent", "The bound's share of the RMS; 100 is ideal.", unit="%", better="more"),
    Column("reached_max_percent", "The bound's share of the maximum; 100 is ideal.", unit="%", better="more", drops=5),
)
BELOW_LIMIT = Column(
    "below_limit",
    "Set when the error is below the theoretical minimum, which means the measurement is wrong.",
    Role.RAW,
    shown=False,
)
MSE = Column("mse", "Mean squared error of the displayed image.", better="less", drops=8)
EXACT = Column("exact", "Whether no error is left at all.", Role.RAW, shown=False)
DEVICE = Column(
    "device", "What it was measured on, and the variables of JAX and Mesa that were set meanwhile.", Role.HOW, drops=1
)
ROUNDED_BY = Column(
    "rounded_by",
    "emulation; device, where the GL device rounds as asked; shader, where it does not and the shader rounds first.",
    Role.HOW,
    drops=2,
)
SEED = Column("seed", "The random seed.", Role.HOW, drops=8)
SKIPPED = Column("skipped", "Why there are no figures.", Role.REASON, shown=False)
ANGLE_COUNTS = Column(
    "angle_counts",
    "A histogram of the angles, `from:count`, eight bins an octave.",
    Role.RAW,
    shown=False,
    is_histogram=True,
)
