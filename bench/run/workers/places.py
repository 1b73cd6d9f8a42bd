"""The places where a command measures: its own process, or workers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

from ..measuring import HERE, Place
from .carrier import Carrier
from .local import LocalWorkers
from .words import place_named, require_dask


@contextmanager
def place(on: str | None) -> Iterator[Place]:
    """Yield the place that `--on` names, for as long as a command runs; this process if `on` is None.

    Raises:
        UsageError: the word does not name a place, or no scheduler responds at the address.
        MissingError: dask.distributed is not installed, and an address needs it.
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
