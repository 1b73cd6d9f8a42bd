"""Changes between two runs, for people: a sentence for each encoding, a line for each row, and a total."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from ...reports.tables import text_of
from ..tables.registry import TABLES
from ..tables.table import Role, Row, Table
from .comparison import (
    GONE,
    LITTLE,
    NEW,
    ONLY,
    by_row,
    gives_reason,
    headline,
    is_small,
    known_figures,
    named_rows,
    presence,
    rows_of,
)
from .runs import Done

# How many lines people read of a comparison, and how many sentences above them.
LINES, SENTENCES = 20, 5
# The columns that say what a row is of, the first that it has.
SUBJECTS = ("encoding", "depth", "light_buffer")
# What is said of a row, the first that holds: of its figures, or of the row itself. "changed" is neither.
SLIGHTLY = {"worse": "slightly worse", "better": "slightly better"}
VERDICTS = ("worse", GONE, "better", NEW, *SLIGHTLY.values(), "changed")
# The units whose figures are quoted in sentences: those of errors.
UNITS = ("degrees", "dB")


def what_matters(before: Done, after: Done, changes: Sequence[Row]) -> list[str]:
    """Return a sentence for each encoding that changed, the worst first: the number of its rows that changed, and the
    figures in degrees and decibels of the row that changed most."""
    if changes and not _share_a_row(before, after):
        return ["the runs have no row in common"]
    return sentences(before, after, changes)


def sentences(before: Done, after: Done, changes: Sequence[Row]) -> list[str]:
    """Return the sentences of `what_matters`, even for runs without a common row: at most SENTENCES sentences,
    followed by the number of the others."""
    counts = _rows_of_each(before, after)
    groups: dict[str, list[Row]] = {}
    for change in changes:
        groups.setdefault(_subject(change["table"], change["keys"]), []).append(change)
    lines = [_sentence(name, counts[name], group) for name, group in groups.items()]
    more = len(lines) - SENTENCES
    return lines if more <= 0 else [*lines[:SENTENCES], f"and {more} more of {len(counts)}"]


def _share_a_row(before: Done, after: Done) -> bool:
    ours, theirs = _row_names(before), _row_names(after)
    return not ours or not theirs or bool(ours & theirs)


def _row_names(done: Done) -> set[tuple]:
    return {(name, *key) for name, rows in done.tables.items() for key in named_rows(TABLES[name], rows)}


def _rows_of_each(before: Done, after: Done) -> Counter[str]:
    """Count the rows of each encoding, without rows that give the same reason for missing figures in both runs."""
    counts = Counter[str]()
    for name in dict.fromkeys([*before.tables, *after.tables]):
        table = TABLES[name]
        ours, theirs = (named_rows(table, done.tables.get(name, ())) for done in (before, after))
        for key, row in {**ours, **theirs}.items():
            pair = [rows.get(key, {}) for rows in (ours, theirs)]
            is_known = all(gives_reason(table, each) for each in pair) and len(set(_reasons(table, pair))) == 1
            counts[_subject(name, row)] += not is_known
    return counts


def _reasons(table: Table, rows: Sequence[Row]) -> list[tuple]:
    return [tuple(row.get(column.name) for column in table.of_role(Role.REASON)) for row in rows]


def _subject(table: str, keys: Mapping[str, object]) -> str:
    """Return the subject of a row as text: the name of its encoding, of whatever kind, or else of its table."""
    return str(next((keys[name] for name in SUBJECTS if keys.get(name)), table))


def _sentence(name: str, count: int, changes: Sequence[Row]) -> str:
    """Return a sentence on an encoding: the number of its `count` rows that changed, and the figures of its worst
    row."""
    rows = rows_of(changes)
    verdicts = Counter(map(_verdict_word, rows))
    first, *others = (verdict for verdict in VERDICTS if verdicts[verdict])
    phrases = [
        f"{first} in {_share_text(verdicts[first], count)}",
        *(f"{verdict} in {verdicts[verdict]}" for verdict in others),
    ]
    return f"{name}: {', '.join(phrases)}{_figures_said(rows[0], name)}"


def _share_text(some: int, count: int) -> str:
    every = "its only row" if count == 1 else f"all {count} rows"
    return every if some == count else f"{some} of {count} rows"


def _figures_said(row: Sequence[Row], name: str) -> str:
    """Return text that begins "; largest change in", with the table, the row's name without `name`, and its figures
    before and after, from the changes of one row."""
    where = " ".join(row[0]["row"].replace(name, " ", 1).split())
    known = (f"{change['column']} {_before_and_after(change)}" for change in known_figures(row, UNITS))
    figure_text = ", ".join(known)
    return f"; largest change in {row[0]['table']} {where}: {figure_text}" if figure_text else ""


def _before_and_after(change: Row) -> str:
    before, after = (text_of(change[when]) or "no value" for when in ("before", "after"))
    return f"from {before} to {after} {change['unit']}"


def in_short(changes: Sequence[Row], most: int = LINES) -> list[Row]:
    """Return changes for people, the worst first: a line for each row, or for rows that changed together. If this
    gives more than `most` lines, rows with the same encoding, or else all rows of a table, share a line."""
    grouped: list[list[Row]] = []
    for by in (_together_key(changes), _subject_key, _table_key):
        groups: dict[tuple, list[Row]] = {}
        for change in changes:
            groups.setdefault(by(change), []).append(change)
        grouped = list(groups.values())
        if len(grouped) <= most:
            break
    return [_worst_row(group) for group in grouped]


def _together_key(changes: Sequence[Row]) -> Callable[[Row], tuple]:
    """Return a function that gives rows of a table the same key if all their figures changed from and to the same
    values."""
    rows: dict[tuple, list[tuple]] = {}
    for change in changes:
        rows.setdefault(by_row(change), []).append((change["column"], str(change["before"]), str(change["after"])))
    return lambda change: (change["table"], presence(change), *rows[by_row(change)])


def _subject_key(change: Row) -> tuple:
    return change["table"], _subject("", change["keys"]), presence(change)


def _table_key(change: Row) -> tuple:
    return change["table"], presence(change)


def _worst_row(group: Sequence[Row]) -> Row:
    """Return the worst row of several changes, named by the key values that they share, with its headline figure."""
    rows = rows_of(group)
    worst = headline(rows[0])
    shared = [v for n, v in worst["keys"].items() if v is not None and all(c["keys"].get(n) == v for c in group)]
    names = {change["row"] for change in group}
    name = worst["row"] if len(names) == 1 else " ".join(map(str, shared)) or "several"
    kept = {column: worst[column] for column in ("column", "before", "after", "change")}
    verdict = {"verdict": SLIGHTLY[worst["verdict"]] if is_small(worst) else worst["verdict"]}
    return {"table": worst["table"], "row": name, "rows": len(names), "figures": _figure_count(group)} | kept | verdict


def total(changes: Sequence[Row]) -> str:
    """Return a line of text: how many rows and figures changed, and how many rows are worse, better, gone or new."""
    rows = rows_of(changes)
    counts = Counter(map(_verdict_word, rows))
    summary = ", ".join(f"{_count_text(counts[verdict], 'row')} {verdict}" for verdict in VERDICTS if counts[verdict])
    is_any_small = any(counts[verdict] for verdict in SLIGHTLY.values())
    note = f" (slightly: by less than {LITTLE})" if is_any_small else ""
    return f"{_count_text(len(rows), 'row')}, {_count_text(_figure_count(changes), 'figure')}: {summary}{note}"


def _verdict_word(row: Sequence[Row]) -> str:
    """Return the first of VERDICTS that applies to the changes of a row; the last of VERDICTS if none applies."""
    verdicts = {SLIGHTLY[change["verdict"]] if is_small(change) else change["verdict"] for change in row}
    verdicts |= {NEW for change in row if presence(change) == ONLY[False]}
    return next((verdict for verdict in VERDICTS if verdict in verdicts), VERDICTS[-1])


def _count_text(count: int, what: str) -> str:
    return f"{count} {what}" + "s" * (count != 1)


def _figure_count(changes: Sequence[Row]) -> int:
    """Count the figures that changed, without changes of whole rows that only one run has, which name no column."""
    return sum(bool(change["column"]) for change in changes)
