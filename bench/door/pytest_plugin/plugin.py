"""The pytest plugin: measures a codec once per session and checks it against limits or a baseline.

    def test_normals(normalbench):
        row = normalbench.quality(encoding="octahedral", storage="rgba8")
        row.assert_that(psnr_db="at least 49.5", angle_max_deg="at most 0.96")

Heavy modules are imported only when something is measured, so that the plugin only adds a few options to a test run
that does not use it. With xdist, every worker measures what its own tests request, at most once.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from ...ground.options.option import Field
from ...ground.output.errors import UsageError
from .own_options import BASELINE, REQUIRE_GL, SESSION, WRITE_BASELINE, baseline_path, destination, flag, mirrored

if TYPE_CHECKING:
    from .session import Normalbench

MARKER = (
    'normalbench(table="quality", encoding=..., psnr_db="at least 49.5", ...): measure with these options of the '
    "table's command, and check the rows against these thresholds before the test runs."
)
KEPT = "normalbench_baseline"
REPORTED = pytest.StashKey[list[str]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("normalbench", "normalbench: defaults for tests that do not set these options")
    for name, fields in mirrored().items():
        group.addoption(flag(name), dest=destination(name), default=None, **_parsed(fields))
    group.addoption(
        flag(REQUIRE_GL),
        action="store_true",
        help="Fail tests that need OpenGL if there is no driver. Default: skip them.",
    )
    group.addoption(flag(BASELINE), metavar="FILE", help="Baseline file for .matches_baseline().")
    group.addoption(flag(WRITE_BASELINE), action="store_true", help="Write the baseline instead of comparing with it.")


def _parsed(fields: list[Field]) -> dict[str, Any]:
    """Return argparse's keyword arguments for an option, given the fields of the tables that have it."""
    kinds, help_text = {field.kind for field in fields}, " ".join(dict.fromkeys(field.option.help for field in fields))
    # Where tables take different kinds, each reads the text in its own way.
    kind = kinds.pop() if len(kinds) == 1 else str
    if kind is bool:
        return {"action": argparse.BooleanOptionalAction, "help": help_text.replace("%", "%%")}
    return {"type": kind, "metavar": kind.__name__.upper(), "help": help_text.replace("%", "%%")}


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", MARKER)
    if config.getoption(destination(WRITE_BASELINE)):
        _check_baseline(baseline_path(config))


def _check_baseline(path: Path | None) -> None:
    """Raise pytest.UsageError if no baseline is named or it cannot be written; called before anything is measured."""
    from ...ground.output.writing import check_writable

    if not path:
        raise pytest.UsageError(f"{flag(WRITE_BASELINE)} requires {flag(BASELINE)} FILE")
    try:
        check_writable(path, makes_folder=True)
    except UsageError as error:
        raise pytest.UsageError(str(error)) from error


@pytest.fixture
def normalbench(request: pytest.FixtureRequest) -> Normalbench:
    """Measure codecs: .quality(...) and .render(...) return rows to check. Files are relative to the test's folder."""
    return _measuring(request.config, request.path.parent)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Run the checks that a test's markers request, before the test itself. Fail the test if any check fails."""
    messages = [messages for mark in item.iter_markers("normalbench") if (messages := _broken(item, mark))]
    if messages:
        pytest.fail("\n".join(messages), pytrace=False)


def _measuring(config: pytest.Config, folder: Path) -> Normalbench:
    """Return the fixture's value for the tests of a folder."""
    from ...ground.machine.system import prepare

    prepare()
    from .session import Normalbench, session_of

    return Normalbench(session_of(config), folder)


def _broken(item: pytest.Item, mark: pytest.Mark) -> str:
    try:
        _measuring(item.config, item.path.parent).hold_mark(mark.args, mark.kwargs)
    except (AssertionError, UsageError) as error:
        return str(error)
    return ""


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Collect the baseline rows of a finished xdist worker, to be written together with the rows of the other
    workers."""
    if text := getattr(node, "workeroutput", {}).get(KEPT):
        node.config.stash.setdefault(REPORTED, []).append(text)


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Write the recorded rows to the baseline or, in an xdist worker, hand them to the process that writes it. Do
    nothing if no baseline is named, or the session was interrupted."""
    config, path = session.config, baseline_path(session.config)
    if exitstatus not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED) or not path:
        return
    own = config.stash[SESSION].baseline if SESSION in config.stash else None
    dumped = [*config.stash.get(REPORTED, []), own.dumped() if own else ""]
    if hasattr(config, "workeroutput"):
        config.workeroutput[KEPT] = "".join(dumped)  # pyright: ignore[reportAttributeAccessIssue] # of xdist's workers
    elif any(dumped):
        _write(path, [text for text in dumped if text])


def _write(path: Path, dumped: list[str]) -> None:
    from ..gates.baseline import write_baseline

    try:
        write_baseline(path, dumped)
    except UsageError as error:
        pytest.exit(str(error), returncode=2)
