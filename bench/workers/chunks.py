"""Steps that wait for a worker, and how many travel together."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..tables.table import Step
from .orders import Order

# Of few steps with many workers one at a time; of many, as many as the quality table measures at once.
MOST_TOGETHER = 16
# How many tasks each worker is to have at least, so that none waits long for the last one.
TASKS_EACH = 4
# A step during which more workers than this were lost is lost itself.
MOST_LOST = 3


def chunk_size(waiting: int, workers: int) -> int:
    """How many steps travel together: ever fewer towards the end, so that all workers end at about the same time."""
    return min(max(waiting // (TASKS_EACH * max(workers, 1)), 1), MOST_TOGETHER)


@dataclass(eq=False)
class Waiting:
    """A step that is not measured yet.

    Attributes:
        place: its place among the steps.
        lost: how many workers were lost while they measured it.
    """

    step: Step
    name: str
    needs: frozenset[str]
    is_timed: bool
    place: int
    lost: int = 0


@dataclass(eq=False)
class Chunk:
    """Steps that travel together."""

    order: Order
    steps: list[Waiting]


class Line:
    """The steps of an order that wait, in their order, apart by what they need."""

    def __init__(self, order: Order, steps: Iterable[Waiting]):
        self.order = order
        self._groups: dict[tuple[bool, frozenset[str]], deque[Waiting]] = {}
        for one in steps:
            self._group(one).append(one)

    def _group(self, one: Waiting) -> deque[Waiting]:
        return self._groups.setdefault((one.is_timed, one.needs), deque())

    def needs(self, is_timed: bool) -> list[frozenset[str]]:
        """What the steps that wait need, the most first: a worker that can measure all begins with what few can."""
        found = [needs for (timed, needs), steps in self._groups.items() if steps and timed == is_timed]
        return sorted(found, key=len, reverse=True)

    def next_chunk(self, needs: frozenset[str], workers: int, is_timed: bool) -> Chunk:
        """The first steps of those with the same needs; of timed ones, and those that were lost, one."""
        steps = self._groups[is_timed, needs]
        size = 1 if is_timed else chunk_size(len(steps), workers)
        taken = [steps.popleft()]
        while not taken[0].lost and len(taken) < size and steps and not steps[0].lost:
            taken.append(steps.popleft())
        return Chunk(self.order, taken)

    def again(self, steps: Sequence[Waiting]) -> None:
        """Steps that did not come back: first in the line; last, if it was with a worker that they were lost."""
        for one in reversed(steps):
            if one.lost:
                self._group(one).append(one)
            else:
                self._group(one).appendleft(one)

    @property
    def left(self) -> list[Waiting]:
        """All that wait, in their order."""
        return sorted((one for steps in self._groups.values() for one in steps), key=lambda one: one.place)
