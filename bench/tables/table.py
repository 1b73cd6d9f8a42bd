"""The definition of a table, with each fact stated once. Imports nothing heavy.

A table is a folder with two files, and one line in `registry.py`:

    table.py    TABLE, a Table: name, options, columns, page section. Imported whenever the program starts.
    work.py     WORK, a Work: how the rows are measured and shown. Imported only if the table is measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...reports.sheets import Column, Role, Row, Section, Sheet, column_called

# What a step may be measured with, besides JAX: see `Work.needs`.
GL, VULKAN, COMPILERS, C_COMPILER = "GL device", "Vulkan device", "compilers", "C compiler"
# By the back end of a step. Codes in half precision are computed on a Vulkan device in place of GL.
BACKENDS_NEED: Mapping[str, frozenset[str]] = MappingProxyType(
    {"jax": frozenset(), "glsl": frozenset({GL, VULKAN}), "wgsl": frozenset({VULKAN})}
)
# Called once for each chunk of a step that is done.
Tick = Callable[[str], None]
# What the key of a part of a step has besides the step's own.
PART = "part"
# What may go wrong with rows that another version wrote, or somebody's hand.
UNEXPECTED = (KeyError, TypeError, ValueError, IndexError, AttributeError)


class Group(StrEnum):
    """The purpose of a command; the program's help groups commands by purpose, in this order."""

    ANSWER = "The answer"
    MEASURE = "Measure"
    OWN = "Your own"
    KEEP = "Keep and compare"
    MACHINE = "This program and this machine"


@dataclass(frozen=True, kw_only=True)
class NoOutputs:
    """Output options for a table that writes only its rows."""


@dataclass(frozen=True)
class Step:
    """A unit that is measured, kept and resumed as a whole: one or more rows.

    Attributes:
        key: everything that determines the rows except the machine and the source code, as plain values.
        case: the case that the table's own code measures.
        name: the step's name in a progress bar.
        ticks: the number of chunks in the step.
        parts: steps that are measured in place of a long step; `Work.merge` makes its rows from theirs.
    """

    key: Row
    case: Any
    name: str
    ticks: int = 1
    parts: Sequence[Step] = ()


@dataclass(frozen=True)
class Measured:
    """A table's request with its measured rows.

    Attributes:
        options, outputs: the request.
        steps: the measured steps.
        rows: the finished rows.
        kept: the rows of each step, as measured.
    """

    options: Any
    outputs: Any
    steps: Sequence[Step]
    rows: Sequence[Row]
    kept: Sequence[Sequence[Row]] = ()


def _all_rows(rows: Sequence[Row]) -> list[Row]:
    return list(rows)


def _last_row(_: Step, rows: Sequence[Row]) -> list[Row]:
    return list(rows[-1:])


def _no_items(*_: Any) -> Iterator[Any]:
    yield from ()


def _none(*_: Any) -> None:
    return None


def _by_backend(step: Step) -> frozenset[str]:
    """Return what a step's backend needs; a step without a backend needs the same as GLSL."""
    return BACKENDS_NEED[step.key.get("backend", "glsl")]


def _no_extras(folder: Path, tables: Mapping[str, Sequence[Row]], remarks: list[str]) -> Mapping[str, Any]:  # noqa: ARG001
    return {}


def _has_repeats(step: Step) -> bool:
    return bool(step.key.get("repeats"))


@dataclass(frozen=True, kw_only=True)
class Work:
    """The code that measures and shows a table. Everything here may import heavy packages.

    Attributes:
        steps: a function from options and outputs to steps. Raises UsageError and MissingError.
        check: checks the outputs that a user requested. Raises UsageError before anything is measured.
        measure: yields the rows of each step, in the order of the steps.
        merge: returns the rows of a step that is measured in parts, from all rows of its parts in order.
        finish: completes new rows with values that depend on all rows, such as order and ranks. It is called when
            rows are measured and when a run is read; all other functions receive finished rows.
        shown: returns the sheets that show finished rows to people; None to show the rows unchanged.
        verdict: returns the conclusion from finished rows, as an engineer would put it: a sentence, and more if
            needed.
        summary: yields the sheets that people look at first, below the verdict.
        warnings: returns a line for each row that was measured but is suspicious.
        failures: returns a line for each row that makes the command fail.
        write: writes the requested files other than the rows. Returns lines that make the command fail.
        charts: returns `chart.Chart` values for rows, drawn on the page, in the files of `run`, in notebooks and for
            --plot.
        plotted: returns the charts for --plot; None if they are the `charts` of the rows.
        extras: returns the page's contents other than the rows, by attribute of `found.Found`, from a run's folder,
            its rows by table, and remarks that it may add to.
        joined: returns the page's charts that need rows of several tables, from the page's contents, a `found.Found`.
        subjects: yields the images that `write` saved for rows in a folder, as `pixels.Subject` values for the page.
        films: yields the animations that `write` saved for rows in a folder, as `pixels.Film` values for the page.
        worst: returns the normal with the largest error in a step's codec; None if no such normal is known.
        listing: returns as text the instructions that a row's figures were counted from; None if they are not known.
        lacking: returns what proved to be missing on this machine; the exit status is then 3.
        missing: returns why `run` leaves the table out on this machine; empty if it does not.
        needs: returns what measuring a step needs besides JAX: GL, VULKAN, COMPILERS, C_COMPILER. Workers that lack
            it, or have a different version, do not measure the step.
        is_timed: whether a step's rows contain times; such a step is measured by the requesting process, after all
            other steps.
        stays: whether measuring leaves data in the process that `write` or `lacking` uses, so that no other process
            can measure the table.
    """

    steps: Callable[[Any, Any], Sequence[Step]]
    measure: Callable[[Sequence[Step], Tick], Iterator[list[Row]]]
    check: Callable[[Any, Sequence[Step]], None] = _none
    merge: Callable[[Step, Sequence[Row]], list[Row]] = _last_row
    finish: Callable[[Sequence[Row]], list[Row]] = _all_rows
    shown: Callable[[Measured], Iterable[Sheet]] | None = None
    verdict: Callable[[Sequence[Row]], Iterable[str]] = _no_items
    summary: Callable[[Sequence[Row]], Iterator[Sheet]] = _no_items
    warnings: Callable[[Sequence[Row]], Iterable[str]] = _no_items
    failures: Callable[[Sequence[Row]], Iterable[str]] = _no_items
    write: Callable[[Measured, Tick], Iterable[str] | None] = _none
    charts: Callable[[Sequence[Row]], Iterable[Any]] = _no_items
    plotted: Callable[[Measured], Iterable[Any]] | None = None
    extras: Callable[[Path, Mapping[str, Sequence[Row]], list[str]], Mapping[str, Any]] = _no_extras
    joined: Callable[[Any], Iterable[Any]] = _no_items
    subjects: Callable[[Path, Sequence[Row]], Iterator[Any]] = _no_items
    films: Callable[[Path, Sequence[Row]], Iterator[Any]] = _no_items
    worst: Callable[[Step], Any] = _none
    listing: Callable[[Step, Row], str | None] = _none
    lacking: Callable[[Measured], Iterable[str]] = _no_items
    missing: Callable[[], str] = str
    needs: Callable[[Step], frozenset[str]] = _by_backend
    is_timed: Callable[[Step], bool] = _has_repeats
    stays: bool = False

    @property
    def has_charts(self) -> bool:
        """Whether the table defines charts, in `charts` or `plotted`."""
        return self.charts is not _no_items or self.plotted is not None


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """A table: its command, options, columns and place on the page.

    Attributes:
        package: the package of the table's code: `__package__` in the file that defines the table.
        help: the command's help: a sentence, and a paragraph if needed.
        example: a command that answers a common question.
        options: the dataclass of what is measured; used by the command line, tests, gates and Python.
        outputs: the dataclass of what may be written besides the rows.
        columns: the columns of the rows, in order.
        also: columns that occur only in summaries.
        section: the table's part of the page.
        group: the group of the command in the program's help.
        usual: the sets of options that `run` measures if no others are given.
        usual_where_said: by option, what replaces parts of `usual` if `run` is given that option.
        single: the default options of a gate or a test.
        files: by output, the folder or file in a run that contains it.
        by: a column; for people, rows are split into separate tables by its value.
        partial: whether a row that says why figures are missing may have other figures.
        in_all: whether `run` measures the table by default.
        asked_by: an option; if it is given, `run` measures the table by default.
        not_with: an option; if it is given, `run` measures the table only if it is named.
        is_usual: whether a gate or a test that names no table means this table.
        is_kept: whether the command repeats its answer as long as nothing that determines the answer has changed.
        step_s: seconds per step in the default run, on two cores; used as an estimate until a run has measured steps.
        compilers: columns that name the compilers behind a row's figures; figures from different versions are not
            compared.
    """

    package: str
    help: str
    example: str
    options: type
    columns: tuple[Column, ...]
    section: Section
    outputs: type = NoOutputs
    group: Group = Group.MEASURE
    also: tuple[Column, ...] = ()
    usual: tuple[Mapping[str, Any], ...] = ({},)
    usual_where_said: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    single: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    by: str = ""
    partial: bool = False
    in_all: bool = True
    asked_by: str = ""
    not_with: str = ""
    is_usual: bool = False
    is_kept: bool = False
    step_s: float = 0.3
    compilers: tuple[str, ...] = ()

    def is_in_all(self, options: Mapping[str, Any]) -> bool:
        """Whether `run` with these options, by name, measures the table if no tables are named."""
        is_usual = self.in_all and options.get(self.not_with) is None
        return is_usual or options.get(self.asked_by) is not None

    @property
    def name(self) -> str:
        """The name of the table's folder, which is also its command, its name in a run and its anchor on the page."""
        return self.package.rpartition(".")[2]

    @property
    def work(self) -> Work:
        """The code that measures and shows the table."""
        return import_module(f"{self.package}.work").WORK

    def empty(self, parts: Iterable[str] = ()) -> Row:
        """Return a row without values; a column with `*` in its name becomes one column per item of `parts`."""
        names = [[c.name.replace("*", part) for part in parts] if "*" in c.name else [c.name] for c in self.columns]
        return dict.fromkeys(name for several in names for name in several)

    def column(self, name: str) -> Column | None:
        """Return the column with this name in a row or a summary; None if there is no such column."""
        return _column_of(self, name)

    def of_role(self, *roles: Role) -> list[Column]:
        """Return the columns of some roles."""
        return [column for column in self.columns if column.role in roles]

    def as_now(self, row: Row) -> Row:
        """Return an older version's row with missing key columns added, at the values they had at that time."""
        return row | {c.name: c.before for c in self.of_role(Role.KEY) if c.before and c.name not in row}

    def name_of(self, row: Mapping[str, Any]) -> str:
        """Return the name of a row: the values of its key columns."""
        return " ".join(str(row[c.name]) for c in self.of_role(Role.KEY) if row.get(c.name) is not None)

    def warnings(self, rows: Sequence[Row]) -> Iterator[str]:
        """Yield warnings about rows: results that are NaN or infinite, and the table's own warnings."""
        for row in rows:
            if row.get("invalid"):
                yield f"{self.name_of(row)}: {row['invalid']} results are NaN or infinite"
        yield from self.work.warnings(rows)

    def lacking(self, done: Measured) -> list[str]:
        """Return what proved to be missing on the machine, each item once."""
        return list(dict.fromkeys(self.work.lacking(done)))

    def drops(self, rows: Sequence[Row]) -> tuple[str, ...]:
        """Return the names of the columns that a narrow terminal leaves out, in order of removal."""
        ranks = {name: column.drops for name in (rows[0] if rows else ()) if (column := self.column(name))}
        return tuple(sorted((name for name, rank in ranks.items() if rank), key=lambda name: ranks[name]))

    def without_hidden(self, rows: Iterable[Row]) -> list[Row]:
        """Return rows without the columns that are not shown."""
        hidden = {column.name for column in self.columns if not column.shown}
        return [{name: value for name, value in row.items() if name not in hidden} for row in rows]


@cache
def _column_of(table: Table, name: str) -> Column | None:
    """Return the column of a table with this name; None if there is no such column. Cached, because there are many
    rows and name patterns are slow to match."""
    return column_called(name, (*table.columns, *table.also))


def each(measure_case: Callable[[Any], Sequence[Row]]) -> Callable[[Sequence[Step], Tick], Iterator[list[Row]]]:
    """Return the `measure` function of a Work that measures one case at a time.

    Args:
        measure_case: a function from a case to its rows."""

    def measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
        for step in steps:
            rows = list(measure_case(step.case))
            tick(step.name)
            yield rows

    return measure
