"""Limits that figures must meet. Imports nothing heavy."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ...ground.options.option import fields_of
from ...ground.output.errors import UsageError
from ...tables.table import Role, Table

# Neither can be read in two ways, which would take a long text a long time.
LIMIT = re.compile(r"(at least|at most)\s+(.*)", re.IGNORECASE | re.DOTALL)
NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)(e[-+]?\d+)?|inf", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True)
class Limit:
    """The smallest or the largest value that a column may have."""

    column: str
    side: str
    value: float

    def holds(self, figure: Any) -> bool:
        """Whether a figure meets the limit; False for a value that is not a number."""
        if isinstance(figure, bool) or not isinstance(figure, int | float) or math.isnan(figure):
            return False
        return figure >= self.value if self.side == "at least" else figure <= self.value

    def __str__(self) -> str:
        return f"{self.side} {self.value:.9g}"

    def check(self, table: Table) -> None:
        """Raise UsageError if the table has no such column, or the column does not hold figures."""
        column = table.column(self.column)
        if column is None:
            figures = ", ".join(c.name for c in table.of_role(Role.FIGURE, Role.TIME))
            raise UsageError(f"{table.name}: no column {self.column!r}; figures: {figures}")
        if column.role not in (Role.FIGURE, Role.TIME):
            raise UsageError(
                f"{table.name}: {self.column} is not a figure; `normalbench columns {table.name}` lists the figures"
            )

    def option_of(self, table: Table) -> str:
        """Return the name of the option without which the column is not measured; empty if no option is needed."""
        column = table.column(self.column)
        return column.option if column and column.option in fields_of(table.options) else ""

    def broken_by(self, table: Table, row: Mapping[str, Any]) -> str | None:
        """Return the message for a row that breaks the limit; None if the row meets it.

        Raises:
            UsageError: the row has no such column.
        """
        if self.column not in row:
            raise UsageError(f"no column {self.column!r}; known: {', '.join(row)}")
        figure = row[self.column]
        if self.holds(figure):
            return None
        shown = f"{figure:.9g}" if isinstance(figure, float) else figure
        reason = f" ({' '.join(row['skipped'].split())})" if row.get("skipped") else ""
        return f"{table.name_of(row)}: {self.column} is {shown}{reason}, not {self}"


# A mean hides a few NaN.
ALL_NUMBERS = Limit("invalid", "at most", 0.0)


def limits_on(row: Mapping[str, Any], limits: Iterable[Limit]) -> list[Limit]:
    """Return the limits as a list. If some results of the row are not numbers, ALL_NUMBERS is added, unless a
    limit on that column is given or there are no limits."""
    limits = list(limits)
    is_said = any(bound.column == ALL_NUMBERS.column for bound in limits)
    return [*limits, ALL_NUMBERS] if limits and not is_said and row.get(ALL_NUMBERS.column) else limits


def limit(column: str, text: Any) -> Limit | None:
    """Return the limit for text such as "at least 47.5" or "at most 0.95"; None for anything else.

    Raises:
        UsageError: the text begins like a limit, but no number follows.
    """
    match = LIMIT.fullmatch(text.strip()) if isinstance(text, str) else None
    if not match:
        return None
    if not NUMBER.fullmatch(match[2]):
        raise UsageError(f"{column}: {match[2][:40]} is not a number")
    value = float(match[2])
    # Infinity itself is a limit: an exact row has that PSNR. Digits of it are a slip that would hold nothing.
    if math.isinf(value) and "inf" not in match[2].lower():
        raise UsageError(f"{column}: {match[2][:40]} is not a finite number; write one below 1e308")
    return Limit(column, match[1].lower(), value)


def not_a_limit(column: str, value: Any) -> UsageError:
    """Return the error for a value that is not a limit."""
    return UsageError(f'{column}: {value!r} is not a threshold; write "at least 47.5" or "at most 0.95"')


def split_limits(
    values: Mapping[str, Any], table: Table, may_lack: bool = False
) -> tuple[dict[str, Any], tuple[Limit, ...]]:
    """Split values that mix options and limits on columns, and return the options and the limits. Raises UsageError
    if limits are required but missing."""
    bounds = {name: limit(name, value) for name, value in values.items()}
    options = {name: value for name, value in values.items() if bounds[name] is None}
    limits = tuple(bound for bound in bounds.values() if bound)
    figures = [name for name in options if (column := table.column(name)) and column.role in (Role.FIGURE, Role.TIME)]
    if not limits and figures:
        raise not_a_limit(figures[0], values[figures[0]])
    if not limits and not may_lack:
        raise UsageError('no threshold given; add for example psnr_db = "at least 47.5"')
    return options, limits
