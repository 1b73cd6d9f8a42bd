"""Steps that wait for a worker, and how many travel together."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...tables.table import Step
from .orders import Parcel

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
    parcel: Parcel
    name: str
    needs: frozenset[str]
    is_timed: bool
    place: int
    lost: int = 0


class Group(NamedTuple):
    """What steps have in common that travel together."""

    is_timed: bool
    needs: frozenset[str]
    parcel: Parcel


@dataclass(eq=False)
class Chunk:
    """Steps that travel together."""

    parcel: Parcel
    steps: list[Waiting]


class Line:
    """The steps that wait, in their order, apart by the parcel that they are of and by what they need."""

    def __init__(self, steps: Iterable[Waiting]):
        self._groups: dict[Group, deque[Waiting]] = {}
        self._count = 0
        for one in steps:
            self._join(one)

    def _join(self, one: Waiting, is_first: bool = False) -> None:
        group = self._groups.setdefault(Group(one.is_timed, one.needs, one.parcel), deque())
        (group.appendleft if is_first else group.append)(one)
        self._count += 1

    def groups(self, is_timed: bool) -> list[Group]:
        """The groups that wait, those with the most needs first: who can measure all begins with what few can."""
        found = [group for group in self._groups if group.is_timed == is_timed]
        return sorted(found, key=lambda group: len(group.needs), reverse=True)

    def next_chunk(self, group: Group, workers: int) -> Chunk:
        """The first steps of a group; of timed ones, and those that were lost, one."""
        steps = self._groups[group]
        size = 1 if group.is_timed else chunk_size(self._count, workers)
        taken = [steps.popleft()]
        while not taken[0].lost and len(taken) < size and steps and not steps[0].lost:
            taken.append(steps.popleft())
        if not steps:
            del self._groups[group]
        self._count -= len(taken)
        return Chunk(group.parcel, taken)

    def again(self, steps: Sequence[Waiting]) -> None:
        """Steps that did not come back: first in the line; last, if it was with a worker that they were lost."""
        for one in reversed(steps):
            self._join(one, is_first=not one.lost)

    @property
    def left(self) -> list[Waiting]:
        """All that wait, in their order."""
        return sorted((one for steps in self._groups.values() for one in steps), key=lambda one: one.place)
