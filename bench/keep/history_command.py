"""The `history` command."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..ground.choose import choose
from ..ground.options.words import Names
from ..ground.output.errors import UsageError, tell
from ..tables.table import Row
from .change_lines import LINES, SENTENCES, in_short, sentences
from .comparison import GONE, headline, in_order, rank_key
from .history import Change, Series, changes_of, series_of
from .past_runs import Past, named_apart, past_runs
from .row_files import write

# How many figures people are shown side by side.
MOST = 6
# What --by may be besides "change".
COMMIT = "commit"
# What a group of changes is, in the order in which groups are shown.
WORSE, MENDED, BETTER = "worse", "mended", "better"
# What a narrow terminal leaves out, the first first.
SPARED = ("figures", "rows", "date", "change")


@dataclass(frozen=True)
class Wanted:
    """The part of the runs to show: names of tables, encodings, storages and columns, or None for all."""

    tables: Names | None = None
    encoding: Names | None = None
    storage: Names | None = None
    column: Names | None = None


@dataclass(frozen=True)
class Group:
    """The changes made at one commit that the same later commit mended, or that have not been mended."""

    kind: str
    at: int
    mended: int | None
    changes: Sequence[Change]

    @property
    def lines(self) -> list[Row]:
        """The changes as `compare` reports them, worst first."""
        return in_order([change.line for change in self.changes])


def history_command(folders: Sequence[Path], wanted: Wanted, by: str, format: str, output: Path | None) -> int:
    """Write the changes of figures with their commits, or the figures by commit, and return exit status 0."""
    runs = past_runs(folders)
    # All rows are judged, whichever are shown: how large a time's step must be depends on how many there are.
    everything = series_of(runs)
    series = _chosen(everything, wanted)
    columns, shown = _columns(series, wanted), set(map(id, series))
    all_changes = [change for change in changes_of(everything) if id(change.series) in shown]
    changes = [change for change in all_changes if not columns or change.line["column"] in columns]
    groups = _groups(changes)
    figures = _figures(groups, series, columns)
    _tell_what_else(runs, groups)
    is_for_people = format in ("table", "markdown")
    if by == COMMIT and not figures:
        tell("no figure changed; name a column with --column")
    if by == COMMIT:
        write((_across if is_for_people else _long)(runs, figures), format, output, total=_left_out(figures))
    elif is_for_people:
        write(
            _lines(runs, groups),
            format,
            output,
            SPARED,
            lead=_lead(runs, series, groups),
            total=_total(runs, series, groups),
        )
    else:
        write([_line(runs, change) for group in groups for change in group.changes], format, output)
    return 0


def _chosen(series: Sequence[Series], wanted: Wanted) -> list[Series]:
    """Return the histories of the wanted rows. Raises UsageError for an unknown name, or if no row has all names."""
    remaining = list(series)
    for what in ("tables", "encoding", "storage"):
        names: Names | None = getattr(wanted, what)
        if names:
            known = dict.fromkeys(name for row_series in series if (name := _name(row_series, what)))
            chosen = choose(what.removesuffix("s"), names, {str(name): name for name in known})
            remaining = [row_series for row_series in remaining if _name(row_series, what) in chosen]
    if not remaining:
        raise UsageError("the runs have no row with all of these names")
    return remaining


def _name(series: Series, what: str) -> Any:
    return series.table.name if what == "tables" else series.rows[0][1].get(what)


def _columns(series: Sequence[Series], wanted: Wanted) -> set[str]:
    """Return the names of the wanted columns; empty for all columns. Raises UsageError for a name that no row has."""
    known = dict.fromkeys(name for row_series in series for name in row_series.judged)
    return set(choose("column", wanted.column, {name: name for name in known})) if wanted.column else set()


def _groups(changes: Sequence[Change]) -> list[Group]:
    """Return the changes grouped by commit and by the commit that mended them. Figures that are still worse come
    first, then mended figures, then better figures; within each kind, the worst group comes first."""
    by_commit: dict[tuple[str, int, int | None], list[Change]] = {}
    for change in changes:
        is_worse = change.line["verdict"] in ("worse", GONE)
        kind = BETTER if not is_worse else WORSE if change.mended is None else MENDED
        by_commit.setdefault((kind, change.at, change.mended), []).append(change)
    groups = [Group(*key, _ranked(several)) for key, several in by_commit.items()]
    kinds = (WORSE, MENDED, BETTER)
    return sorted(groups, key=lambda group: (kinds.index(group.kind), rank_key(headline(group.lines)), group.at))


def _ranked(changes: Sequence[Change]) -> list[Change]:
    places = {id(line): place for place, line in enumerate(in_order([change.line for change in changes]))}
    return sorted(changes, key=lambda change: places[id(change.line)])


def _figures(groups: Sequence[Group], series: Sequence[Series], columns: set[str]) -> list[tuple[Series, str]]:
    """Return the figures to show for all runs, each as a series and a column: the figures in the named columns or,
    if no column is named, the most telling figure of each row that changed. Of rows with identical changes, only the
    first counts."""
    if columns:
        return [(shown_series, name) for shown_series in series for name in shown_series.judged if name in columns]
    figures: dict[tuple[Any, ...], tuple[Series, str]] = {}
    for group in groups:
        for row in _by_series(group.changes):
            line, row_series = headline([change.line for change in row]), row[0].series
            # Of rows that changed from the same to the same, the first.
            alike = (row_series.table.name, group.at, group.mended, line["column"], line["before"], line["after"])
            if line["column"] and (row_series, line["column"]) not in figures.values():
                figures.setdefault(alike, (row_series, line["column"]))
    return list(figures.values())


def _by_series(changes: Sequence[Change]) -> list[list[Change]]:
    by_series: dict[int, list[Change]] = {}
    for change in changes:
        by_series.setdefault(id(change.series), []).append(change)
    return list(by_series.values())


def _tell_what_else(runs: Sequence[Past], groups: Sequence[Group]) -> None:
    """Report on standard error what else changed at the commits of the groups."""
    apart = list(named_apart(runs))
    for index in dict.fromkeys(group.at for group in groups):
        if apart[index]:
            tell(f"also changed at {runs[index].name}: {apart[index]}")


def _lead(runs: Sequence[Past], series: Sequence[Series], groups: Sequence[Group]) -> str:
    """Return the text above the table: the runs, the number of rows not compared, and a sentence for each commit that
    made a figure worse."""
    first, last = runs[0], runs[-1]
    lines = [f"{len(runs)} run{'s' * (len(runs) > 1)}, from {_called(first)} to {_called(last)}"]
    others = len(series) - len({(each.table.name, each.called) for each in series})
    lines += [f"{others} rows not compared, because their counts of normals differ"] if others else []
    worse = [group for group in groups if group.kind != BETTER]
    lines += [_sentence(runs, group) for group in worse[:SENTENCES]]
    more = len(worse) - SENTENCES
    lines += [f"and {more} more"] if more > 0 else []
    return "\n".join(lines if worse else [*lines, "no figure got worse"])


def _called(past: Past) -> str:
    return ", ".join([past.name, past.day]) + (f" ({past.subject})" if past.subject else "")


def _sentence(runs: Sequence[Past], group: Group) -> str:
    before = max(run for run in group.changes[0].series.runs if run < group.at)
    lines = sentences(runs[before].done, runs[group.at].done, group.lines)
    more = f"; and {len(lines) - 1} more" if len(lines) > 1 else ""
    mended = f"; mended at {_called(runs[group.mended])}" if group.mended is not None else ""
    return f"since {_called(runs[group.at])}: {lines[0]}{more}{mended}"


def _lines(runs: Sequence[Past], groups: Sequence[Group]) -> list[Row]:
    """Return the rows of the table for people: changes by group, each with its commit, the date of the commit and the
    commit that mended it."""
    most = max(1, LINES // max(1, len(groups)))
    return [
        {"commit": runs[group.at].name, "date": runs[group.at].day}
        | line
        | {"mended": runs[group.mended].name if group.mended is not None else None}
        for group in groups[:LINES]
        for line in in_short(group.lines, most)
    ]


def _total(runs: Sequence[Past], series: Sequence[Series], groups: Sequence[Group]) -> str:
    more = f"; for {len(groups) - LINES} more changes, use --format json" if len(groups) > LINES else ""
    return f"{len(series)} rows over {len(runs)} runs{more}"


def _line(runs: Sequence[Past], change: Change) -> Row:
    """Return a change as a row for programs, with facts about its commit."""
    about = _about(runs[change.at])
    kept = {name: change.line[name] for name in ("table", "row", "column", "before", "after", "change", "verdict")}
    return about | kept | {"mended": runs[change.mended].full_name if change.mended is not None else None}


def _about(past: Past) -> Row:
    time_text = datetime.fromtimestamp(past.seconds, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {"commit": past.full_name, "time": time_text, "subject": past.subject}


def _across(runs: Sequence[Past], figures: Sequence[tuple[Series, str]]) -> list[Row]:
    """Return a row for each run, with a column for each of the first MOST figures. Between the first and the last
    run, rows that repeat the row above are left out."""
    values = {f"{name} {row_series.called}": dict(row_series.over_all(name)) for row_series, name in figures[:MOST]}
    rows = [{called: by_run.get(i) for called, by_run in values.items()} for i in range(len(runs))]
    kept = [i for i, row in enumerate(rows) if i in (0, len(runs) - 1) or row != rows[i - 1]]
    return [{"commit": runs[i].name, "date": runs[i].day} | rows[i] for i in kept] if figures else []


def _long(runs: Sequence[Past], figures: Sequence[tuple[Series, str]]) -> list[Row]:
    """Return a row for each figure in each run that has it, with facts about the run's commit."""
    return [
        _about(runs[index]) | {"table": row_series.table.name, "row": row_series.called, "column": name, "value": value}
        for row_series, name in figures
        for index, value in row_series.over_all(name)
    ]


def _left_out(figures: Sequence[tuple[Series, str]]) -> str:
    if not figures:
        return ""
    more = f"; {len(figures) - MOST} more figures are left out; select figures with --encoding and --column"
    return f"runs with the same figures as the line above are left out{more * (len(figures) > MOST)}"
