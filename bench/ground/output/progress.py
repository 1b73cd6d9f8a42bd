"""A progress bar for whatever takes over a second, and the place where an interruption is not lost."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

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
        self._of = ""

    def advance(self, description: str) -> None:
        """One step further; what is under way now."""
        if ending:
            raise ending[0]
        self._bar.update(self._task, advance=1, description=f"{self._of}{description}")

    def begin(self, table: str, there: int) -> None:
        """A table of several, some of whose steps are there already."""
        self._begun[table] = None
        self._of = f"table {len(self._begun)} of {self._tables}, {table}: "
        self._bar.update(self._task, advance=there, description=self._of)


# The bar of a whole run, while there is one.
_whole: list[Bar] = []


@contextmanager
def _shown(steps: int, tables: int = 0) -> Iterator[Bar]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        yield Bar(bar, steps, tables)


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
