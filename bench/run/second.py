"""The second process of a run, which measures tables while the first one renders others.

One process renders, and llvmpipe leaves much of the second core idle; JAX and compilers need no more than one. A run
starts it with `second_process`, and names the program that it runs. What it measured it draws, too.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import IO, Any

from ..ground.machine.children import environment, python
from ..ground.machine.cores import cores
from ..ground.machine.posix.processes import OWN_GROUP, end_group
from ..ground.output.errors import MissingError, UsageError, tell, told
from ..keep.plain import key_text
from ..keep.runs import Run
from ..tables.table import Step, Table
from .measuring import Asked, with_parts

ERRORS: Mapping[int, type[Exception]] = {error.exit_code: error for error in (UsageError, MissingError)}


def is_worth_it(tables: Iterable[Table]) -> bool:
    """Whether there is something to measure at the same time, and a core for it."""
    return cores() > 1 and len({table.is_measured_beside for table in tables}) > 1


class Second:
    """The second process, as the first one sees it.

    Attributes:
        written: the tables whose files are written, too.
        drawn: the charts that it drew: by name, what each shows.
    """

    def __init__(self, process: subprocess.Popen[str]):
        self.written: set[str] = set()
        self.drawn: dict[str, str] = {}
        self._process, self._error = process, None
        self._run: Run | None = None
        self._steps: dict[str, tuple[str, Step]] = {}
        self._ended = Event()
        self._reader = Thread(target=self._read, daemon=True)

    def measure(self, run: Run, what: Mapping[str, tuple[Sequence[Asked], Mapping[str, Any]]]) -> None:
        """Have it measure tables into a run.

        Args:
            what: tables and the options that were given: those to "measure", and those that this process measures, of
                which it is to "write" the files.
        """
        self._run = run
        steps = ((ask.table.name, step) for ask in what["measure"][0] for step in with_parts(ask.steps))
        self._steps = {key_text(name, step.key): (name, step) for name, step in steps}
        self._reader.start()
        orders = {do: {"tables": [ask.table.name for ask in asks], "said": said} for do, (asks, said) in what.items()}
        given = {"folder": str(run.folder), "told": sorted(told), **orders}
        pipe = self._process.stdin
        assert pipe
        # What ends early says why in another way; a pipe that closes tries again to write what it holds.
        try:
            pipe.write(json.dumps(given) + "\n")
            pipe.flush()
        except BrokenPipeError:
            with suppress(BrokenPipeError):
                pipe.close()

    def wait(self) -> None:
        """Until its tables are measured and written; rows are missing where something killed it.

        Raises:
            UsageError, MissingError: what was wrong there.
        """
        self._ended.wait()
        if self._error:
            raise self._error

    def end(self) -> None:
        """End the process, and what it started; rows that it has sent are kept."""
        end_group(self._process.pid)
        if self._run:
            self._reader.join()

    def _read(self) -> None:
        try:
            for line in self._process.stdout or ():
                # A line without an end is of a process that was killed meanwhile.
                if line.endswith("\n"):
                    self._take(json.loads(line))
        except Exception as error:  # raised again where somebody waits
            self._error = error
        finally:
            self._ended.set()

    def _take(self, line: Mapping[str, Any]) -> None:
        assert self._run
        if "rows" in line:
            self._run.keep(*self._steps[line["step"]], line["rows"])
        elif "written" in line:
            self.written.add(line["written"])
        elif "drawn" in line:
            self.drawn = line["drawn"]
        else:
            raise ERRORS[line["status"]](line["error"])


@contextmanager
def second_process(program: str) -> Iterator[Second]:
    """A process that imports what it will need, and waits for what to measure; ended with the block.

    Args:
        program: the module that it runs.
    """
    command = python(program)
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as errors,
        _started(command, errors) as process,
    ):
        second = Second(process)
        try:
            yield second
        finally:
            second.end()
            _tell_all(errors)


def _started(command: list[str], errors: IO[str]) -> subprocess.Popen[str]:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": errors}
    return subprocess.Popen(command, text=True, env=environment(), **OWN_GROUP, **pipes)


def _tell_all(errors: IO[str]) -> None:
    errors.seek(0)
    for line in errors:
        tell(line.removeprefix("normalbench: "))
