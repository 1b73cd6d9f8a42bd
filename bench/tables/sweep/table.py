"""The sweep: how each pipeline's passes grow with the number of objects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import (
    Layouts,
    LightBuffers,
    Lights,
    LightTargets,
    Option,
    Pipelines,
    Plot,
    Repeats,
    Samples,
    Scale,
    Seed,
    Shadow,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME


@dataclass(frozen=True, kw_only=True)
class SweepOptions(SourceOptions):
    """Options of `sweep`. Names and counts are comma-separated; each pipeline's published layout is the default."""

    pipeline: Pipelines = ("prepass", "hybrid", "deferred", "inferred", "forward")
    objects: Annotated[Names, Option("--objects", "Numbers of objects, comma-separated.")] = (
        "100",
        "200",
        "500",
        "1000",
        "2000",
    )
    shadow: Shadow = ("on", "off")
    layout: Layouts = None
    light_buffer: LightBuffers = ("rgba16f",)
    light_targets: LightTargets = ("2",)
    size: Annotated[
        str,
        Option("--size", "WIDTHxHEIGHT of the image; auto: 640x480, or 320x240 on a software rasteriser."),
    ] = "1024x768"
    samples: Samples = 1
    scale: Scale = 0.5
    lights: Lights = 64
    repeats: Repeats = 5
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class SweepOutputs:
    """Outputs of `sweep` other than its rows."""

    plot: Plot = None


COLUMNS = (
    shared.PIPELINE,
    Column("layout", "Which bits of which targets hold what.", KEY, drops=6),
    Column("holds", "What the layout's targets hold.", HOW, drops=3),
    Column("light_buffer", "The code that light is added up in.", KEY, drops=5),
    shared.LIGHT_TARGETS,
    shared.SCALE,
    shared.SCENE,
    Column("objects", "Objects in the scene.", KEY),
    Column("lights", "Point lights.", KEY),
    shared.SHADOW,
    Column("size", "Width and height in pixels.", KEY),
    Column("samples", "Samples per pixel that the device gave.", KEY),
    shared.SAMPLES_ASKED,
    Column("repeats", "Frames that the median is of.", HOW, drops=8),
    shared.SCENE_SEED,
    shared.DEVICE,
    Column("ms_frame", "Milliseconds a frame, median.", TIME, "ms", "less"),
    Column("ms_frame_spread", "Distance of the frame times' quartiles.", TIME, "ms"),
    Column("ms_frame_each", "Every frame's milliseconds.", Role.RAW, "ms", shown=False),
    Column("ms_*", "Milliseconds of that pass, median.", TIME, "ms", "less", drops=9),
    Column("ms_*_spread", "Distance of that pass's quartiles.", TIME, "ms"),
    Column("triangles", "Triangles of a frame that reach the rasteriser; light volumes count twice.", better="less"),
    Column(
        "triangles_*", "Triangles of that pass; light volumes count twice, marked and shaded.", better="less", drops=10
    ),
    Column("clock", "What timed it. A software rasteriser's times compare passes and are not a GPU's.", HOW, drops=2),
)

TABLE = Table(
    package=__package__ or "",
    help="Measure the passes of each pipeline over the number of objects.",
    example="normalbench sweep --objects 100,200 --size 320x240 --repeats 1 -o sweep.csv",
    options=SweepOptions,
    outputs=SweepOutputs,
    columns=COLUMNS,
    in_all=False,
    usual=({"pipeline": "all", "objects": "200", "shadow": "on", "size": "auto", "scale": 1.0, "repeats": 9},),
    single={"pipeline": "deferred", "objects": "100", "shadow": "on", "size": "320x240", "repeats": 1},
    section=Section(
        title="What the passes take",
        short="Passes",
        intro="A frame of each pipeline in the layout that it is published with: where do its milliseconds go?",
        method="Medians over repeated frames after a warm-up; the spread is the distance of the quartiles. Timer "
        "queries "
        "on a GPU; on a software rasteriser a clock around each finished pass, which compares passes with each other "
        "and "
        "is not a GPU's time. The clock is named below.",
    ),
)
