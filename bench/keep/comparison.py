"""What changed between two runs: figures exactly; times where a rank test and a least effect agree."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from ..tables.registry import TABLES
from ..tables.table import Column, Role, Row, Table
from .runs import Done

# Two medians closer than this share of each other are the same to anyone who waits for a frame.
LEAST_EFFECT = 0.05
# How probable a difference may be by chance alone, of either sign, and still count.
CHANCE = 0.01
# Each frame's time, where a row has them.
EACH, FRAME = "ms_frame_each", "ms_frame"
# How many lines people read of a comparison.
LINES = 20
# The units of errors that people know, which come before counts and times; a row is named by its first figure in them.
ERRORS = ("dB", "degrees")
# A figure counts as at least this share of the other one, so that a change from 0 is 60 dB and not infinite.
FLOOR = 1e-3
# What is said of a row that the later run does not have.
GONE = "gone"
ONLY = {True: "only before", False: "only after"}
# And of a figure that only one of the runs has.
NOT_MEASURED, NEW = "not measured", "new"
# What is said of a row, the first that holds: of its worst figure, or of the row itself. "changed" is neither.
VERDICTS = ("worse", GONE, "better", NEW, "changed")


def compared(before: Done, after: Done) -> list[Row]:
    """A row for each figure that differs, and for each row that only one of the runs has; the worst first."""
    same_machine = before.facts.get("machine") == after.facts.get("machine")
    ours, theirs = before.tables, after.tables
    found: list[Row] = []
    for name in dict.fromkeys([*ours, *theirs]):
        table = TABLES.get(name)
        before_rows, after_rows = (named_rows(table, rows.get(name, [])) for rows in (ours, theirs))
        found += _between(name, table, before_rows, after_rows, same_machine)
    return sorted(found, key=lambda row: (not _is_error(row), -row["severity"]))


def _is_error(change: Row) -> bool:
    """Whether it says that an error grew, or that it can no longer be measured."""
    return change["severity"] > 0 and (change["unit"] in ERRORS or math.isinf(change["severity"]))


def named_rows(table: Table | None, rows: Sequence[Row]) -> dict[tuple[str, int], Row]:
    """Rows by what they are called, and those that are called alike by their order."""
    found: dict[tuple[str, int], Row] = {}
    counts: dict[str, int] = {}
    for row in rows:
        name = table.name_of(row) if table else str(list(row.values())[:3])
        found[name, counts.setdefault(name, 0)] = row
        counts[name] += 1
    return found


def _between(
    name: str, table: Table | None, ours: Mapping[Any, Row], theirs: Mapping[Any, Row], same_machine: bool
) -> Iterator[Row]:
    """What differs between the rows of one table."""
    for key in dict.fromkeys([*ours, *theirs]):
        if key in ours and key in theirs:
            yield from _changes(name, table, key[0], ours[key], theirs[key], same_machine)
        else:
            row = ours.get(key) or theirs[key]
            change = _change(name, table, row, key[0], "", key in ours, key in theirs) | {"change": ONLY[key in ours]}
            yield change | ({"verdict": GONE} if key in ours else {})


def _change(
    name: str, table: Table | None, row: Row, called: str, column: str, before: Any, after: Any, severity: float = 0.0
) -> Row:
    """A line; `severity` is above 0 where it is worse, and the larger the worse."""
    verdict = "worse" if severity > 0 else "better" if severity < 0 else ""
    keys = {c.name: row.get(c.name) for c in table.of_role(Role.KEY)} if table else {}
    known = table.column(column) if table and column else None
    made: Row = {"table": name, "row": called, "column": column, "before": before, "after": after}
    made |= {"change": difference(before, after), "verdict": verdict, "severity": severity, "keys": keys}
    return made | {"unit": known.unit if known else ""}


def _changes(name: str, table: Table | None, called: str, one: Row, other: Row, same_machine: bool) -> Iterator[Row]:
    gives_reason = bool(table) and any(row.get(c.name) for c in table.of_role(Role.REASON) for row in (one, other))
    for column in dict.fromkeys([*one, *other]):
        known = table.column(column) if table else None
        before, after = one.get(column), other.get(column)
        if _is_compared(table, known) and not same(before, after):
            severity = severity_of(known, before, after, gives_reason)
            yield _change(name, table, one, called, column, before, after, severity)
    if same_machine and one.get(EACH) and other.get(EACH):
        times = [[float(word) for word in row[EACH].split()] for row in (one, other)]
        effect = one[FRAME] and other[FRAME] / one[FRAME] - 1
        if abs(effect) >= LEAST_EFFECT and mann_whitney(*times) <= CHANCE:
            severity = 20 * math.log10(1 + effect)
            change = _change(name, table, one, called, FRAME, one[FRAME], other[FRAME], severity)
            yield change | {"change": f"{100 * effect:+.1f} %"}


def _is_compared(table: Table | None, known: Column | None) -> bool:
    """Figures are, and whether there are any; of a table that this version does not know, everything."""
    return not table or (known is not None and known.role in (Role.FIGURE, Role.REASON))


def severity_of(column: Column | None, before: Any, after: Any, gives_reason: bool) -> float:
    """How much worse a figure has become, in decibels; below 0 where it is better, 0 for neither.

    A figure that could not be measured any more is infinitely worse, one that now can be is infinitely better. Without
    a reason it was not looked for, as the supremum of a code that is no longer the best.
    """
    if not column or not column.better:
        return 0.0
    if before is None or after is None:
        return 0.0 if not gives_reason else math.inf if after is None else -math.inf
    if not all(isinstance(value, int | float) for value in (before, after)):
        return 0.0
    grows = _growth(column, before, after)
    return -grows if column.better == "more" else grows


def _growth(column: Column, before: float, after: float) -> float:
    if column.unit == "dB":
        return after - before
    # A count that was 0 was less than 1; any other figure was less than what can be told from the larger one.
    is_count = isinstance(before, int) and isinstance(after, int)
    least = 1.0 if is_count else FLOOR * max(abs(before), abs(after))
    return 20 * math.log10(max(after, least) / max(before, least)) if least else 0.0


def same(one: Any, other: Any) -> bool:
    """Whether two figures are equal; NaN equals itself here."""
    return one == other or (one != one and other != other)


def difference(before: Any, after: Any) -> str:
    """By how much a figure differs, as text."""
    if isinstance(before, int | float) and isinstance(after, int | float):
        return f"{after - before:+.3g}"
    return NOT_MEASURED if after is None else NEW if before is None else "another"


def mann_whitney(one: Sequence[float], other: Sequence[float]) -> float:
    """How probable it is by chance that two samples are as far apart in rank as these, in either direction."""
    from scipy.stats import mannwhitneyu

    # The exact distribution knows no ties.
    ties = len({*one, *other}) < len(one) + len(other)
    return float(mannwhitneyu(one, other, method="asymptotic" if ties else "exact").pvalue)


def in_short(changes: Sequence[Row], most: int = LINES) -> list[Row]:
    """Changes for people, the worst first: a line for each row, or for rows that changed together; where these are more
    than `most`, a line for several rows that share an encoding, or a table."""
    grouped: list[list[Row]] = []
    for by in (_together(changes), _by_encoding, _by_table):
        groups: dict[tuple, list[Row]] = {}
        for change in changes:
            groups.setdefault(by(change), []).append(change)
        grouped = list(groups.values())
        if len(grouped) <= most:
            break
    return [_line(group) for group in grouped]


def total(changes: Sequence[Row]) -> str:
    """How many rows and figures changed, and how many of the rows are worse, better, gone and so on."""
    rows: dict[tuple, list[Row]] = {}
    for change in changes:
        rows.setdefault(_by_row(change), []).append(change)
    counts = Counter(map(_verdict, rows.values()))
    said = ", ".join(f"{_several(counts[verdict], 'row')} {verdict}" for verdict in VERDICTS if counts[verdict])
    return f"{_several(len(rows), 'row')}, {_several(_figures(changes), 'figure')}: {said}"


def _verdict(row: Sequence[Row]) -> str:
    """One of VERDICTS of all that changed in a row."""
    found = {change["verdict"] for change in row} | {NEW for change in row if _presence(change) == ONLY[False]}
    return next((verdict for verdict in VERDICTS if verdict in found), VERDICTS[-1])


def _several(count: int, what: str) -> str:
    return f"{count} {what}" + "s" * (count != 1)


def _figures(changes: Sequence[Row]) -> int:
    """How many figures changed; a row that only one of the runs has is of no column."""
    return sum(bool(change["column"]) for change in changes)


def _presence(change: Row) -> str:
    """Whether only one of the runs has the row, and which; empty where both have it."""
    return change["change"] if change["change"] in ONLY.values() else ""


def _by_row(change: Row) -> tuple:
    return change["table"], change["row"], _presence(change)


def _together(changes: Sequence[Row]) -> Callable[[Row], tuple]:
    """What tells rows apart that did not change together: rows of a table whose figures all went from the same to the
    same."""
    rows: dict[tuple, list[tuple]] = {}
    for change in changes:
        rows.setdefault(_by_row(change), []).append((change["column"], str(change["before"]), str(change["after"])))
    return lambda change: (change["table"], _presence(change), *rows[_by_row(change)])


def _by_encoding(change: Row) -> tuple:
    keys = change["keys"]
    code = next((keys[name] for name in ("encoding", "depth", "light_buffer") if keys.get(name)), "")
    return change["table"], code, _presence(change)


def _by_table(change: Row) -> tuple:
    return change["table"], _presence(change)


def _line(group: Sequence[Row]) -> Row:
    """Of several changes the worst, named by what they have in common, with the figure of it that people know."""
    rows = list(dict.fromkeys(change["row"] for change in group))
    worst = _headline([change for change in group if change["row"] == group[0]["row"]])
    shared = [v for n, v in worst["keys"].items() if v is not None and all(c["keys"].get(n) == v for c in group)]
    name = worst["row"] if len(rows) == 1 else " ".join(map(str, shared)) or "several"
    kept = {column: worst[column] for column in ("column", "before", "after", "change", "verdict")}
    return {"table": worst["table"], "row": name, "rows": len(rows), "figures": _figures(group)} | kept


def _headline(row: Sequence[Row]) -> Row:
    """Of the changes of one row the first in decibels, else in degrees, that has the verdict of the worst; else the
    worst."""
    alike = [change for change in row if change["verdict"] == row[0]["verdict"]]
    known = (change for unit in ERRORS for change in _in_order(alike) if change["unit"] == unit)
    return next(known, row[0])


def _in_order(row: Sequence[Row]) -> list[Row]:
    """The changes of one row in the order of its table's columns."""
    table = TABLES.get(row[0]["table"])
    names = [column.name for column in table.columns] if table else []
    return sorted(row, key=lambda change: names.index(change["column"]) if change["column"] in names else len(names))
