"""Changes between two runs: figures exactly; times if both a rank test and a minimum effect agree."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from ..tables.registry import TABLES
from ..tables.table import Column, Role, Row, Table
from .runs import Done

T = TypeVar("T", bound=Hashable)
# Two medians closer than this share of each other are the same to anyone who waits for a frame.
LEAST_EFFECT = 0.05
# How probable a difference may be by chance alone, of either sign, and still count.
CHANCE = 0.01
# Each frame's time, where a row has them.
EACH, FRAME = "ms_frame_each", "ms_frame"
# The units of errors that people know, which come before counts and times; a row is named by its first figure in them.
ERRORS = ("dB", "degrees")
# A figure counts as at least this share of the other one, so that a change from 0 is 60 dB and not infinite.
FLOOR = 1e-3
# And so is a change from infinitely many decibels.
CEILING = -20 * math.log10(FLOOR)
# Changes below these decibels are small. Of an angle they are about 1 %; of a mean square 0.1 dB are 0.2 of
# `severity_of`, and counts and times are taken like it.
SMALL, SMALL_OTHER = 0.1, 0.2
# As people read it.
LITTLE = f"{SMALL:g} dB, about {10 ** (SMALL / 20) - 1:.0%}"
# What decides a figure beside the code that is measured: where two rows differ in one of them, so may their figures.
ASKED = ("count", "seed", "size", "samples", "lights")
CONDITIONS = (*ASKED, "device", "rounded_by")
# What is said of a row that the later run does not have.
GONE = "gone"
ONLY = {True: "only before", False: "only after"}
# And of a figure that only one of the runs has.
NOT_MEASURED, NEW = "not measured", "new"


def compared(before: Done, after: Done) -> list[Row]:
    """Return a row for each figure that differs, and for each row that only one of the runs has; the worst first."""
    same_machine = before.facts.get("machine") == after.facts.get("machine")
    return in_order([row for tables in _tables_and_rows(before, after) for row in row_changes(*tables, same_machine)])


def _tables_and_rows(before: Done, after: Done) -> Iterator[tuple[Table, Mapping[Any, Row], Mapping[Any, Row]]]:
    """Yield each table that either run has, with its rows in the first and in the second run, as `named_rows` returns
    them."""
    ours, theirs = before.tables, after.tables
    for name in dict.fromkeys([*ours, *theirs]):
        before_rows, after_rows = (named_rows(TABLES[name], rows.get(name, [])) for rows in (ours, theirs))
        yield TABLES[name], before_rows, after_rows


def measured_otherwise(before: Done, after: Done) -> list[str]:
    """Return a text for each condition that differs between the same rows of both runs; the most frequent first."""
    counts: Counter[tuple[str, Any, Any]] = Counter()
    for _, ours, theirs in _tables_and_rows(before, after):
        for row, other in ((row, theirs[key]) for key, row in ours.items() if key in theirs):
            known = [column for column in CONDITIONS if None not in (row.get(column), other.get(column))]
            counts.update((column, row[column], other[column]) for column in known if row[column] != other[column])
    return [
        f"{column} was {previous} and is now {other} in {count} row{'s' * (count > 1)}"
        for (column, previous, other), count in counts.most_common()
    ]


def in_order(changes: Sequence[Row]) -> list[Row]:
    """Return changes in order, grouped by row: rows are sorted by headline, and the changes of a row from the worst.

    A row that lost a figure comes first, then increased errors, the largest increase first, other figures that are
    worse, rows that are gone, better figures, new rows, and last small changes.
    """
    ranked = sorted(rows_of(changes), key=lambda row: rank_key(headline(row)))
    return [change for row in ranked for change in sorted(row, key=rank_key)]


def rows_of(changes: Sequence[Row]) -> list[list[Row]]:
    """Return the changes of each row as a list, in the order in which the rows first occur."""
    rows: dict[tuple, list[Row]] = {}
    for change in changes:
        rows.setdefault(by_row(change), []).append(change)
    return list(rows.values())


def by_row(change: Row) -> tuple:
    """Return the key of the row that a change belongs to: its table, its name and its `presence`."""
    return change["table"], change["row"], presence(change)


def presence(change: Row) -> str:
    """Return text that names the only run with the row of a change; empty if both runs have the row."""
    return change["change"] if change["change"] in ONLY.values() else ""


def headline(row: Sequence[Row]) -> Row:
    """Return a row's first change in decibels, else in degrees, from the same group as its worst change; else the
    worst change."""
    worst = min(row, key=rank_key)
    return next(known_figures(row, ERRORS), worst)


def known_figures(row: Sequence[Row], units: Sequence[str]) -> Iterator[Row]:
    """Yield, for each of some units, a row's first change in that unit from the same group as its worst change."""
    group = min(map(_group_index, row))
    alike = _by_column([change for change in row if _group_index(change) == group])
    for unit in units:
        yield from [change for change in alike if change["unit"] == unit][:1]


def _by_column(row: Sequence[Row]) -> list[Row]:
    """Return the changes of one row in the order of its table's columns; columns that the table lacks come last."""
    names = [column.name for column in TABLES[row[0]["table"]].columns]
    return sorted(row, key=lambda change: names.index(change["column"]) if change["column"] in names else len(names))


def rank_key(change: Row) -> tuple[int, float]:
    """Return the key that sorts changes, the worst first: by group, then by severity, the largest first."""
    return _group_index(change), -abs(change["severity"])


def _group_index(change: Row) -> int:
    """Return the number of a change's group in the order of `in_order`: 0 for a lost figure, 6 for small changes."""
    severity = change["severity"]
    if severity == math.inf:
        return 0
    if is_small(change):
        return 6
    if severity > 0:
        return 1 if change["unit"] in ERRORS else 2
    return 3 if change["verdict"] == GONE else 4 if severity < 0 else 5


def is_small(change: Row) -> bool:
    """Whether a figure is better or worse by less than SMALL, if it is an error, or else by less than SMALL_OTHER."""
    return 0 < abs(change["severity"]) < (SMALL if change["unit"] in ERRORS else SMALL_OTHER)


def named_rows(table: Table, rows: Sequence[Row]) -> dict[tuple[str, int], Row]:
    """Return rows by name and index, which counts rows of the same name from 0."""
    return in_turn(rows, table.name_of)


def in_turn(rows: Sequence[Row], name_of: Callable[[Row], T]) -> dict[tuple[T, int], Row]:
    """Return rows by the name that `name_of` returns and an index, which counts rows of the same name from 0."""
    by_name: dict[tuple[T, int], Row] = {}
    counts: dict[T, int] = {}
    for row in rows:
        name = name_of(row)
        by_name[name, counts.setdefault(name, 0)] = row
        counts[name] += 1
    return by_name


def row_changes(table: Table, ours: Mapping[Any, Row], theirs: Mapping[Any, Row], same_machine: bool) -> Iterator[Row]:
    """Yield a change for each figure that differs between the rows of one table, and for each row that only one
    run has. Times are compared only on the same machine."""
    for key in dict.fromkeys([*ours, *theirs]):
        if key in ours and key in theirs:
            yield from _column_changes(table, key[0], ours[key], theirs[key], same_machine)
        else:
            row = ours.get(key) or theirs[key]
            change = _change_row(table, row, key[0], "", key in ours, key in theirs) | {"change": ONLY[key in ours]}
            yield change | ({"verdict": GONE} if key in ours else {})


def _change_row(
    table: Table, row: Row, called: str, column: str, before: Any, after: Any, severity: float = 0.0
) -> Row:
    """Return a change as a row of the comparison; `severity` is above 0 if the figure is worse, below 0 if better."""
    verdict = "worse" if severity > 0 else "better" if severity < 0 else ""
    keys = {c.name: row.get(c.name) for c in table.of_role(Role.KEY)}
    known = table.column(column) if column else None
    line: Row = {"table": table.name, "row": called, "column": column, "before": before, "after": after}
    line |= {"change": difference(before, after), "verdict": verdict, "severity": severity, "keys": keys}
    return line | {"unit": known.unit if known else ""}


def _column_changes(table: Table, called: str, earlier: Row, other: Row, same_machine: bool) -> Iterator[Row]:
    differing = [name for name in dict.fromkeys([*earlier, *other]) if not same(earlier.get(name), other.get(name))]
    has_reason = bool(differing) and (gives_reason(table, earlier) or gives_reason(table, other))
    for column in differing:
        known = table.column(column)
        if known and known.role in (Role.FIGURE, Role.REASON):
            before, after = earlier.get(column), other.get(column)
            severity = severity_of(known, before, after, has_reason)
            yield _change_row(table, earlier, called, column, before, after, severity)
    if same_machine and earlier.get(EACH) and other.get(EACH):
        times = [[float(word) for word in row[EACH].split()] for row in (earlier, other)]
        if is_slower_or_faster(earlier[FRAME], other[FRAME]) and mann_whitney(*times) <= CHANCE:
            yield time_change(table, earlier, called, FRAME, earlier[FRAME], other[FRAME])


def is_slower_or_faster(before: float, after: float) -> bool:
    """Whether two medians differ by at least the fraction LEAST_EFFECT of the first; False if the first is 0."""
    return bool(before) and abs(after / before - 1) >= LEAST_EFFECT


def time_change(table: Table, row: Row, called: str, column: str, before: float, after: float) -> Row:
    """Return the change of a time or a speed as a row of the comparison, with the difference in percent."""
    known = table.column(column)
    grows = 20 * math.log10(after / before)
    severity = -grows if known and known.better == "more" else grows
    change = f"{100 * (after / before - 1):+.1f}%"
    return _change_row(table, row, called, column, before, after, severity) | {"change": change}


def gives_reason(table: Table, row: Row) -> bool:
    """Whether a row gives a reason why it lacks figures."""
    return any(row.get(column.name) for column in table.of_role(Role.REASON))


def severity_of(column: Column, before: Any, after: Any, has_reason: bool) -> float:
    """Return how much worse a figure has become, in decibels; below 0 if it is better, 0 for neither.

    A figure that can no longer be measured is infinitely worse; a figure that can now be measured is infinitely
    better. A figure that is missing without a reason was not requested, such as the supremum of an encoding that is
    no longer the best.
    """
    if not column.better:
        return 0.0
    if before is None or after is None:
        return 0.0 if not has_reason else math.inf if after is None else -math.inf
    if not all(isinstance(value, int | float) for value in (before, after)):
        return 0.0
    grows = _growth(column, before, after)
    return -grows if column.better == "more" else grows


def _growth(column: Column, before: float, after: float) -> float:
    if column.unit == "dB":
        return max(-CEILING, min(CEILING, after - before)) if math.isinf(after - before) else after - before
    # A count that was 0 was less than 1; any other figure was less than what can be told from the larger one.
    is_count = isinstance(before, int) and isinstance(after, int)
    least = 1.0 if is_count else FLOOR * max(abs(before), abs(after))
    return 20 * math.log10(max(after, least) / max(before, least)) if least else 0.0


def same(figure: Any, other: Any) -> bool:
    """Whether two figures are equal; NaN equals itself here."""
    return figure == other or (figure != figure and other != other)


def difference(before: Any, after: Any) -> str:
    """Return the difference between two figures as text: signed if both are numbers, else a word, such as "new"."""
    if isinstance(before, int | float) and isinstance(after, int | float):
        return f"{after - before:+.3g}"
    return NOT_MEASURED if after is None else NEW if before is None else "different"


def mann_whitney(sample: Sequence[float], other: Sequence[float]) -> float:
    """Return the two-sided p-value of the Mann–Whitney rank test for two samples."""
    from scipy.stats import mannwhitneyu

    # The exact distribution knows no ties.
    ties = len({*sample, *other}) < len(sample) + len(other)
    return float(mannwhitneyu(sample, other, method="asymptotic" if ties else "exact").pvalue)
