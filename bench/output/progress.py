"""A progress bar for whatever takes over a second, and the place where an interruption is not lost."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

# What a signal raised to end the program. It may be raised where a library swallows it, as in a callback of the garbage
# collector; then the next step raises it again.
ending: list[BaseException] = []


@contextmanager
def progress(total: int) -> Iterator[Callable[[str], None]]:
    """A bar on standard error that advances by one each time it is called with what is under way; none where that is no
    terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    def advance(description: str) -> None:
        if ending:
            raise ending[0]
        bar.update(task, advance=1, description=description)

    console = Console(stderr=True)
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=total)
        yield advance
