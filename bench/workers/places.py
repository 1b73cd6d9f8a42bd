"""Where a command measures: in its own process, or by workers."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ..output.writing import whole_file
from ..results.measuring import HERE, Here
from .words import Local, place_named, require_dask

if TYPE_CHECKING:
    from .pool import Pool

# A run that workers measured keeps how long each step took them: `simulate` reads it.
TIMES = "step_times.json"


@contextmanager
def place(on: str | None) -> Iterator[Here | Pool]:
    """What `--on` names, as long as a command runs; this process where it names nothing.

    Raises:
        UsageError: a word that names no place, or an address where nobody answers.
        MissingError: dask.distributed is not installed.
    """
    if on is None:
        yield HERE
        return
    named = place_named(on)
    require_dask()
    if isinstance(named, Local):
        with _local(named.count) as pool:
            yield pool
        return
    from .about import about
    from .pool import Pool

    pool = Pool(named.text, about())
    try:
        yield pool
    finally:
        pool.close()


@contextmanager
def _local(count: int) -> Iterator[Pool]:
    from .local import LocalProcesses

    processes = LocalProcesses(count)
    try:
        # Imported while the workers start.
        from .about import about
        from .pool import Pool

        pool = Pool(processes.address, about(), processes.look_after)
        try:
            yield pool
        finally:
            pool.close()
    finally:
        processes.close()


def keep_times(where: object, folder: Path) -> None:
    """Write how long the steps of a run took workers; nothing where none measured."""
    times = getattr(where, "times", None)
    if times:
        with whole_file(folder / TIMES) as partial:
            partial.write_text(json.dumps(times, indent=None) + "\n", encoding="utf-8")
