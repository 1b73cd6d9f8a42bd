"""The table of motion vectors: their accuracy in compact targets."""

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
    """Options for `vectors`. Names and numbers are comma-separated; by default each encoding is measured in its usual
    storage."""

    encoding: Annotated[Names, Option("--encoding", f"Motion encodings or your own files, {NAMED}.", files=True)] = (
        "all",
    )
    storage: Annotated[
        Names | None, Option("--storage", f"Motion storages, {NAMED}. Default: each encoding's usual storage.")
    ] = None
    rounding: RoundingsAndDithered = ("nearest",)
    backend: Backends = ("jax", "glsl")
    speed: Annotated[Names, Option("--speed", "Speeds in pixels per frame, comma-separated.")] = (
        "0.05",
        "0.25",
        "1",
        "4",
        "16",
        "64",
    )
    size: Annotated[str, Option("--size", "WIDTHxHEIGHT of the image.")] = "1920x1080"
    range: Annotated[Names, Option("--range", "Largest motions to store, in screens per frame, comma-separated.")] = (
        "1",
    )
    count: Annotated[int, Option("--count", "Number of moving points; each moves for 16 frames.")] = 2**12
    seed: Seed = 0


COLUMNS = (
    Column("encoding", "How a motion vector is turned into two numbers.", KEY),
    shared.STORAGE,
    shared.ROUNDING_NOW_SAID,
    shared.BACKEND,
    Column(
        "range",
        "Largest motion that can be stored, in screens per frame: 1 is the width or height of the image. Empty for "
        "floats, which store the motion itself.",
        KEY,
        "screens",
        drops=5,
    ),
    Column("size", "Width and height of the image in pixels.", KEY, drops=4),
    Column(
        "speed",
        "Speed of the points in pixels per frame. It varies by up to 10% between points, and by 10% over time.",
        KEY,
        "px",
    ),
    Column("bits", "Bits of the code, in both channels."),
    Column(
        "error_mean_px",
        "Mean length of the difference between decoded and true motion, in pixels.",
        unit="px",
        better="less",
    ),
    Column(
        "error_max_px",
        "Largest length of the difference between decoded and true motion, in pixels.",
        unit="px",
        better="less",
    ),
    Column(
        "lost_percent",
        "Share of the motions that decode to the same vector as no motion.",
        unit="%",
        better="less",
    ),
    Column(
        "still_px",
        "Length of the decoded motion of a still object. Above 0, still objects drift.",
        unit="px",
        better="less",
    ),
    Column(
        "clipped_percent",
        "Share of the motions beyond the range along x or y, in storages that clip.",
        unit="%",
        better="less",
    ),
    Column(
        "least_px",
        "The slowest motion along an axis that decodes differently from no motion, in the worst of the four "
        "directions.",
        unit="px",
        better="less",
    ),
    Column(
        "drift_px",
        "RMS distance, after 16 frames, between a point and the same point moved by its stored vectors. Each point "
        "turns by a fixed angle of up to 2 degrees per frame, and its speed rises and falls once by 10%.",
        unit="px",
        better="less",
    ),
    Column("count", "Number of moving points; each moves for 16 frames.", HOW, drops=6),
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure encodings of motion vectors, in pixels.\n\nMotion is given in screens per frame. Fixed-point "
    "storages hold motion up to the range. `_centred` is UNORM with an exact code for no motion, as engines "
    "store it.",
    example="normalbench vectors --encoding linear --storage rg16f,rg16,rg16_centred --backend jax",
    step_s=0.05,
    options=VectorsOptions,
    columns=COLUMNS,
    single={"encoding": "linear", "storage": "rg16f", "backend": "jax", "speed": "1"},
    section=Section(
        title="Motion vector accuracy",
        short="Motion vectors",
        intro="Motion vectors in a compact target: how large is the error in pixels, how slow a motion is lost, and "
        "do still objects stay still?",
        method="Points move in every direction. For each encoding in its storage, their motion vectors are encoded, "
        "stored and decoded in 16 frames. Speed and direction change slightly from frame to frame, so that no "
        "single code decides the result. The drift is the distance between a point that follows its stored "
        "vectors and the true point.",
    ),
)
