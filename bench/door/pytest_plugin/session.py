"""The measurements of the pytest plugin, made once per session, and the checks that a test can apply to them."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn, ParamSpec, TypeVar

import pytest

from ....encodings.codecs.files import CatalogueError
from ...ground.machine.devices import found_device
from ...ground.options.option import checked_options, fields_of
from ...ground.output.errors import MissingError, UsageError
from ...tables.registry import TABLES
from ...tables.table import Row, Table
from ..gates.baseline import Baseline, checked_tolerances, entry
from ..gates.gates import WRITER
from ..gates.limits import Limit, limit, limits_on, not_a_limit, split_limits
from ..gates.measured import USUAL, Found, located, measured, single, table_named, with_their_options
from .own_options import REQUIRE_GL, SESSION, WRITE_BASELINE, baseline_path, destination, mirrored

P = ParamSpec("P")
T = TypeVar("T")


def ends_here(method: Callable[P, T]) -> Callable[P, T]:
    """Wrap a method that tests call, so that the traceback of a misuse or a broken limit ends in the test."""

    @functools.wraps(method)
    def call(*arguments: P.args, **named: P.kwargs) -> T:
        __tracebackhide__ = True
        try:
            return method(*arguments, **named)
        except AssertionError as error:
            raise AssertionError(str(error)) from None
        except (UsageError, CatalogueError) as error:
            raise UsageError(str(error)) from None

    return call


@dataclass
class Session:
    """The measurements of a test session.

    Attributes:
        usual: default options for tests, as typed in the folder `typed_in`.
        require_gl: whether a missing OpenGL driver fails a test that needs one, instead of skipping it.
        baseline: the file to compare with; None if none was named.
    """

    usual: Mapping[str, Any]
    typed_in: Path
    require_gl: bool
    baseline: Baseline | None
    _found: dict[str, list[Found]] = field(default_factory=dict, repr=False)

    def measured(self, table: Table, values: Mapping[str, Any], folder: Path) -> Measured:
        """Return the rows of a table with checks on them, measured now or earlier in this session. Files named in
        `values` are relative to `folder`.

        Raises:
            UsageError, MissingError: see measured.measured.
        """
        known = fields_of(table.options)
        usual = {name: known[name].parsed(value) for name, value in self.usual.items() if name in known}
        asked = checked_options(table.options, {**usual, **values})
        explicit = {name: value for name, value in asked.items() if name in values}
        options = located(table, asked, self.typed_in) | located(table, explicit, folder)
        key = json.dumps([table.name, str(Path.cwd()), options], sort_keys=True)
        if key not in self._found:
            self._found[key] = measured(table, options)
        return Measured(self, table, asked, self._found[key])

    def lacking(self, error: MissingError) -> NoReturn:
        """Skip the test if this machine has no OpenGL device and the tests do not require one. Otherwise fail the
        test, because anything else can be installed with pip."""
        if str(error) == found_device()[1] and not self.require_gl:
            pytest.skip(str(error))
        pytest.fail(str(error), pytrace=False)


@dataclass(frozen=True)
class Measured:
    """Rows, mostly of one codec, and checks on them. If there is only one row, `measured["psnr_db"]` is its
    figure."""

    session: Session = field(repr=False)
    table: Table
    asked: Mapping[str, Any]
    found: list[Found] = field(repr=False)

    @property
    def rows(self) -> list[Row]:
        """The rows as a list of dicts by column."""
        return [measurement.row for measurement in self.found]

    @ends_here
    def __getitem__(self, column: str) -> Any:
        if len(self.found) != 1:
            raise UsageError(f"there are {len(self.found)} rows; choose one from .rows")
        self._skip_where_lacking()
        return self.rows[0][column]

    @ends_here
    def assert_that(self, **limits: str) -> None:
        """Check that every row meets limits on columns: psnr_db="at least 49.5", angle_max_deg="at most 0.96".

        Raises:
            AssertionError: a row breaks a limit; the message has the figure, the limit and the worst normal.
            UsageError: a column is unknown, or its value is not a limit.
        """
        if not limits:
            raise UsageError('no threshold given; add for example psnr_db="at least 47.5"')
        self.hold(_checked_limit(column, text) for column, text in limits.items())

    def hold(self, limits: Iterable[Limit]) -> None:
        """Check that every row meets every limit; see `assert_that`."""
        limits = list(limits)
        for bound in limits:
            bound.check(self.table)
            option = bound.option_of(self.table)
            if option and not getattr(self.table.options(**self.asked), option):
                raise UsageError(f"{bound.column} is measured only with {option}=True; add it")
        self._raise_for((measurement, self._broken(measurement.row, limits)) for measurement in self._measurable())

    def _broken(self, row: Row, limits: Iterable[Limit]) -> list[str]:
        return [message for bound in limits_on(row, limits) if (message := bound.broken_by(self.table, row))]

    @ends_here
    def matches_baseline(self, **tolerances: float) -> None:
        """Check that every row equals its baseline entry, to the last digit unless a tolerance is given.

        With --normalbench-write-baseline, record the rows for the baseline instead.

        Raises:
            AssertionError: a row differs, or is missing from the baseline.
            UsageError: no baseline is named, or the file is not a baseline.
        """
        baseline = self.session.baseline
        if not baseline:
            raise UsageError("no baseline; name one with --normalbench-baseline FILE")
        checked_tolerances(tolerances, list(self.rows[0]))
        wrong: list[tuple[Found, list[str]]] = []
        for measurement in self._measurable():
            record = entry(self.table, self._request(), measurement.row, measurement.listing)
            if baseline.writes:
                baseline.record(record)
            else:
                wrong.append(
                    (
                        measurement,
                        [
                            f"{self.table.name_of(measurement.row)}: {x}"
                            for x in baseline.differences(record, tolerances)
                        ],
                    )
                )
        self._raise_for(wrong)

    def _request(self) -> dict[str, Any]:
        """Return the values of all options; options that were not given have their usual values."""
        return asdict(self.table.options(**single(self.table, self.asked)))

    def _measurable(self) -> list[Found]:
        """Return the rows, except rows that lack figures because this machine has no OpenGL device."""
        missing = found_device()[1] if any(row.get("skipped") for row in self.rows) else ""
        return [measurement for measurement in self.found if not missing or measurement.row.get("skipped") != missing]

    def _raise_for(self, wrong: Iterable[tuple[Found, list[str]]]) -> None:
        lines: list[str] = []
        for measurement, messages in wrong:
            lines += messages
            lines += [f"  worst normal: {measurement.worst}"] if messages and measurement.worst else []
        if lines:
            raise AssertionError("\n".join(lines))
        self._skip_where_lacking()

    def _skip_where_lacking(self) -> None:
        if len(self._measurable()) < len(self.found):
            self.session.lacking(MissingError(found_device()[1]))


def _checked_limit(column: str, text: Any) -> Limit:
    bound = limit(column, text)
    if not bound:
        raise not_a_limit(column, text)
    return bound


@dataclass(frozen=True)
class Normalbench:
    """The value of the fixture `normalbench`: a method for each table, with the options of its command.

    A file is looked for in the test's folder first.
    """

    session: Session = field(repr=False)
    folder: Path

    def __getattr__(self, name: str) -> Callable[..., Measured]:
        """Return a table's method, which measures with the options of the table's command."""
        if name not in TABLES:
            raise AttributeError(f"no table {name!r}; known: {', '.join(TABLES)}")
        return functools.partial(self._measured, TABLES[name])

    @ends_here
    def hold(self, table: Table, options: Mapping[str, Any], limits: Iterable[Limit]) -> None:
        """Measure with these options, and check that every row meets the limits; see `Measured.assert_that`."""
        limits = list(limits)
        for bound in limits:
            bound.check(table)
        self._measured(table, **with_their_options(table, options, limits)).hold(limits)

    def matches(self, table: Table, options: Mapping[str, Any], path: Path) -> None:
        """Measure with these options, and compare every row with the baseline in a file; see
        `Measured.matches_baseline`."""
        measured = self._measured(table, **options)
        replace(measured, session=replace(measured.session, baseline=Baseline(path, False, WRITER))).matches_baseline()

    @ends_here
    def hold_mark(self, positional: tuple[Any, ...], values: Mapping[str, Any]) -> None:
        """Run the checks that a marker requests. Raises AssertionError if a row breaks a limit, UsageError if the
        marker is misused."""
        if positional:
            raise UsageError(f"the marker normalbench takes options and thresholds by name, not {positional[0]!r}")
        table = table_named(values.get("table", USUAL))
        options, limits = split_limits({name: value for name, value in values.items() if name != "table"}, table)
        self.hold(table, options, limits)

    @ends_here
    def _measured(self, table: Table, /, **options: Any) -> Measured:
        try:
            return self.session.measured(table, options, self.folder)
        except MissingError as error:
            self.session.lacking(error)


def session_of(config: pytest.Config) -> Session:
    """Return the session of this process, which is created on first use."""
    if SESSION not in config.stash:
        usual, path = {name: config.getoption(destination(name)) for name in mirrored()}, baseline_path(config)
        config.stash[SESSION] = Session(
            usual={name: value for name, value in usual.items() if value is not None},
            typed_in=config.invocation_params.dir,
            require_gl=bool(config.getoption(destination(REQUIRE_GL))),
            baseline=Baseline(path, bool(config.getoption(destination(WRITE_BASELINE)))) if path else None,
        )
    return config.stash[SESSION]
