"""The effects table: what a code of the G-buffer does to effects that read it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ...ground.options.option import (
    NAMED,
    Images,
    Layouts,
    Lights,
    Objects,
    Option,
    Pipelines,
    Repeats,
    RoundingsAndDithered,
    Seed,
    Size,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME
# What a run measures: the best of each kind, and the worst of those that ship.
USUAL = ("octahedral", "spheremap", "xyz_largest", "xyz")
DEPTHS = ("linear/packed16", "window/depth24", "window/depth32f")


@dataclass(frozen=True, kw_only=True)
class EffectsOptions(SourceOptions):
    """Options for what `effects` measures. Names are comma-separated."""

    effect: Annotated[
        Names,
        Option(
            "--effect",
            "Effects to measure, each alone, with settings: gtao:size=half; comma-separated, or all.",
            in_run=True,
        ),
    ] = ("all",)
    pipeline: Pipelines = ("hybrid",)
    encoding: Annotated[
        Names | None,
        Option("--encoding", "Encodings or files, each in an exact layout; comma-separated, or all.", True, True),
    ] = None
    storage: Annotated[Names, Option("--storage", f"Storages of the codes, {NAMED}.", in_run=True)] = ("rgba8",)
    rounding: RoundingsAndDithered = ("nearest",)
    depth: Annotated[
        Names | None,
        Option(
            "--depth", f"Depth codes as CODE/STORAGE, each in an exact layout, or none. Default: {','.join(DEPTHS)}."
        ),
    ] = None
    layout: Layouts = None
    scene: Annotated[
        Names | None,
        Option("--scene", "Scenes, mesh or frame files. Default: what shows the effect.", files=True, in_run=True),
    ] = None
    size: Size = "320x240"
    objects: Objects = 200
    lights: Lights = 16
    rays: Annotated[int, Option("--rays", "Rays for each of 4096 pixels, for the method's own error; 0 for none.")] = (
        256
    )
    repeats: Repeats = 0
    seed: Seed = 0
    flip: Annotated[bool, Option("--flip", "FLIP as well, a perceptual difference; a second a row.", in_run=True)] = (
        False
    )


@dataclass(frozen=True, kw_only=True)
class EffectsOutputs:
    """Files that `effects` writes besides its rows."""

    images: Images = None


COLUMNS = (
    Column("effect", "What reads the G-buffer, with the settings that are not as usual.", KEY),
    shared.PIPELINE,
    shared.SCENE,
    Column("layout", "Which bits of which targets hold what.", KEY, drops=11),
    shared.ENCODING,
    shared.STORAGE,
    replace(shared.ROUNDING_OR_DITHERED, drops=4),
    Column("depth", "The depth code in an exact layout; empty: 32-bit floats, or the layout's own.", KEY),
    Column("normal_bits", "Bits of the normal's code.", drops=9),
    Column(
        "effect_psnr_db",
        "The effect's own image against that from a G-buffer in 32-bit floats, with the same noise and the same taps; "
        "where the effect is (skin, water, pixels whose rays meet something, else every surface). Peak 1: full "
        "visibility, or the display's white.",
        unit="dB",
        better="more",
    ),
    Column("effect_rms", "Root of the mean squared difference of the two, in the effect's own unit.", better="less"),
    Column("effect_mean", "Their mean absolute difference.", better="less", drops=6),
    Column("effect_max", "Their largest difference, of any channel.", better="less"),
    Column(
        "moved_percent",
        "Of the pixels whose ray meets something where the G-buffer is exact, the share whose ray meets nothing, or "
        "something more than a pixel away. Each pixel's first ray counts. Empty for effects without rays.",
        unit="%",
        better="less",
        drops=5,
    ),
    Column(
        "method_rms",
        "How far the effect is from ray casting where the G-buffer is exact, RMS. A code whose effect_rms is far below "
        "it does not matter. Empty where no rays can say.",
        better="less",
    ),
    Column("method_mean", "The mean of that difference; above 0 the method is too bright.", HOW, drops=12),
    Column("slope", "Mean change of the effect for each degree that normals are off.", unit="1/degree", drops=8),
    Column("normal_mean_deg", "Mean angle of the G-buffer's normals to the exact ones.", HOW, "degrees", drops=7),
    Column("normal_max_deg", "The largest of those angles.", HOW, "degrees", drops=10),
    Column(
        "psnr_db",
        "The displayed image with the effect against the same from a G-buffer in 32-bit floats; every pixel, peak 1.",
        unit="dB",
        better="more",
    ),
    Column("flip", "NVIDIA FLIP of those images, a perceptual difference.", better="less", option="flip"),
    Column("invalid", "Pixels of the image that are NaN or infinite.", better="less", shown=False),
    Column("size", "Width and height in pixels.", HOW, drops=13),
    Column("lights", "Point lights.", HOW, drops=14),
    Column("objects", "Objects that the scene `objects` is made with.", HOW, drops=15),
    Column("ms_effect", "Milliseconds of the effect's passes together, median.", TIME, "ms", "less"),
    Column("ms_frame", "Milliseconds a frame, median over the repeats.", TIME, "ms", "less"),
    Column("ms_*", "Milliseconds of that pass, median.", TIME, "ms", "less"),
    Column("clock", "What timed it. A software rasteriser's times compare passes and are not a GPU's.", HOW, drops=2),
    shared.DEVICE,
    shared.SCENE_SEED,
    shared.EXACT,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure how much of the error reaches AO and other effects.\n\nEvery normal code lies in an otherwise "
    "exact layout, and every depth code in one with exact normals. A layout is measured as it is.",
    example="normalbench effects --effect gtao --encoding octahedral,spheremap --storage rg8,rgb10a2",
    step_s=0.8,
    options=EffectsOptions,
    outputs=EffectsOutputs,
    columns=COLUMNS,
    usual=({"effect": "gtao,ssr", "encoding": ",".join(USUAL)},),
    single={"effect": "gtao", "encoding": "octahedral", "depth": "none"},
    files={"images": "effects"},
    by="effect",
    section=Section(
        title="What reads the G-buffer",
        short="Effects",
        intro="Ambient occlusion, indirect light, reflections, skin and water read normals and depths as lights do. "
        "How much of a code's error arrives in them?",
        method="Each effect's own image from a G-buffer with one code against the same effect from a G-buffer in "
        "32-bit floats, with the same noise and the same taps. The method's own error is measured against rays "
        "through the scene, where there is an oracle.",
        parts="effect",
    ),
)
