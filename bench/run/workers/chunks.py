"""The number of steps sent together; it decreases towards the end, so that all workers end at about the same time."""

from __future__ import annotations

from collections.abc import Sequence

from ...tables.table import Step
from ..measuring import Asked
from .about import marks_of
from .carrier import Task
from .orders import order_of

# Of few steps with many workers one at a time; of many, as many as the quality table measures at once.
MOST_TOGETHER = 16
# How many tasks each worker is to have at least, so that none waits long for the last one.
TASKS_EACH = 4


def chunk_size(waiting: int, workers: int) -> int:
    """Return how many of the `waiting` steps are sent together: 1 to MOST_TOGETHER, fewer towards the end."""
    return min(max(waiting // (TASKS_EACH * max(workers, 1)), 1), MOST_TOGETHER)


def tasks_of(ask: Asked, steps: Sequence[Step], workers: int) -> list[Task]:
    """Group steps into tasks, the steps with the most needs first, so that a worker that can measure all steps begins
    with those that few workers can measure.

    Raises:
        UsageError: a value or a file cannot be sent.
    """
    order, groups = order_of(ask), dict[frozenset[str], list[Step]]()
    for step in steps:
        groups.setdefault(marks_of(ask.table.work.needs(step)), []).append(step)
    tasks: list[Task] = []
    left = len(steps)
    for needs, own in sorted(groups.items(), key=lambda group: -len(group[0])):
        while own:
            size = chunk_size(left, workers)
            tasks.append(Task(order, needs, own[:size]))
            own, left = own[size:], left - len(tasks[-1].steps)
    return tasks
