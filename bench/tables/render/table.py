"""The render table: the effect of a codec, a layout or a light buffer on the final image of a pipeline."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import (
    Effects,
    Images,
    Layouts,
    LightBuffers,
    Lights,
    LightTargets,
    Objects,
    Option,
    Pipelines,
    Powers,
    Repeats,
    Samples,
    Scale,
    Scenes,
    Seed,
    Shadow,
    Size,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME

# What a run draws: the articles' methods, and what engines ship.
USUAL = (
    *("xyz", "xy", "spherical", "spheremap", "cryengine3", "stereographic", "per_pixel_view", "octahedral"),
    *("best_fit", "xyz_largest"),
)


@dataclass(frozen=True, kw_only=True)
class RenderOptions(SourceOptions):
    """Options of `render`. Names are comma-separated."""

    pipeline: Pipelines = ("hybrid",)
    layout: Layouts = None
    encoding: Annotated[
        Names | None,
        Option("--encoding", "Encodings or files to put into each layout, comma-separated, or all.", True, True),
    ] = None
    storage: Annotated[
        Names | None, Option("--storage", "Storages for the encodings, or all. Default: rgba8.", in_run=True)
    ] = None
    rounding: Annotated[
        Names | None,
        Option("--rounding", "nearest, truncate, truncate_half, dithered; or all. Default: nearest.", in_run=True),
    ] = None
    light_buffer: LightBuffers = ("rgba32f",)
    light_targets: LightTargets = ("2",)
    scene: Scenes = ("studio",)
    power: Powers = None
    effects: Effects = None
    shadow: Shadow = ("on",)
    exposure: Annotated[
        str | None,
        Option(
            "--exposure",
            "Exposure in stops, or auto (clip at most 1%). Default: the scene's own; auto for files.",
            in_run=True,
        ),
    ] = None
    tone_mapping: Annotated[
        str | None,
        Option("--tone-mapping", "none, reinhard or aces. Default: aces for metallic-roughness scenes.", in_run=True),
    ] = None
    environment: Annotated[
        str | None,
        Option(
            "--environment",
            "Environment that metallic-roughness scenes reflect: studio, sky, strips, lamp, or an .hdr or .exr file. "
            "Default: studio.",
            files=True,
        ),
    ] = None
    specular_antialiasing: Annotated[
        Names,
        Option(
            "--specular-antialiasing",
            "on, off: make metallic-roughness surfaces rougher where a pixel covers many normals.",
        ),
    ] = ("on",)
    least_roughness: Annotated[
        float, Option("--least-roughness", "Lowest roughness for lights. Reflections of the environment go down to 0.")
    ] = 0.045
    size: Size = "640x480"
    samples: Samples = 1
    scale: Scale = 1.0
    objects: Objects = 200
    lights: Lights = 64
    frames: Annotated[int, Option("--frames", "Number of moments to average over. 0: the scene's own number.")] = 0
    repeats: Repeats = 3
    seed: Seed = 0
    flip: Annotated[
        bool, Option("--flip", "Measure FLIP as well, a perceptual difference; takes a second per row.", in_run=True)
    ] = False


@dataclass(frozen=True, kw_only=True)
class RenderOutputs:
    """Outputs of `render` other than its rows."""

    images: Images = None


COLUMNS = (
    shared.PIPELINE,
    Column("layout", "The layout of the G-buffer.", KEY),
    shared.ENCODING,
    shared.STORAGE,
    replace(shared.ROUNDING_OR_DITHERED, drops=4),
    Column("normal_bits", "Bits of the normal's code.", drops=9),
    Column("light_buffer", "The encoding of the light buffer.", KEY),
    shared.LIGHT_TARGETS,
    shared.SCENE,
    Column("power", "Specular power of every material; empty: each material's own.", KEY, drops=7),
    Column("effects", "Effects in the image, with the settings that differ from their defaults.", KEY, drops=16),
    Column("tone_mapping", "How light above 1 is displayed; empty: it is clipped.", KEY, drops=15),
    Column(
        "environment",
        "The environment that metallic-roughness surfaces reflect, its size in texels, and how it was changed. Empty "
        "for other materials.",
        KEY,
        drops=17,
    ),
    Column(
        "specular_antialiasing",
        "Whether metallic-roughness surfaces are made rougher by the normals that a pixel covers. Empty for other "
        "materials.",
        KEY,
        drops=18,
    ),
    Column(
        "least_roughness",
        "Lowest roughness for lights, on metallic-roughness surfaces. Empty for other materials.",
        KEY,
        drops=19,
    ),
    shared.SHADOW,
    shared.SCALE,
    Column("exposure", "Exposure: light is multiplied by 2 to this power before display.", HOW, "stops", drops=14),
    Column("size", "Width and height in pixels.", HOW),
    Column("samples", "Samples per pixel that the device used, which may be more than requested.", HOW),
    shared.SAMPLES_ASKED,
    Column("lights", "Number of point lights.", HOW),
    Column("objects", "Number of objects in the scene `objects`; other scenes have their own.", HOW),
    Column("frames", "Number of moments that figures are averaged over.", HOW),
    Column("space", "The space of the normal's axes in the G-buffer: view or world.", HOW, drops=13),
    Column("not_measured", "Attributes that the layout stores and this image does not use.", HOW, drops=12),
    Column(
        "bytes_per_pixel",
        "G-buffer, light buffer (both copies if it is read), depth and stencil (5 bytes), plus 4 bytes for linear "
        "depth if the layout stores none; times the samples. Empty for an encoding in the exact layout.",
        unit="bytes",
        better="less",
    ),
    shared.MSE,
    Column(
        "psnr_db",
        "PSNR of the displayed image (clipped, sRGB, before 8 bits) against the same pipeline in 32-bit floats; "
        "every pixel, peak 1.",
        unit="dB",
        better="more",
    ),
    Column(
        "psnr_covered_db",
        "`psnr_db` over only the covered pixels, which show an opaque surface.",
        unit="dB",
        better="more",
        drops=12,
    ),
    Column(
        "clipped_percent",
        "Covered pixels of the reference with a clipped channel. Errors there are not visible.",
        unit="%",
        drops=13,
    ),
    Column(
        "black_percent",
        "Covered pixels of the reference that are black in 8 bits. Errors there are not visible.",
        unit="%",
        drops=18,
    ),
    Column("covered_percent", "Pixels with an opaque surface.", unit="%", drops=11),
    Column("flip", "NVIDIA FLIP, a perceptual difference.", better="less", option="flip"),
    Column(
        "normal_psnr_db",
        "PSNR of the normals decoded from the G-buffer, before lighting; covered pixels.",
        unit="dB",
        better="more",
    ),
    Column(
        "rank",
        "Rank by the image, among rows of the same pipeline, scene, power, light buffer and shadow.",
        better="less",
    ),
    Column("normal_rank", "Rank by the normals, among the same rows.", better="less"),
    Column(
        "invalid",
        "Pixels that are NaN or infinite; each counts as the largest possible error.",
        better="less",
        shown=False,
    ),
    Column("ms_frame", "Median milliseconds per frame over the repeats.", TIME, "ms", "less"),
    Column("ms_frame_spread", "Interquartile range of the frame times.", TIME, "ms", drops=17),
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
    help="Measure the error of the final image, against 32-bit floats.\n\nWithout --layout every encoding is "
    "measured in rgba8, in an otherwise exact G-buffer. With --layout and none of --encoding, --storage and "
    "--rounding the layouts are measured as they are.",
    example="normalbench render --encoding octahedral,spheremap --storage rg8 --scene gloss --power 47,1024",
    step_s=1.2,
    options=RenderOptions,
    outputs=RenderOutputs,
    columns=COLUMNS,
    usual=({"encoding": ",".join(USUAL), "repeats": 0},),
    single={"encoding": "octahedral"},
    files={"images": "images"},
    section=Section(
        title="Image quality",
        short="Image",
        view=View.LAYOUTS,
        intro="The same encodings in the G-buffer of an otherwise exact renderer: how far is the final image, as "
        "displayed, from an image in 32-bit floats?",
        method="Each codec's image is compared with the image of the same pipeline with every target in 32-bit "
        "floats: clipped and in sRGB before 8 bits, every pixel, averaged over the moments of the scene. A "
        "scene from a file is exposed so that at most 1% of its covered pixels are clipped.",
    ),
)
