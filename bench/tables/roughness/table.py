"""The roughness table: the effect of a normal encoding on reflections, from mirrors to dull surfaces."""

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
    """Options for `roughness`. Names and numbers are comma-separated."""

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
    threshold: Annotated[Names, Option("--threshold", "Thresholds for FLIP (99th percentile), comma-separated.")] = (
        "0.1",
        "0.05",
    )
    size: Size = "256x256"
    dither: Annotated[
        Names,
        Option("--dither", "Noise to add before rounding, besides none: still, moving; comma-separated, or all."),
    ] = ("none",)
    frames: Annotated[
        Names | None,
        Option("--frames", "Number of frames to average per image, comma-separated. Default: 1; with --dither: 1,8."),
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
        "Noise of one step, added to the code before rounding: none; still, the same in each frame; moving, "
        "different in each frame.",
        KEY,
        drops=5,
    ),
    Column(
        "frames",
        "Number of frames averaged per image, each sampled at its own place within the pixel; 1: at the centre.",
        KEY,
        drops=5,
    ),
    Column(
        "threshold",
        "The threshold for FLIP (99th percentile), in a row that gives a lowest roughness. Empty in the rows of "
        "single images.",
        KEY,
    ),
    Column(
        "object",
        "The object that fills the image: a metal sphere; a metal panel whose normal turns by 20 or by 4 degrees "
        "across it; a white plaster sphere.",
        KEY,
    ),
    Column("environment", "Environment that the object reflects. Plaster is lit by a sun.", KEY),
    Column(
        "roughness",
        "Perceptual roughness, 0 for a mirror. In a row with a threshold: the lowest acceptable roughness, to 0.01; "
        "empty if there is none.",
        KEY,
    ),
    Column(
        "decides",
        "Set in a row with a threshold if its object and environment are the most demanding for the encoding.",
        Role.RAW,
        shown=False,
    ),
    Column("bits", shared.BITS.says, drops=9),
    Column("psnr_db", "PSNR of the displayed image, over the object's pixels.", unit="dB", better="more"),
    Column("flip", "Mean FLIP over the object's pixels, at 67 pixels per degree.", better="less", drops=6),
    Column(
        "flip_p99",
        "FLIP (99th percentile) over the object's pixels: 0.1 is a grey that is off by 5 to 6 of 255, 0.05 a grey "
        "that is off by 2 of 255.",
        better="less",
    ),
    Column("off_percent", "Share of the object's pixels that are off by more than 1 of 255.", unit="%", better="less"),
    Column("largest", "Largest difference in any channel, out of 255.", better="less", drops=7),
    Column("exposure", "Exposure: light is multiplied by 2 to this power before display.", HOW, "stops", drops=4),
    Column("tone_mapping", "How light above 1 is displayed.", HOW, drops=4),
    Column("environment_size", "Size of the environment in texels, and how it was changed.", HOW, drops=4),
    Column("size", "Width and height of the image in pixels.", HOW, drops=4),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Find the lowest roughness at which banding is acceptable.\n\nAn encoding is acceptable at a roughness if "
    "FLIP (99th percentile) is at most --threshold there and at every higher roughness measured, on the worst "
    "object and environment. The objects are a sphere and two panels of perfectly reflecting metal, under three "
    "environments, and a white plaster sphere in the sun. We call 0.1 acceptable and 0.05 invisible; both are "
    "conventions.",
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
        title="Banding in reflections",
        short="Roughness",
        view=View.CHOOSE,
        intro="A mirror shows each step between codes as a band; a rough surface hides the bands. What is the lowest "
        "roughness with acceptable reflections?",
        method="A sphere and two slowly turning panels of perfectly reflecting metal fill the image in turn, under "
        "each environment; so does a white plaster sphere (F0 0.04) under one sun. The image with decoded "
        "normals is compared with the image with exact normals, as displayed, at 24 roughnesses. The lowest "
        "acceptable roughness is found to 0.01 by drawing more images near it.",
    ),
)
