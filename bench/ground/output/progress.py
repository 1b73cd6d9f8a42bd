"""A progress bar for work that takes over a second. Its steps also raise interruptions that a library has swallowed.

If no bar can be shown, a run reports its progress in lines.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from threading import Event, Thread
from typing import Any

from ....reports.tables import visible
from .errors import tell_together

EVERY = 8  # seconds between two lines where there is no bar
# What comes after all tables of a run.
PAGE = "writing the page"
# The expected time counts as much as this share of it that was measured.
TRUST = 0.1
# Set where a log is to have none of these lines.
OFF = "NORMALBENCH_NO_PROGRESS"
# What a signal raised to end the program. It may be raised where a library swallows it, as in a callback of the garbage
# collector; then the next step raises it again.
ending: list[BaseException] = []


class Bar:
    """A progress bar on standard error; not shown if standard error is not a terminal.

    Args:
        expected: for each table, its number of steps and the seconds that each step is expected to take.
    """

    def __init__(self, bar: Any, expected: Mapping[str, tuple[int, float]]):
        self._bar, self._expected, self._begun = bar, expected, dict[str, None]()
        self._all = sum(count * seconds for count, seconds in expected.values())
        self._task = bar.add_task("", total=self._all, left="")
        self._done, self._since, self._step = 0.0, time.monotonic(), next(iter(expected.values()))[1]
        self._of = self._under_way = ""

    def advance(self, description: str) -> None:
        """Advance by one step, and show the work that is now under way. Raises a pending interruption."""
        if ending:
            raise ending[0]
        self._move(self._step, f"{self._of}{description}")

    def begin(self, table: str, there: int) -> None:
        """Begin a table; `there` of its steps are already done and take no time."""
        self._begun[table] = None
        self._step = self._expected.get(table, (0, 0.0))[1]
        tables = len(self._expected) - (PAGE in self._expected)
        self._of = PAGE if table == PAGE else f"table {len(self._begun)} of {tables}, {table}: "
        self._all -= there * self._step
        self._move(0.0, self._of)

    def _move(self, seconds: float, under_way: str) -> None:
        self._done, self._under_way = self._done + seconds, under_way
        left = self._left_text()
        self._bar.update(self._task, completed=self._done, total=self._all, description=visible(under_way), left=left)

    def _left_text(self) -> str:
        """Return the remaining time as text, such as "about 1:05 left", estimated from the time that the
        finished steps took."""
        trusted = TRUST * self._all
        slower = (time.monotonic() - self._since + trusted) / (self._done + trusted) if self._all else 1.0
        minutes, seconds = divmod(round(max(0.0, self._all - self._done) * slower), 60)
        return f"about {minutes}:{seconds:02} left"

    def says(self) -> str:
        """Return the progress in words: the percentage, the remaining time, and the work under way."""
        share = self._done / self._all if self._all else 1.0
        return f"{100 * min(share, 1.0):.0f}%, {self._left_text()}, {self._under_way}"


# The bar of a whole run, while there is one.
_whole: list[Bar] = []


@contextmanager
def _shown(expected: Mapping[str, tuple[int, float]]) -> Iterator[Bar]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    console = Console(stderr=True)
    # Names of files are no markup.
    under_way = TextColumn("{task.description}", markup=False)
    texts = (TextColumn("{task.percentage:3.0f}%"), TextColumn("{task.fields[left]}"))
    columns = (BarColumn(), *texts, under_way)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        yield Bar(bar, expected)


def _speak_until(ended: Event) -> None:
    waited = 0
    while not ended.wait(EVERY):
        waited += EVERY
        # Each line as it is: what is told once is counted in the main thread.
        tell_together(f"{waited} s, {_whole[-1].says() if _whole else 'determining what to measure'}", ())


@contextmanager
def spoken() -> Iterator[None]:
    """Report the progress of a run at least every ten seconds if standard error is not a terminal, as in CI logs."""
    ended = Event()
    speaker = Thread(target=_speak_until, args=(ended,), daemon=True)
    if not (os.environ.get(OFF) or sys.stderr.isatty()):
        speaker.start()
    try:
        yield
    finally:
        ended.set()


@contextmanager
def progress_of_all(expected: Mapping[str, tuple[int, float]]) -> Iterator[None]:
    """Show one bar for all tables of a run, which includes the bars of single tables.

    Args:
        expected: for each table, its number of steps and the seconds that each step is expected to take.
    """
    with _shown(expected) as bar:
        _whole.append(bar)
        try:
            yield
        finally:
            _whole.remove(bar)


@contextmanager
def progress(steps: int, table: str = "", there: int = 0) -> Iterator[Callable[[str], None]]:
    """Yield a function that advances a bar by one step; its argument names the step that begins.

    Args:
        table: the measured table. In a run, its bar is part of the run's bar.
        there: the number of steps that are already measured.
    """
    if _whole and table:
        _whole[-1].begin(table, there)
        yield _whole[-1].advance
        return
    with _shown({table: (steps, 1.0)}) as bar:
        yield bar.advance
