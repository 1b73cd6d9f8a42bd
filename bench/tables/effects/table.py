"""The effects table: how encodings in the G-buffer affect effects that read it."""

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
            "Effects to measure one by one, with settings such as gtao:size=half; comma-separated, or all.",
            in_run=True,
        ),
    ] = ("all",)
    pipeline: Pipelines = ("hybrid",)
    encoding: Annotated[
        Names | None,
        Option(
            "--encoding", "Encodings or files, each in an otherwise exact layout; comma-separated, or all.", True, True
        ),
    ] = None
    storage: Annotated[Names, Option("--storage", f"Storages for the encodings, {NAMED}.", in_run=True)] = ("rgba8",)
    rounding: RoundingsAndDithered = ("nearest",)
    depth: Annotated[
        Names | None,
        Option(
            "--depth",
            f"Depth encodings as ENCODING/STORAGE, each in an exact layout, or none. Default: {','.join(DEPTHS)}.",
        ),
    ] = None
    layout: Layouts = None
    scene: Annotated[
        Names | None,
        Option(
            "--scene",
            "Scenes, mesh files or frame files. Default: a scene that shows the effect.",
            files=True,
            in_run=True,
        ),
    ] = None
    size: Size = "320x240"
    objects: Objects = 200
    lights: Lights = 16
    rays: Annotated[
        int, Option("--rays", "Rays for each of 4096 pixels, to measure the method's own error; 0 for none.")
    ] = 256
    repeats: Repeats = 0
    seed: Seed = 0
    flip: Annotated[
        bool, Option("--flip", "Measure FLIP as well, a perceptual difference; takes a second per row.", in_run=True)
    ] = False


@dataclass(frozen=True, kw_only=True)
class EffectsOutputs:
    """Files that `effects` writes besides its rows."""

    images: Images = None


COLUMNS = (
    Column("effect", "The effect, with the settings that differ from its defaults.", KEY),
    shared.PIPELINE,
    shared.SCENE,
    Column("layout", "The layout of the G-buffer.", KEY, drops=11),
    shared.ENCODING,
    shared.STORAGE,
    replace(shared.ROUNDING_OR_DITHERED, drops=4),
    Column("depth", "The depth encoding in an exact layout; empty: 32-bit floats, or the layout's own.", KEY),
    Column("normal_bits", "Bits of the normal's code.", drops=9),
    Column(
        "effect_psnr_db",
        "PSNR of the effect's own image, against the image from a G-buffer in 32-bit floats with the same noise and "
        "the same taps. It covers the pixels with the effect (skin, water, pixels whose rays meet something; for "
        "other effects every surface). Peak 1: full visibility, or the display's white.",
        unit="dB",
        better="more",
    ),
    Column(
        "effect_rms", "Root mean square difference between the two images, in the effect's own unit.", better="less"
    ),
    Column("effect_mean", "Mean absolute difference between the two images.", better="less", drops=6),
    Column("effect_max", "Largest difference between the two images in any channel.", better="less"),
    Column(
        "moved_percent",
        "Of the pixels whose ray meets something with an exact G-buffer: the share whose ray now meets nothing, or "
        "something more than a pixel away. Only each pixel's first ray counts. Empty for effects without rays.",
        unit="%",
        better="less",
        drops=5,
    ),
    Column(
        "lost_neighbours_percent",
        "Of the weight that exact normals give to a pixel's neighbours in the first pass of the denoiser's filter: the "
        "share that the decoded normals do not give. Empty for other effects.",
        unit="%",
        better="less",
        drops=5,
    ),
    Column(
        "gained_neighbours_percent",
        "Weight that only the decoded normals give to neighbours, relative to the weight that exact normals give: what "
        "is blurred more. Empty for other effects.",
        unit="%",
        better="less",
        drops=6,
    ),
    Column(
        "lost_histories_percent",
        "Of the pixels and frames whose history a denoiser keeps with exact normals: the share that it rejects with "
        "the decoded normals. Empty for other effects.",
        unit="%",
        better="less",
        drops=6,
    ),
    Column(
        "method_rms",
        "RMS difference between the effect and ray casting, with an exact G-buffer. An encoding whose effect_rms is "
        "far below this does not matter. Empty if no rays can be cast.",
        better="less",
    ),
    Column(
        "method_mean",
        "Mean difference between the effect and ray casting; above 0, the effect is too bright.",
        HOW,
        drops=12,
    ),
    Column("slope", "Mean change of the effect per degree of error in the normals.", unit="1/degree", drops=8),
    Column(
        "normal_mean_deg", "Mean angle between the G-buffer's normals and the exact normals.", HOW, "degrees", drops=7
    ),
    Column(
        "normal_max_deg",
        "Largest angle between the G-buffer's normals and the exact normals.",
        HOW,
        "degrees",
        drops=10,
    ),
    Column(
        "psnr_db",
        "PSNR of the displayed image with the effect, against the same image from a G-buffer in 32-bit floats; every "
        "pixel, peak 1.",
        unit="dB",
        better="more",
    ),
    Column("flip", "NVIDIA FLIP of the displayed images, a perceptual difference.", better="less", option="flip"),
    Column("invalid", "Pixels of the image that are NaN or infinite.", better="less", shown=False),
    Column("size", "Width and height in pixels.", HOW, drops=13),
    Column("lights", "Number of point lights.", HOW, drops=14),
    Column("objects", "Number of objects in the scene `objects`.", HOW, drops=15),
    Column("ms_effect", "Median milliseconds of the effect's passes together.", TIME, "ms", "less"),
    Column("ms_frame", "Median milliseconds per frame over the repeats.", TIME, "ms", "less"),
    Column("ms_*", "Median milliseconds of that pass.", TIME, "ms", "less"),
    Column(
        "clock",
        "Clock that measured the time. Times of a software rasteriser compare passes; they are not GPU times.",
        HOW,
        drops=2,
    ),
    shared.DEVICE,
    shared.SCENE_SEED,
    shared.EXACT,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure how much of the error reaches AO and other effects.\n\nEvery encoding of normals is measured in an "
    "otherwise exact layout, and every depth encoding with exact normals. A layout is measured as it is.",
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
        title="Accuracy of effects",
        short="Effects",
        intro="Ambient occlusion, indirect light, reflections, skin and water read normals and depths, as lights do. "
        "How much of an encoding's error reaches them?",
        method="Each effect's own image from a G-buffer with one encoding is compared with the same effect from a "
        "G-buffer in 32-bit floats, with the same noise and the same taps. The method's own error is measured "
        "against rays through the scene, if rays can be cast.",
        parts="effect",
    ),
)
