"""What changed between two runs: figures exactly; times where a rank test and a least effect agree."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from ..gates.limits import row_name
from .runs import Done, Row

# Two medians closer than this share of each other are the same to anyone who waits for a frame.
LEAST_EFFECT = 0.05
# How probable a difference may be by chance alone, of either sign, and still count.
CHANCE = 0.01
# Each frame's time, where a row has them; everything that goes by the clock starts alike. A histogram changes where its
# mean and its largest value do, and takes a page to say so.
EACH, NOT_COMPARED = "ms_frame_each", ("ms_", "clock", "angle_counts")
COLUMNS = ("table", "row", "column", "before", "after", "change")


def compared(before: Done, after: Done) -> list[Row]:
    """A row for each figure that is another, and for each step that only one of the runs has."""
    ours, theirs = _by_key(before), _by_key(after)
    same_machine = before.facts.get("machine") == after.facts.get("machine")
    found: list[Row] = []
    for key in dict.fromkeys([*ours, *theirs]):
        if key not in ours or key not in theirs:
            step = ours.get(key) or theirs[key]
            found.append(
                _change(step["table"], row_name(step["key"]), "", key in ours, key in theirs, "only one has it")
            )
            continue
        found += _between(ours[key]["table"], *(_by_name(step[key]["rows"]) for step in (ours, theirs)), same_machine)
    return found


def _by_name(rows: Sequence[Row]) -> dict[tuple[str, int], Row]:
    """Rows by what they are called, and of those called alike by their order."""
    found: dict[tuple[str, int], Row] = {}
    names = [row_name(row) for row in rows]
    for at, (name, row) in enumerate(zip(names, rows, strict=True)):
        found[name, names[:at].count(name)] = row
    return found


def _between(table: str, ours: Mapping[Any, Row], theirs: Mapping[Any, Row], same_machine: bool) -> Iterator[Row]:
    """What is another between the rows of one step."""
    for key in dict.fromkeys([*ours, *theirs]):
        if key in ours and key in theirs:
            yield from _changes(table, ours[key], theirs[key], same_machine)
        else:
            yield _change(table, key[0], "", key in ours, key in theirs, "only one has it")


def _by_key(run: Done) -> dict[str, Row]:
    return {json.dumps([step["table"], step["key"]], sort_keys=True): step for step in run.steps}


def _change(table: str, row: str, column: str, before: Any, after: Any, change: str) -> Row:
    return dict(zip(COLUMNS, (table, row, column, before, after, change), strict=True))


def _changes(table: str, one: Row, other: Row, same_machine: bool) -> Iterator[Row]:
    for column in dict.fromkeys([*one, *other]):
        before, after = one.get(column), other.get(column)
        if not column.startswith(NOT_COMPARED) and not same(before, after):
            yield _change(table, row_name(one), column, before, after, difference(before, after))
    if same_machine and one.get(EACH) and other.get(EACH):
        times = [[float(word) for word in row[EACH].split()] for row in (one, other)]
        effect = one["ms_frame"] and other["ms_frame"] / one["ms_frame"] - 1
        if abs(effect) >= LEAST_EFFECT and mann_whitney(*times) <= CHANCE:
            yield _change(
                table, row_name(one), "ms_frame", one["ms_frame"], other["ms_frame"], f"{100 * effect:+.1f} %"
            )


def same(one: Any, other: Any) -> bool:
    """Whether two figures are one; what is no number is the same as itself here."""
    return one == other or (one != one and other != other)


def difference(before: Any, after: Any) -> str:
    """By how much a figure is another, as text."""
    if isinstance(before, int | float) and isinstance(after, int | float):
        return f"{after - before:+.3g}"
    return "another"


def mann_whitney(one: Sequence[float], other: Sequence[float]) -> float:
    """How probable it is by chance that two samples are as far apart in rank as these, in either direction.

    Mann and Whitney's U (1947), exact: of all ways to deal the ranks, the share with a U as far from its middle. Equal
    values count half.
    """
    n, m = len(one), len(other)
    u = sum((a > b) + 0.5 * (a == b) for a in one for b in other)
    middle, total = n * m / 2, sum(_ways(n, m, k) for k in range(n * m + 1))
    far = sum(_ways(n, m, k) for k in range(n * m + 1) if abs(k - middle) >= abs(u - middle) - 1e-9)
    return far / total


@cache
def _ways(n: int, m: int, u: int) -> int:
    """In how many orders of n and m values u pairs stand the one way around."""
    if u < 0:
        return 0
    if n == 0 or m == 0:
        return int(u == 0)
    return _ways(n - 1, m, u - m) + _ways(n, m - 1, u)
