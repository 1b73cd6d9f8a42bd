"""Child processes that compile: their input, their output line by line, and the reasons why they ended."""

from __future__ import annotations

import json
import queue
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from ...ground.machine.children import python
from ...ground.machine.systems.processes import signal_name
from .driver_files import environment

CHILD: Sequence[str] = python("normalbench.bench.shaders.isa.child")
# Of one job, and of a driver that starts: far more than they take, on a busy machine as well.
SECONDS = 60.0

Lines = Callable[[], dict[str, Any] | None]


@dataclass(frozen=True)
class Driver:
    """A driver: its path for the loader, and the event that tells its children to stop.

    `command` starts a child process; if it is empty, CHILD is used.
    """

    path: Path
    stop: threading.Event
    command: Sequence[str] = ()


@contextmanager
def child(
    variables: Mapping[str, str], driver: Driver, given: dict[str, Any]
) -> Iterator[tuple[Lines, Callable[[], str]]]:
    """Start a child process that reads `given`, for the GPU that `variables` select, and yield two functions. The
    first returns the child's next line, or None at its end or after too long a silence; the second returns why the
    child ended. The child is killed when the block ends.

    The child's input and error output are unnamed files, so that no files remain, however this process ends.
    """
    with tempfile.TemporaryFile("w+", encoding="utf-8") as work, tempfile.TemporaryFile() as errors:
        json.dump(given, work)
        work.seek(0)
        with subprocess.Popen(
            driver.command or CHILD,
            stdin=work,
            stdout=subprocess.PIPE,
            stderr=errors,
            encoding="utf-8",
            errors="replace",
            env=environment(driver.path, variables),
        ) as process:
            lines: queue.Queue[str | None] = queue.Queue()
            reading = threading.Thread(target=_read, args=(process.stdout, lines), daemon=True)
            reading.start()
            try:
                heard = _Heard(lines, driver.stop)
                yield heard.following, lambda: heard.why(process, errors)
            finally:
                process.kill()
                # Its end is read before the stream is closed, also by a thread that a busy machine starts late.
                reading.join(SECONDS)


class _Heard:
    """The output of a child, line by line, until the child is silent for too long."""

    def __init__(self, lines: queue.Queue[str | None], stop: threading.Event):
        self._lines, self._stop, self._is_silent = lines, stop, False

    def following(self) -> dict[str, Any] | None:
        """Return the child's next line, parsed from JSON; None at the end, for a truncated line, after SECONDS of
        silence, or once the children are told to stop."""
        until = time.monotonic() + SECONDS
        while not self._stop.is_set() and time.monotonic() < until:
            try:
                line = self._lines.get(timeout=0.1)
            except queue.Empty:
                continue
            return _parsed(line)
        self._is_silent = True
        return None

    def why(self, process: subprocess.Popen[str], errors: IO[bytes]) -> str:
        """Return why the output ended: no response from the driver, or the process's exit status and `errors`."""
        if self._is_silent:
            return f"the driver did not respond within {SECONDS:g} s"
        status = process.wait(SECONDS)
        errors.seek(0)
        return _end_reason(status, errors.read().decode(errors="replace"))


def _parsed(line: str | None) -> dict[str, Any] | None:
    """Return the dictionary in a child's line of JSON; None at the end, and for a line cut short by a crash."""
    try:
        answer = json.loads(line or "null")
    except ValueError:
        return None
    return answer if isinstance(answer, dict) else None


def _read(stream: Any, lines: queue.Queue[str | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)


def _end_reason(status: int, errors: str) -> str:
    """Return a clause on how a child ended, with its exit status and the last line of its error output."""
    how = f"signal {name}" if (name := signal_name(status)) else f"status {status}"
    last = [line.strip() for line in errors.splitlines() if line.strip()]
    return f"the driver ended with {how}" + (f": {last[-1][:200]}" if last else "")
