"""The second process of a run, which measures tables while the first process renders others.

Python and the code that it waits for keep one core busy, and llvmpipe leaves much of a second core idle. A run starts
the process with `second_process`, and tells it what to call. The process also writes the files of the tables that it
measures.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from ..ground.machine.cores import cores
from ..ground.output.errors import MissingError, UsageError, tell
from ..keep.plain import key_text
from ..keep.runs import Run
from ..tables.table import Row, Step, Table
from .measuring import Asked, with_parts
from .piped import Piped, Send


@dataclass(frozen=True)
class Kept:
    """The rows of a step, and the text of the step's key."""

    step: str
    rows: list[Row]


@dataclass(frozen=True)
class Written:
    """A message that all steps of a table have been measured and its files written."""

    table: str


@dataclass(frozen=True)
class Finished:
    """A message that all work is done."""


def is_worth_it(tables: Sequence[Table]) -> bool:
    """Whether a second process can measure at the same time: there are at least two tables and two cores."""
    return cores() > 1 and len(tables) > 1


class Second:
    """The second process, as used by the first process.

    Attributes:
        written: the names of tables whose files have been written.
    """

    def __init__(self, first: Callable[[Send], None]):
        self.written: set[str] = set()
        self._run: Run | None = None
        self._steps: dict[str, tuple[str, Step]] = {}
        self._error: Exception | None = None
        self._process = Piped(first, self._take)

    def measure(self, run: Run, asks: Iterable[Asked], function: Callable[..., None], *arguments: Any) -> None:
        """Have the process call a function that measures tables; the rows that it sends are stored in `run`."""
        steps = ((ask.table.name, step) for ask in asks for step in with_parts(ask.steps))
        self._run, self._steps = run, {key_text(name, step.key): (name, step) for name, step in steps}
        self._process.call(function, *arguments)

    def wait(self) -> None:
        """Wait until the tables are measured and written; rows are missing if the process was killed.

        Raises:
            UsageError, MissingError: measuring or writing failed.
        """
        self._process.ended.wait()
        if self._error:
            raise self._error

    def end(self) -> None:
        """End the process and all that it started, and report its messages; rows that it has sent are kept."""
        for line in self._process.wait():
            tell(line.removeprefix("normalbench: "))

    def _take(self, value: Kept | Written | Finished | Exception) -> None:
        try:
            self._keep(value)
        except (UsageError, MissingError) as error:
            self._error = error
            self._process.end()

    def _keep(self, value: Kept | Written | Finished | Exception) -> None:
        match value:
            case Kept():
                assert self._run
                self._run.keep(*self._steps[value.step], value.rows)
            case Written():
                self.written.add(value.table)
            case Finished():
                # What it holds in memory is the first process's now.
                self._process.end()
            case UsageError() | MissingError():
                raise value
            case _:
                tell(str(value))
                self._process.end()


@contextmanager
def second_process(first: Callable[[Send], None]) -> Iterator[Second]:
    """Yield a process that waits for tables to measure, and end it when the block ends.

    Args:
        first: the function that the process calls immediately, to import what it will need.
    """
    second = Second(first)
    try:
        yield second
    finally:
        second.end()
