"""Steps measured by workers; this process measures the steps that no worker measures."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain

from ...ground.output.errors import leave_out, tell
from ...ground.output.writing import whole_file
from ...tables.table import Role, Row, Step, Table, Tick
from ..measuring import HERE, Asked
from .about import marks_of, named
from .carrier import Answer, Carrier, Task
from .chunks import tasks_of
from .orders import PICTURES

# How long there may be no worker that can measure what is left before this process does, in seconds.
WAIT_S = 60.0
Found = Iterator[tuple[Step, list[Row]]]


class Pool:
    """A place where workers measure."""

    def __init__(self, carrier: Carrier):
        self._carrier = carrier

    def measure(self, ask: Asked, steps: Sequence[Step], tick: Tick) -> Found:
        """Yield each step with its rows, as they arrive. At the end, this process measures the timed steps, with
        nothing else running, and the steps that no worker measures.

        Raises:
            UsageError, MissingError: a measurement failed, or the workers or their scheduler were lost.
        """
        own, others = _own_and_others(ask, steps)
        refused = dict[str, list[Step]]()
        tasks = tasks_of(ask, others, self._carrier.count(marks_of(()))) if others else []
        for step, rows in self._measured(ask, tasks, refused):
            for _ in range(step.ticks):
                tick(step.name)
            yield step, rows
        for why, left in refused.items():
            tell(f"{ask.table.name}: {len(left)} steps are measured by this process: {why}")
            own += left
        if own:
            yield from HERE.measure(ask, own, tick)

    def _measured(self, ask: Asked, tasks: Sequence[Task], refused: dict[str, list[Step]]) -> Found:
        """Yield each measured or lost step with its rows; add refused steps to `refused`, by reason."""
        again: list[Task] = []
        for task, answer in self._answers(tasks):
            for line in answer.told:
                tell(line)
            if answer.refused:
                refused.setdefault(answer.refused, []).extend(task.steps)
            elif answer.lost and len(task.steps) > 1:
                again += task.singly()
            elif answer.lost:
                yield task.steps[0], [_lost_row(ask.table, task.steps[0], answer.lost)]
            else:
                for step, (rows, pictures) in zip(task.steps, answer.steps, strict=not answer.error):
                    _write(ask, pictures)
                    yield step, rows
                if answer.error:
                    raise answer.error
        if again:
            yield from self._measured(ask, again, refused)

    def _answers(self, tasks: Sequence[Task]) -> Iterator[tuple[Task, Answer]]:
        """Send tasks to workers, and yield each task with its answer, as answers arrive; refuse the remaining tasks
        if no worker has the needed marks for WAIT_S seconds."""
        under_way, waiting, able_at = dict[Task, None](), _Waiting(tasks), time.monotonic()
        while needed := {task.needs for task in under_way} | waiting.needs:
            if any(map(self._carrier.count, needed)):
                able_at = time.monotonic()
            elif time.monotonic() - able_at > WAIT_S:
                for task in (*under_way, *waiting):
                    yield task, Answer(refused=f"no worker has all of these: {named(task.needs)}")
                return
            for task in waiting.taken(self._carrier.room):
                under_way[task] = None
                self._carrier.send(task)
            for task, answer in self._carrier.arrivals():
                # What was given up may come all the same.
                if task not in under_way:
                    continue
                del under_way[task]
                if answer and answer.knows:
                    yield task, answer
                else:
                    task.is_packed |= answer is not None
                    waiting.again(task)


class _Waiting:
    """Tasks that wait for a worker, grouped by their needs."""

    def __init__(self, tasks: Iterable[Task]):
        self._lines: dict[frozenset[str], deque[Task]] = {}
        for task in tasks:
            self._lines.setdefault(task.needs, deque()).append(task)

    @property
    def needs(self) -> set[frozenset[str]]:
        return {needs for needs, line in self._lines.items() if line}

    def __iter__(self) -> Iterator[Task]:
        return chain.from_iterable(self._lines.values())

    def taken(self, room: Callable[[frozenset[str]], int]) -> Iterator[Task]:
        """Remove and yield the first tasks with each set of needs, as many as `room` returns for it."""
        for needs, line in self._lines.items():
            for _ in range(min(room(needs), len(line))):
                yield line.popleft()

    def again(self, task: Task) -> None:
        """Put a task back, before all others with the same needs."""
        self._lines[task.needs].appendleft(task)


def _own_and_others(ask: Asked, steps: Sequence[Step]) -> tuple[list[Step], list[Step]]:
    """Return the steps that only this process measures, because they are timed or cannot be sent, and the others."""
    work, own, others = ask.table.work, list[Step](), list[Step]()
    for step in steps:
        (own if work.stays or work.is_timed(step) else others).append(step)
    return own, others


def _write(ask: Asked, pictures: dict[str, bytes]) -> None:
    """Write the pictures of a step, by name, into the folder of the run's images."""
    for name, data in pictures.items():
        with whole_file(getattr(ask.outputs, PICTURES) / name) as partial:
            partial.write_bytes(data)


def _lost_row(table: Table, step: Step, lost: int) -> Row:
    """Return a row without figures: the values in its key, and the reason, which is also reported."""
    why = f"{lost} workers were lost while measuring this row"
    leave_out(f"{table.name}, {step.name}: {why}")
    reasons = {column.name: why for column in table.of_role(Role.REASON)}
    known = {column.name: step.key[column.name] for column in table.columns if column.name in step.key}
    return table.empty() | known | reasons
