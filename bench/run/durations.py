"""Expected durations of steps: as in an earlier run with the same options, else as on two cores without a GPU."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..ground.output import cache
from ..ground.output.progress import PAGE

if TYPE_CHECKING:
    from .measuring import Asked

# Seconds of the page, most of which its pictures take.
PAGE_S = 12.0


def expected(asks: Sequence[Asked], beside: Sequence[Asked]) -> dict[str, tuple[int, float]]:
    """Return for each table, and for the page, the number of parts and the expected seconds per part.

    Args:
        beside: the tables that a second process measures meanwhile; only the time by which it exceeds this process
            counts.
    """
    own = {ask.table.name: (_ticks(ask), _seconds(ask)) for ask in asks if ask not in beside}
    theirs = {ask.table.name: (_ticks(ask), _seconds(ask)) for ask in beside}
    here = sum(seconds_of(ask) for ask in asks if ask not in beside)
    there = sum(map(seconds_of, beside))
    share = max(0.0, 1 - here / there) if there else 0.0
    theirs = {name: (count, seconds * share) for name, (count, seconds) in theirs.items()}
    return {**own, **theirs, PAGE: (1, PAGE_S)}


def seconds_of(ask: Asked) -> float:
    """Return how many seconds a table is expected to take."""
    return _ticks(ask) * _seconds(ask)


def keep(ask: Asked, ticks: int, seconds: float) -> None:
    """Store the mean seconds per part of a table in the cache, for later estimates; store nothing if `ticks` is 0."""
    if ticks:
        cache.write(_key(ask), {"seconds": seconds / ticks})


def _ticks(ask: Asked) -> int:
    return sum(step.ticks for step in ask.steps)


def _seconds(ask: Asked) -> float:
    kept = cache.read(_key(ask))
    return kept["seconds"] if kept else ask.table.step_s


def _key(ask: Asked) -> str:
    return cache.key_of("seconds", ask.table.name, repr(ask.options), repr(ask.others))
