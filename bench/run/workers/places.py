"""Where a command measures: in its own process, or by workers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..measuring import HERE, Here
from .words import Local, place_named, require_dask

if TYPE_CHECKING:
    from .pool import Pool


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
    with _crew(named.text) as pool:
        yield pool


@contextmanager
def _local(count: int) -> Iterator[Pool]:
    from dask import config

    from .local import LocalProcesses

    processes = LocalProcesses(count)
    # Its defaults are part of dask's configuration from now on: imported below, they would be gone with the setting.
    import distributed  # noqa: F401

    try:
        # They listen on this machine alone.
        with (
            config.set({"distributed.comm.require-encryption": False}),
            _crew(processes.address, processes.look_after) as pool,
        ):
            yield pool
    finally:
        processes.close()


@contextmanager
def _crew(address: str, look_after: Callable[[], bool] = lambda: False) -> Iterator[Pool]:
    # Imported while workers start.
    from .about import about
    from .crew import Crew
    from .pool import Pool

    crew = Crew(address, about(), look_after)
    try:
        yield Pool(crew)
    finally:
        crew.close()
