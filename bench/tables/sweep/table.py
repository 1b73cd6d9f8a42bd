"""The sweep table: how the cost of each pipeline's passes grows with the number of objects."""

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
    """Options for `sweep`. Names and counts are comma-separated; each pipeline's published layout is the default."""

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
    Column("layout", "The layout of the G-buffer.", KEY, drops=6),
    Column("holds", "Contents of the layout's targets.", HOW, drops=3),
    Column("light_buffer", "The encoding of the light buffer.", KEY, drops=5),
    shared.LIGHT_TARGETS,
    shared.SCALE,
    shared.SCENE,
    Column("objects", "Number of objects in the scene.", KEY),
    Column("lights", "Number of point lights.", KEY),
    shared.SHADOW,
    Column("size", "Width and height in pixels.", KEY),
    Column("samples", "Samples per pixel that the device used.", KEY),
    shared.SAMPLES_ASKED,
    Column("repeats", "Number of frames that the median is taken over.", HOW, drops=8),
    shared.SCENE_SEED,
    shared.DEVICE,
    Column("ms_frame", "Median milliseconds per frame.", TIME, "ms", "less"),
    Column("ms_frame_spread", "Interquartile range of the frame times.", TIME, "ms"),
    Column("ms_frame_each", "Milliseconds of each frame.", Role.RAW, "ms", shown=False),
    Column("ms_*", "Median milliseconds of that pass.", TIME, "ms", "less", drops=9),
    Column("ms_*_spread", "Interquartile range of that pass.", TIME, "ms"),
    Column("triangles", "Triangles per frame that reach the rasteriser; light volumes count twice.", better="less"),
    Column(
        "triangles_*",
        "Triangles of that pass; light volumes count twice, because they are marked and then shaded.",
        better="less",
        drops=10,
    ),
    Column(
        "clock",
        "Clock that measured the time. Times of a software rasteriser compare passes; they are not GPU times.",
        HOW,
        drops=2,
    ),
)

TABLE = Table(
    package=__package__ or "",
    help="Measure the passes of each pipeline by number of objects.",
    example="normalbench sweep --objects 100,200 --size 320x240 --repeats 1 -o sweep.csv",
    options=SweepOptions,
    outputs=SweepOutputs,
    columns=COLUMNS,
    in_all=False,
    usual=({"pipeline": "all", "objects": "200", "shadow": "on", "size": "auto", "scale": 1.0, "repeats": 9},),
    single={"pipeline": "deferred", "objects": "100", "shadow": "on", "size": "320x240", "repeats": 1},
    section=Section(
        title="Pass times",
        short="Passes",
        intro="A frame of each pipeline in the layout that it was published with: where do its milliseconds go?",
        method="Times are medians over repeated frames after a warm-up; the spread is the interquartile range. A GPU "
        "is timed by timer queries, a software rasteriser by a clock around each finished pass. Its times compare "
        "passes with each other and are not GPU times. The clock is named below.",
    ),
)
