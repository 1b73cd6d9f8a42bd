"""Wording shared by the verdicts of several tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

from .table import Row

# Errors that differ by less than half a decibel are a tie.
TIE = 10 ** (0.5 / 20)
# The most names of a tie that a sentence lists.
MOST_TIED = 3


def best_by_bits(rows: Iterable[Row], figure: str, bits: str = "bits") -> list[list[Row]]:
    """Return, for each bit count, the row with the smallest figure and the rows that tie with it, best first. Bit
    counts whose best row does not beat all smaller bit counts are left out.

    Args:
        figure: the column with the error.
        bits: the column with the bit count.
    """
    groups: dict[float, list[Row]] = {}
    for row in sorted((row for row in rows if row[bits]), key=lambda row: (row[bits], row[figure])):
        groups.setdefault(row[bits], []).append(row)
    best: list[list[Row]] = []
    smallest = math.inf
    for group in groups.values():
        if group[0][figure] < smallest:
            smallest = group[0][figure]
            best.append([row for row in group if row[figure] <= smallest * TIE])
    return best


def by_bits(rows: Iterable[Row], figure: str, told: Callable[[Row], str], bits: str = "bits") -> str:
    """Return the most accurate codecs for each bit count as text: "octahedral in rg8 at 16 bits (0.336°), …".

    Args:
        told: a function from a row to the text in parentheses.
    """
    best = best_by_bits(rows, figure, bits)
    return ", ".join(f"{codecs(tied, alternatives)} at {tied[0][bits]:g} bits ({told(tied[0])})" for tied in best)


def codec_name(row: Row) -> str:
    """Return the name of a row's codec for use in a sentence."""
    rounding = row.get("rounding") or "nearest"
    encoding = row.get("encoding") or row.get("depth")
    return f"{encoding} in {row['storage']}" + (f" ({rounding})" if rounding != "nearest" else "")


def codecs(rows: Sequence[Row], joined: Callable[[Iterable[str]], str]) -> str:
    """Return the names of the rows' codecs for use in a sentence; a storage that all of them share is named once."""
    shared = {(row["storage"], row.get("rounding") or "nearest") for row in rows}
    if len(rows) == 1 or shared != {(rows[0]["storage"], "nearest")}:
        return joined(map(codec_name, rows))
    return f"{joined(row.get('encoding') or row['depth'] for row in rows)} in {rows[0]['storage']}"


def alternatives(names: Iterable[str]) -> str:
    """Return names as alternatives: "a, b or c"; if there are many, the first and the number of the others."""
    known = list(dict.fromkeys(names))
    if len(known) > MOST_TIED:
        return f"{known[0]} or {len(known) - 1} others that tie"
    return _listed(known, "or")


def listed(names: Iterable[str]) -> str:
    """Return names for use in a sentence: "a, b and c"."""
    return _listed(list(dict.fromkeys(names)), "and")


def _listed(names: Sequence[str], last: str) -> str:
    return f" {last} ".join(filter(None, (", ".join(names[:-1]), names[-1]))) if names else "none"
