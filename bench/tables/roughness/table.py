"""The roughness table: what a normal code does to reflections, from mirrors to dull surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Encodings, Option, Plot, Roundings, Size, StorageNames
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class RoughnessOptions(SourceOptions):
    """Options of `roughness`. Names and numbers are comma-separated."""

    encoding: Encodings = ("octahedral",)
    storage: StorageNames = ("rg8", "rgb10a2", "rgb8_12_12", "rg16")
    rounding: Roundings = ("nearest",)
    object: Annotated[Names, Option("--object", "sphere, panel20, panel4, plaster; comma-separated, or all.")] = (
        "all",
    )
    environment: Annotated[
        Names,
        Option("--environment", "studio, strips, lamp, sky, or .hdr and .exr files; comma-separated.", files=True),
    ] = ("studio", "strips", "lamp")
    threshold: Annotated[
        Names, Option("--threshold", "FLIP's 99th percentile that a code may have, comma-separated.")
    ] = ("0.1", "0.05")
    size: Size = "256x256"
    dither: Annotated[
        Names, Option("--dither", "Noise before rounding, besides none: still, moving; comma-separated, or all.")
    ] = ("none",)
    frames: Annotated[
        Names | None,
        Option("--frames", "Frames whose mean a picture is, comma-separated. Default: 1; with --dither 1,8."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class RoughnessOutputs:
    """Outputs of `roughness` other than its rows."""

    plot: Plot = None


COLUMNS = (
    shared.ENCODING,
    shared.STORAGE,
    Column("rounding", "How the storage rounds.", KEY, drops=5),
    Column(
        "dither",
        "Noise of a whole step that is added to a code before it is rounded: none; still, the same in each frame; "
        "moving, another one in each.",
        KEY,
        drops=5,
    ),
    Column(
        "frames",
        "How many frames a picture is the mean of, each seen from its own place within a pixel; 1: from the middle.",
        KEY,
        drops=5,
    ),
    Column(
        "threshold",
        "In a row of a least roughness: FLIP's 99th percentile that is kept from there on. Empty in the rows of single "
        "pictures.",
        KEY,
    ),
    Column(
        "object",
        "What fills the picture: a metal sphere; metal panels whose normal turns by 20 or by 4 degrees across it; a "
        "sphere of white plaster.",
        KEY,
    ),
    Column("environment", "What it reflects; plaster lies in the light of a sun.", KEY),
    Column(
        "roughness",
        "Perceptual roughness, 0 for a mirror; of a least roughness, to 0.01. Empty there: none is enough.",
        KEY,
    ),
    Column(
        "decides",
        "Set in a row of a least roughness whose object and environment need the most of its code.",
        Role.RAW,
        shown=False,
    ),
    Column("bits", shared.BITS.says, drops=9),
    Column("psnr_db", "Of the displayed image, over the object's pixels.", unit="dB", better="more"),
    Column("flip", "FLIP's mean over the object's pixels, at 67 pixels a degree.", better="less", drops=6),
    Column(
        "flip_p99",
        "FLIP's 99th percentile over the object's pixels: 0.1 is a grey off by 5 to 6 of 255, 0.05 one off by 2.",
        better="less",
    ),
    Column("off_percent", "Share of the object's pixels that are off by more than 1 of 255.", unit="%", better="less"),
    Column("largest", "Largest difference of a channel, of 255.", better="less", drops=7),
    Column("exposure", "Light is multiplied by 2 to this power before it is shown.", HOW, "stops", drops=4),
    Column("tone_mapping", "How light beyond 1 is shown.", HOW, drops=4),
    Column("environment_size", "Texels of the environment, and what was done to it.", HOW, drops=4),
    Column("size", "Width and height of the image in pixels.", HOW, drops=4),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Find the lowest roughness at which banding is acceptable.\n\nA sphere and two panels of a metal that "
    "reflects all light fill the picture one by one, under three environments, and a sphere of white plaster "
    "in the sun. A code carries a roughness where FLIP's 99th percentile is at most --threshold there and at "
    "every greater roughness, on the worst of objects and environments. 0.1 is what we call acceptable and "
    "0.05 invisible: both are conventions.",
    example="normalbench roughness --storage rg8,rgb10a2 --environment studio",
    step_s=2.5,
    options=RoughnessOptions,
    outputs=RoughnessOutputs,
    columns=COLUMNS,
    single={"storage": "rg8", "object": "panel20", "environment": "studio", "threshold": "0.1"},
    group=Group.MEASURE,
    # Of metals and environments those that decide, and plaster: each other one needs less of every code.
    usual=({"object": "panel20,panel4,plaster", "environment": "studio,lamp"},),
    section=Section(
        title="What reflections need",
        short="Roughness",
        view=View.CHOOSE,
        intro="A mirror shows each step of a normal's code as a band; a dull surface hides them. From which roughness "
        "on does a code carry reflections?",
        method="A sphere and two slowly turning panels of a perfect metal fill the picture one by one, under each "
        "environment, and a sphere of white plaster (F0 0.04) in the light of one sun. The picture with the code's "
        "normals is compared with the one of exact normals, as displayed, at 24 roughnesses. The least roughness of a "
        "code is found to 0.01 by drawing at the crossing.",
    ),
)
