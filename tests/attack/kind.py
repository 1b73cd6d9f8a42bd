"""The kinds of attack, and how a case may end."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

from normalbench.bench.door.cli import app as cli

MEASURED, REFUSED = "measured", "refused"
# An attack in a folder of its own: from a seed to how it ended. Whatever it raises is what must not happen.
Attack = Callable[[int], str]


@dataclass(frozen=True)
class Kind:
    """A kind of attack.

    Attributes:
        name: its name in the table.
        prepare: a function that makes what all cases need, in an empty folder.
        cases: number of cases in the whole attack.
        few: number of cases that the test suite tries.
        seconds: processor time that a case may take.
        chunk: number of cases that a process is given at once.
        reads_here_only: whether no file outside its folder may be opened.
    """

    name: str
    prepare: Callable[[Path], Attack]
    cases: int
    few: int = 20
    seconds: float = 2.0
    chunk: int = 1000
    reads_here_only: bool = False


def command(*words: str) -> tuple[int, str, str]:
    """Run a command line in this process; return its exit status, output and errors."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), patch.object(sys, "argv", ["normalbench", *words]):
        try:
            status = cli.main()
        except SystemExit as end:
            raise AssertionError(f"SystemExit({end.code}) of {words}") from end
    return status, out.getvalue(), err.getvalue()


def outcome(status: int, err: str) -> str:
    """Return how a command ended: measured, or refused in one line. Raises AssertionError for anything else."""
    assert status in (0, 1, 2, 3), f"status {status}: {err}"
    lines = err.splitlines()
    assert all(line.startswith("normalbench: ") and line.isprintable() for line in lines), err
    if status < 2:
        return MEASURED
    assert len(lines) == 1 and len(lines[0]) < 2000, err
    return REFUSED


def one_line(error: Exception) -> str:
    """Check that an error of a file reader is one line, and return REFUSED."""
    assert str(error) and "\n" not in str(error), str(error)
    return REFUSED
