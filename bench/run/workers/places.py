"""Where a command measures: in its own process, or by workers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..measuring import HERE, Here
from .carrier import Carrier
from .local import LocalWorkers
from .words import Local, place_named, require_dask

if TYPE_CHECKING:
    from .pool import Pool


@contextmanager
def place(on: str | None) -> Iterator[Here | Pool]:
    """What `--on` names, as long as a command runs; this process where it names nothing.

    Raises:
        UsageError: a word that names no place, or an address where nobody answers.
        MissingError: dask.distributed is not installed, which an address needs.
    """
    if on is None:
        yield HERE
        return
    carrier = _carrier(on)
    try:
        # Imported while workers start.
        from .about import about
        from .crew import Crew
        from .pool import Pool

        yield Pool(Crew(carrier, about()))
    finally:
        carrier.close()


def _carrier(on: str) -> Carrier:
    named = place_named(on)
    if isinstance(named, Local):
        return LocalWorkers(named.count)
    require_dask()
    # It imports dask, which nothing else needs.
    from .link import Link

    return Link(named.text)
