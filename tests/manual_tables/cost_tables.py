"""The tables of instruction counts, valid for one version of a compiler: docs/cost.md and docs/vendors.md."""

from collections.abc import Sequence
from typing import Any

from .measuring import arithmetic_apart
from .table import Column, Line, Table, key

BY_COST = "xyz,xy,stereographic,spheremap,octahedral,spherical,per_pixel_view,best_fit"
FRAGMENT, WAYS = "{}, fragment", ("encode", "decode")


def counted(title: str, operation: str, family: str, name: str = "instructions", **more: str) -> Column:
    of = {"operation": operation, "family": family} | more
    # A mean over loops of different lengths is shown as a whole number.
    return Column(title, name, of, "{:.0f}".format, abs=0.5, is_counted=True)


def both_ways(first: tuple[str, str], *others: tuple[str, str]) -> tuple[Column, ...]:
    """Return a column for each title and family, to encode and to decode."""
    return tuple(
        counted(f"{way}: {title}" if (title, family) == first else title, way, family)
        for way in WAYS
        for title, family in (first, *others)
    )


def count_table(marker: str, encodings: str, words: str, title: str, columns: Sequence[Column], **more: Any) -> Table:
    rows = (f"cost --isa {words} --encoding {encodings}",)
    return Table(f"normalbench cost{marker}", rows, (key(title, "encoding"), *columns), lines=encodings, **more)


def the_loop_is_as_told(lines: list[Line]) -> None:
    """Check for 57 instructions, 38 of them in one loop: docs/cost.md computes how many run."""
    (loop,) = [line for line in lines if line[0] == "best_fit_searched"]
    assert (loop[1], *loop[-2:]) == (57, 38, 1)


COST_TABLES = (
    count_table(
        "",
        "xyz,xy,spheremap,stereographic,octahedral,spherical,per_pixel_view,best_fit",
        "--family polaris10,navi31 --stage fragment --article",
        FRAGMENT,
        [
            column
            for way in WAYS
            for column in (
                Column(f"{way}: article", "instructions", {"operation": way, "compiler": "ps_3_0 by d3dx9_42"}),
                counted("Polaris", way, "polaris10"),
                counted("Navi 3x", way, "navi31"),
            )
        ],
        needs=("radv",),
    ),
    count_table(
        " vendors",
        BY_COST,
        "--family navi31,skl,dg2 --stage fragment --storage rgba8",
        FRAGMENT,
        both_ways(("Navi 3x", "navi31"), ("Skylake", "skl"), ("Arc", "dg2")),
        needs=("intel",),
    ),
    count_table(
        " half",
        "spheremap,octahedral,spherical,best_fit_searched",
        "--arithmetic all --family navi21,skl --stage fragment --storage rgba8",
        FRAGMENT,
        [
            *(
                counted(title, way, family, arithmetic=arithmetic)
                for way in WAYS
                for family, in_floats in (("navi21", f"{way}: Navi 2x"), ("skl", "Skylake"))
                for arithmetic, title in (("float", in_floats), ("half", "half floats"))
            ),
            *(counted("", "encode", "navi21", name, arithmetic="float") for name in ("looped", "loops")),
        ],
        needs=("intel",),
        gather=arithmetic_apart,
        unshown=("best_fit_searched",),
        holds=the_loop_is_as_told,
    ),
    count_table(
        " nvidia",
        BY_COST,
        "--family navi31,dg2,sm_75,sm_86,sm_120 --stage compute --storage rgba8",
        "compute",
        both_ways(
            ("Navi 3x", "navi31"), ("Arc", "dg2"), ("Turing", "sm_75"), ("Ampere", "sm_86"), ("Blackwell", "sm_120")
        ),
        needs=("intel", "nvidia"),
    ),
)
