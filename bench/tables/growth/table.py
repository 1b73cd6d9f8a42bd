"""The growth table: how the time grows with the size of what is measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated

from ...ground.options.counts import MAX_COUNT, MAX_LIGHTS, MAX_OBJECTS
from ...ground.options.option import Option, Plot
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME


@dataclass(frozen=True)
class Kind:
    """What is made larger.

    Attributes:
        says: what is timed.
        usual: the sizes where nobody names others, each ten times the one before, or near it.
        least, most: the sizes that there may be.
        draws: whether a GL device is timed.
    """

    says: str
    usual: tuple[int, ...]
    least: int
    most: int
    draws: bool = False


KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "normals": Kind("a row of the quality table", (10**6, 10**7, 10**8), 1, MAX_COUNT),
        "codecs": Kind("a quality table of 65536 normals", (4, 40, 400), 1, 10_000),
        "codes": Kind("the exact worst case of one codec", (4**7, 4**9, 4**11), 4**4, 4**12),
        "objects": Kind("a frame of the hybrid pipeline", (20, 200, 2000), 1, MAX_OBJECTS, draws=True),
        "lights": Kind("a frame of the hybrid pipeline", (10, 100, 1000), 1, MAX_LIGHTS, draws=True),
    }
)


@dataclass(frozen=True, kw_only=True)
class GrowthOptions:
    """What `growth` times. Names and sizes are comma-separated."""

    over: Annotated[str, Option("--over", f"What grows: {', '.join(KINDS)}; comma-separated, or all.")] = "all"
    sizes: Annotated[
        str | None,
        Option("--sizes", "Sizes, comma-separated, of one kind. Default: three, each about ten times the one before."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class GrowthOutputs:
    """What `growth` writes beside its rows."""

    plot: Plot = None


COLUMNS = (
    Column("over", "What grows.", KEY),
    Column("size", "How many of these there are.", KEY),
    Column("timed", "What is timed.", HOW, drops=1),
    Column("seconds", "What it takes: the fastest of several, after one to warm up; of frames the median.", TIME, "s"),
    Column("microseconds_each", "The seconds divided by the size.", TIME, "us", "less"),
    Column(
        "exponent",
        "From the next smaller size to this one the time grows as size^exponent: 1 is in proportion, 0 is not at all.",
        TIME,
        better="less",
    ),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    name="growth",
    package=__package__ or "",
    group=Group.MACHINE,
    help="How the time grows with the number of normals, codecs, codes, objects and lights.",
    example="normalbench growth --over normals --sizes 1e5,1e6",
    options=GrowthOptions,
    outputs=GrowthOutputs,
    columns=COLUMNS,
    single={"over": "normals", "sizes": "65536"},
    by="over",
    in_all=False,
    section=Section(
        title="How the time grows",
        short="Growth",
        intro="How much longer does a sweep take when it is ten times as large?",
        method="Each kind is timed at several sizes, with all else the same. A row of the quality table is octahedral "
        "in RG8 by JAX, on a uniform sphere. Codecs are taken evenly from all encodings in all storages. The worst "
        "case is that of octahedral in two numbers of equal bits. Frames are 320x240, without a shadow map, with 64 "
        "lights or 100 objects.",
    ),
)
