"""What a figure must keep, and what a row is called. Imports nothing heavy."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..output.errors import UsageError

# Neither can be read in two ways, which would take a long text a long time.
LIMIT = re.compile(r"(at least|at most)\s+(.*)", re.IGNORECASE | re.DOTALL)
NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)(e[-+]?\d+)?|inf", re.IGNORECASE | re.ASCII)
# What a row is called by.
IDENTITY = (
    *("encoding", "storage", "rounding", "normals", "backend", "pipeline", "layout", "scene", "experiment"),
    *("light_buffer", "light_targets", "channel", "order", "colour", "lights", "sum", "peak", "power", "depth"),
    *("rebuilt", "near", "far", "distance", "frame_set", "operation", "stage", "family"),
)


def row_name(row: Mapping[str, Any]) -> str:
    """What a row is called."""
    return " ".join(str(row[name]) for name in IDENTITY if row.get(name) is not None)


@dataclass(frozen=True)
class Limit:
    """The least or the most that a column may be."""

    column: str
    side: str
    value: float

    def holds(self, figure: Any) -> bool:
        """Whether a figure keeps it; what is no number does not."""
        if isinstance(figure, bool) or not isinstance(figure, int | float) or math.isnan(figure):
            return False
        return figure >= self.value if self.side == "at least" else figure <= self.value

    def __str__(self) -> str:
        return f"{self.side} {self.value:.9g}"

    def broken_by(self, row: Mapping[str, Any]) -> str | None:
        """What is to be said of a row that does not keep it; None of one that does.

        Raises:
            UsageError: the row has no such column.
        """
        if self.column not in row:
            raise UsageError(f"no column {self.column!r}; there are {', '.join(row)}")
        figure = row[self.column]
        if self.holds(figure):
            return None
        shown = f"{figure:.9g}" if isinstance(figure, float) else figure
        reason = f" ({' '.join(row['skipped'].split())})" if row.get("skipped") else ""
        return f"{row_name(row)}: {self.column} is {shown}{reason}, not {self}"


def limit(column: str, text: Any) -> Limit | None:
    """The limit that "at least 47.5" or "at most 0.95" is; None for what is none.

    Raises:
        UsageError: it begins like one, but no number follows.
    """
    match = LIMIT.fullmatch(text.strip()) if isinstance(text, str) else None
    if not match:
        return None
    if not NUMBER.fullmatch(match[2]):
        raise UsageError(f"{column}: {match[2][:40]} is no number")
    return Limit(column, match[1].lower(), float(match[2]))


def split_limits(values: Mapping[str, Any]) -> tuple[dict[str, Any], tuple[Limit, ...]]:
    """Options, and limits on columns, of what names both. Raises UsageError where no limit is among them."""
    found = {name: limit(name, value) for name, value in values.items()}
    options = {name: value for name, value in values.items() if found[name] is None}
    limits = tuple(one for one in found.values() if one)
    if not limits:
        raise UsageError('it holds no column to anything; say psnr_db = "at least 47.5"')
    return options, limits
