"""Rows of published figures, as measured and as in the manual."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from normalbench.reports import tables

from . import sources
from .figure import DIFFERENT, UNEXPLAINED, Figure, Source

Row = dict[str, Any]
SHOWN = ("figure", "published", "ours", "unit", "verdict")


def chosen(words: str) -> list[Source]:
    """Return the sources whose names contain one of the comma-separated words, or all of them."""
    asked = [word.strip().lower() for word in words.split(",")]
    return [source for source in sources.SOURCES if any(word == "all" or word in source.name.lower() for word in asked)]


def rows(words: str = "all") -> list[Row]:
    """Return a row for each figure of the chosen sources, measured now."""
    return [_row(source, figure) for source in chosen(words) for figure in source.figures]


def _row(source: Source, figure: Figure) -> Row:
    ours = figure.ours.figure()
    return {
        "source": source.name,
        "figure": figure.what,
        "published": figure.printed,
        "ours": ours,
        "unit": figure.unit,
        "verdict": figure.verdict(ours),
        "why": figure.why or None,
        "command": figure.ours.command,
    }


def unexplained(measured: Sequence[Row]) -> list[str]:
    """Return a line for each figure that differs without a reason: ours or the source is wrong."""
    return [
        f"{row['source']}: {row['figure']}: {row['published']} {row['unit']} is published "
        f"and {row['ours']:.6g} measured; {row['command']}"
        for row in measured
        if row["verdict"] == UNEXPLAINED
    ]


def text(measured: Sequence[Row], width: int) -> str:
    """Return a table in Markdown for each source, and below it the reasons why figures differ."""
    return "\n".join(_of_source(name, measured, width) for name in dict.fromkeys(row["source"] for row in measured))


def _of_source(name: str, measured: Sequence[Row], width: int) -> str:
    own = [row for row in measured if row["source"] == name]
    lines = [{column: row[column] for column in SHOWN} for row in own]
    for line in lines:
        line["ours"] = _as_printed(line["ours"], line["published"])
    reasons = "".join(f"- {reason}\n" for reason in _reasons(own))
    return f"{name}\n\n{tables.written(lines, 'markdown', width, ())}" + f"\n{reasons}" * bool(reasons)


def _as_printed(ours: float | None, published: str) -> str | None:
    """Return our figure with one digit more than the published figure, and at least three significant digits."""
    if ours is None or ours == round(ours):
        return None if ours is None else f"{ours:.0f}"
    first = math.floor(math.log10(abs(ours)))
    return f"{ours:.{max(len(published.partition('.')[2]) + 1, 2 - first)}f}"


def _reasons(measured: Sequence[Row]) -> Iterator[str]:
    """Yield each reason why figures differ, with its figures and a command that shows the difference."""
    by_reason: dict[str, list[Row]] = {}
    for row in measured:
        if row["verdict"] == DIFFERENT:
            by_reason.setdefault(row["why"], []).append(row)
    for why, part in by_reason.items():
        first, more = part[0], len(part) - 1
        of = f"{first['figure']}, and {more} more" if more else first["figure"]
        yield f"{of}: {why} ({first['command']})"
