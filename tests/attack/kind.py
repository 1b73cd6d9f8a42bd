"""What a kind of attack is, and how a case of it may end."""

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
        name: as the table has it.
        prepare: makes what all cases need, in an empty folder.
        cases: how many there are in the whole.
        few: how many the suite tries.
        seconds: how much processor time a case may take.
        chunk: how many cases a process is given at once.
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
    """A command line in this process: its exit status, and what it says to either stream."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), patch.object(sys, "argv", ["normalbench", *words]):
        try:
            status = cli.main()
        except SystemExit as end:
            raise AssertionError(f"SystemExit({end.code}) of {words}") from end
    return status, out.getvalue(), err.getvalue()


def outcome(status: int, err: str) -> str:
    """How a command ended: well, or refused in one line. Raises AssertionError for anything else."""
    assert status in (0, 1, 2, 3), f"status {status}: {err}"
    lines = err.splitlines()
    assert all(line.startswith("normalbench: ") and line.isprintable() for line in lines), err
    if status < 2:
        return MEASURED
    assert len(lines) == 1 and len(lines[0]) < 2000, err
    return REFUSED


def one_line(error: Exception) -> str:
    """A refusal that a reader of files raises."""
    assert str(error) and "\n" not in str(error), str(error)
    return REFUSED
