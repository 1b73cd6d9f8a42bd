"""Steps that wait for a worker, and how many travel together."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

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


@dataclass(eq=False)
class Line:
    """The steps of an order that wait, in their order."""

    order: Order
    waiting: list[Waiting] = field(default_factory=list)

    def next_chunk(self, fits: Callable[[Waiting], bool], workers: int, is_timed: bool) -> Chunk | None:
        """The first steps that a worker can measure; None where there is none."""
        usable = [one for one in self.waiting if one.is_timed == is_timed and fits(one)]
        if not usable:
            return None
        size = 1 if is_timed else chunk_size(len(usable), workers)
        taken = usable[:1] if usable[0].lost else [one for one in usable[:size] if not one.lost]
        chosen = set(map(id, taken))
        self.waiting = [one for one in self.waiting if id(one) not in chosen]
        return Chunk(self.order, taken)

    def again(self, steps: Iterable[Waiting]) -> None:
        """Steps that a lost worker had; those that were lost before wait for the end of the line, alone."""
        self.waiting = sorted([*self.waiting, *steps], key=lambda one: (one.lost, one.place))
