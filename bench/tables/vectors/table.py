"""The table of motion vectors: how exact they are in compact targets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import NAMED, Backends, Option, RoundingsAndDithered, Seed
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class VectorsOptions(SourceOptions):
    """Options of `vectors`. Names and numbers are comma-separated; the default storage is each encoding's usual one."""

    encoding: Annotated[Names, Option("--encoding", f"Motion codes or files of yours, {NAMED}.", files=True)] = ("all",)
    storage: Annotated[Names | None, Option("--storage", f"Motion storages, {NAMED}. Default: each code's usual.")] = (
        None
    )
    rounding: RoundingsAndDithered = ("nearest",)
    backend: Backends = ("jax", "glsl")
    speed: Annotated[Names, Option("--speed", "Speeds in pixels a frame, comma-separated.")] = (
        "0.05",
        "0.25",
        "1",
        "4",
        "16",
        "64",
    )
    size: Annotated[str, Option("--size", "WIDTHxHEIGHT of the image.")] = "1920x1080"
    range: Annotated[
        Names, Option("--range", "Largest motions that are kept, in screens a frame, comma-separated.")
    ] = ("1",)
    count: Annotated[int, Option("--count", "Points that move, each for 16 frames.")] = 2**12
    seed: Seed = 0


COLUMNS = (
    Column("encoding", "How a motion vector becomes two numbers.", KEY),
    shared.STORAGE,
    shared.ROUNDING_NOW_SAID,
    shared.BACKEND,
    Column(
        "range",
        "The largest motion that is kept, in screens a frame: 1 is the width of the image, or its height. Empty where "
        "floats hold the motion itself.",
        KEY,
        "screens",
        drops=5,
    ),
    Column("size", "Width and height of the image in pixels.", KEY, drops=4),
    Column(
        "speed",
        "Speed of the points in pixels a frame. It differs by up to 10 % from point to point, and by 10 % over time.",
        KEY,
        "px",
    ),
    Column("bits", "Bits of the code: those of two channels."),
    Column(
        "error_mean_px", "Mean length of the decoded motion minus the true one, in pixels.", unit="px", better="less"
    ),
    Column("error_max_px", "Largest length of that difference.", unit="px", better="less"),
    Column(
        "lost_percent",
        "Share of the motions that decode to exactly the same as no motion.",
        unit="%",
        better="less",
    ),
    Column(
        "still_px",
        "Length of the motion that no motion decodes to. Above 0, still objects drift.",
        unit="px",
        better="less",
    ),
    Column(
        "clipped_percent",
        "Share of the motions that are beyond the range along x or y, in storages that clip.",
        unit="%",
        better="less",
    ),
    Column(
        "least_px",
        "The slowest motion along an axis that decodes to something else than no motion, in the worst of the four "
        "directions.",
        unit="px",
        better="less",
    ),
    Column(
        "drift_px",
        "RMS distance, after 16 frames, between a point and the same point moved by its stored vectors. Each point "
        "turns by a fixed angle of up to 2 degrees a frame, and its speed rises and falls once by 10 %.",
        unit="px",
        better="less",
    ),
    Column("count", "Points that move, each for 16 frames.", HOW, drops=6),
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure encodings of motion vectors, in pixels.\n\nA motion is in screens a frame. Fixed-point storages "
    "keep motions up to the range. `_centred` is UNORM with an exact code for no motion, as engines store it.",
    example="normalbench vectors --encoding linear --storage rg16f,rg16,rg16_centred --backend jax",
    step_s=0.05,
    options=VectorsOptions,
    columns=COLUMNS,
    single={"encoding": "linear", "storage": "rg16f", "backend": "jax", "speed": "1"},
    section=Section(
        title="What motion vectors lose",
        short="Motion vectors",
        intro="A motion vector in a compact target: how many pixels is it off, how slow a motion is lost, and do still "
        "objects stay where they are?",
        method="Points that move in every direction, through each code in its storage: their motion vectors are "
        "encoded, stored and decoded in 16 frames. Speed and direction change a little from frame to frame, so that no "
        "single code decides. The drift is the distance of a point that follows its stored vectors to the true one.",
    ),
)
