"""A progress bar for whatever takes over a second, and the place where an interruption is not lost.

A run says how far it is where no bar can be shown.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread
from typing import Any

from ....reports.tables import visible
from .errors import tell_together

EVERY = 8  # seconds between two lines where there is no bar
# Set where a log is to have none of these lines.
OFF = "NORMALBENCH_NO_PROGRESS"
# What a signal raised to end the program. It may be raised where a library swallows it, as in a callback of the garbage
# collector; then the next step raises it again.
ending: list[BaseException] = []


class Bar:
    """A bar on standard error; none where that is no terminal.

    Args:
        steps: how many steps there are.
        tables: how many tables, where the bar is of several.
    """

    def __init__(self, bar: Any, steps: int, tables: int = 0):
        self._bar, self._tables, self._begun = bar, tables, dict[str, None]()
        self._task = bar.add_task("", total=steps)
        self._steps, self._done = steps, 0
        self._of = self._under_way = ""

    def advance(self, description: str) -> None:
        """One step further; what is under way now."""
        if ending:
            raise ending[0]
        self._move(1, f"{self._of}{description}")

    def begin(self, table: str, there: int) -> None:
        """A table of several, some of whose steps are there already."""
        self._begun[table] = None
        self._of = f"table {len(self._begun)} of {self._tables}, {table}: "
        self._move(there, self._of)

    def _move(self, steps: int, under_way: str) -> None:
        self._done, self._under_way = self._done + steps, under_way
        self._bar.update(self._task, advance=steps, description=visible(under_way))

    def says(self) -> str:
        """How far it is."""
        return f"{self._done} of {self._steps} steps, {self._under_way}"


# The bar of a whole run, while there is one.
_whole: list[Bar] = []


@contextmanager
def _shown(steps: int, tables: int = 0) -> Iterator[Bar]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    # Names of files are no markup.
    under_way = TextColumn("{task.description}", markup=False)
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), under_way)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        yield Bar(bar, steps, tables)


def _speak_until(ended: Event) -> None:
    waited = 0
    while not ended.wait(EVERY):
        waited += EVERY
        # Each line as it is: what is told once is counted in the main thread.
        tell_together(f"{waited} s, {_whole[-1].says() if _whole else 'it begins, or writes its files'}", ())


@contextmanager
def spoken() -> Iterator[None]:
    """Says how far a run is, at least every ten seconds, where standard error is no terminal, such as a log of CI."""
    ended = Event()
    speaker = Thread(target=_speak_until, args=(ended,), daemon=True)
    if not (os.environ.get(OFF) or sys.stderr.isatty()):
        speaker.start()
    try:
        yield
    finally:
        ended.set()


@contextmanager
def progress_of_all(steps: int, tables: int) -> Iterator[None]:
    """One bar for all tables of a run, which the bars of single tables become part of."""
    with _shown(steps, tables) as bar:
        _whole.append(bar)
        try:
            yield
        finally:
            _whole.remove(bar)


@contextmanager
def progress(steps: int, table: str = "", there: int = 0) -> Iterator[Callable[[str], None]]:
    """A bar that advances by one each time it is called with what is under way.

    Args:
        table: what is measured; `there` of its steps are there already. In a run with one bar for all it is part of it.
    """
    if _whole and table:
        _whole[-1].begin(table, there)
        yield _whole[-1].advance
        return
    with _shown(steps) as bar:
        yield bar.advance
