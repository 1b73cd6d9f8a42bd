"""The throughput table: how fast the quality table is measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import Encodings, Option, Plot
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME
RATE = "million/s"
STATISTICS = ("moments", "row")


@dataclass(frozen=True, kw_only=True)
class ThroughputOptions:
    """What `throughput` times. Names and counts are comma-separated."""

    encoding: Encodings = "spheremap,octahedral,spherical,xyz,per_pixel_view"
    statistics: Annotated[
        str,
        Option(
            "--statistics",
            "moments (squared error and its maximum), row (a whole row of the quality table); comma-separated, or all.",
        ),
    ] = "all"
    counts: Annotated[str, Option("--counts", "Numbers of normals, comma-separated, such as 256k,2^20.")] = "2^22"


@dataclass(frozen=True, kw_only=True)
class ThroughputOutputs:
    """What `throughput` writes beside its rows."""

    plot: Plot = None


COLUMNS = (
    shared.ENCODING,
    Column(
        "statistics",
        "What is measured: moments are the squared error and its maximum; a row is all of the quality table's figures.",
        KEY,
    ),
    Column("count", "Normals, rounded down to whole blocks.", KEY),
    Column("rate", "How many normals a second normalbench measures.", TIME, RATE, "more"),
    Column("c", "The same of a program in C, without squared errors in a row.", TIME, RATE, drops=3),
    Column("times_c", "The rate divided by that of C.", TIME, better="more"),
    Column("numpy", "The same of NumPy over whole arrays.", TIME, RATE, drops=5),
    Column("times_numpy", "The rate divided by that of NumPy over whole arrays.", TIME, better="more"),
    Column("numpy_blocked", "The same of NumPy over blocks that fit into a core's cache.", TIME, RATE, drops=6),
    Column("times_numpy_blocked", "The rate divided by that of NumPy over blocks.", TIME, better="more", drops=4),
    Column("reading", "How many normals a second are read and added up by C: the limit.", TIME, RATE, drops=7),
    Column("share_of_reading", "The rate divided by that of reading.", TIME, better="more", drops=2),
    Column("no_c", "Why there is no rate of C.", HOW, drops=1),
    Column("compiler", "The C compiler.", HOW, drops=8),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    name="throughput",
    package=__package__ or "",
    group=Group.MACHINE,
    help="How fast rows are measured, next to a C program, NumPy and reading the input.\n\n"
    "All of them encode, store in UNORM of 8 bits, decode and measure the same normals, on all cores in one run, and "
    "take turns.",
    example="normalbench throughput --encoding octahedral --counts 2^18,2^20",
    options=ThroughputOptions,
    outputs=ThroughputOutputs,
    columns=COLUMNS,
    usual=({},),
    single={"encoding": "octahedral", "statistics": "moments", "counts": "2^18"},
    by="statistics",
    in_all=False,
    section=Section(
        title="How fast normals are measured",
        short="Throughput",
        intro="How long does a sweep take on this machine, and how far is it from what the machine can do?",
        method="Random directions in memory are encoded, stored in UNORM of 8 bits, decoded and measured, on all "
        "cores. The fastest of at least three repeats counts. Normalbench and C take turns, so that whatever else the "
        "machine does slows both. C is compiled with -O3 -march=native -ffast-math -fopenmp, which allows it to round "
        "otherwise. Normalbench compiles its own functions, without these liberties, with the same compiler from 2^22 "
        "normals on.",
    ),
)
