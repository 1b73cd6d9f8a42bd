"""Where a command measures: in its own process, or by workers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

from ..measuring import HERE, Place
from .carrier import Carrier
from .local import LocalWorkers
from .words import place_named, require_dask


@contextmanager
def place(on: str | None) -> Iterator[Place]:
    """Give what `--on` names, as long as a command runs; this process where it names nothing.

    Raises:
        UsageError: a word that names no place, or an address where nobody answers.
        MissingError: dask.distributed is not installed, which an address needs.
    """
    if on is None:
        yield HERE
        return
    with closing(_carrier(on)) as carrier:
        # Imported while workers start.
        from .pool import Pool

        yield Pool(carrier)


def _carrier(on: str) -> Carrier:
    named = place_named(on)
    if isinstance(named, int):
        return LocalWorkers(named)
    require_dask()
    # It imports dask, which nothing else needs.
    from .scheduled import Scheduled

    return Scheduled(named)
