"""Worker processes on this machine, reached through pipes. A process that ends is started again."""

from __future__ import annotations

import itertools
from collections import Counter
from contextlib import suppress
from functools import partial
from queue import Empty, SimpleQueue
from typing import Any

from ...ground.machine.memory import keep_what_is_freed
from ...ground.output.errors import UsageError
from ..piped import Piped, Send
from .carrier import LOOK_S, Answer, Task

# Workers that end before they are ready, one for each that there should be, this often: none will stay.
MOST_FAILURES = 3
# A step with which more workers than this were lost is lost itself, and of several steps nobody knows which one it was.
MOST_LOST = 3


class LocalWorkers:
    """Some worker processes, each with one task at a time; `close` ends them."""

    def __init__(self, count: int):
        self._address = f"local:{count}"
        self._names = (f"local {number}" for number in itertools.count(1))
        self._workers: dict[str, Piped] = {}
        # Those that have begun; what each was sent last and has not answered; how many workers were lost with a task.
        self._ready = set[str]()
        self._under_way: dict[str, Task] = {}
        self._lost = Counter[Task]()
        self._arrived = SimpleQueue[tuple[str, Answer | Exception]]()
        self._failures = 0
        try:
            for _ in range(count):
                self._start()
        except BaseException:
            self.close()
            raise

    def count(self, needs: frozenset[str]) -> int:  # noqa: ARG002 # each has what this process has
        return len(self._workers)

    def room(self, needs: frozenset[str]) -> int:  # noqa: ARG002
        return len(self._ready) - len(self._under_way)

    def send(self, task: Task) -> None:
        name = next(name for name in self._ready if name not in self._under_way)
        self._under_way[name] = task
        self._workers[name].call(_measure, *task.arguments())

    def arrivals(self) -> list[tuple[Task, Answer | None]]:
        ended = [name for name, worker in self._workers.items() if worker.status is not None]
        for name in ended:
            self._start_again(self._workers.pop(name), name in self._ready)
        self._ready -= set(ended)
        answers = [(task, self._without(task)) for name in ended if (task := self._under_way.pop(name, None))]
        with suppress(Empty):
            name, answer = self._arrived.get(timeout=LOOK_S)
            if isinstance(answer, Exception):
                raise answer
            if name in self._under_way:
                answers.append((self._under_way.pop(name), answer))
            elif name in self._workers:
                self._ready.add(name)
                self._failures = 0
        return answers

    def _without(self, task: Task) -> Answer | None:
        """Return an answer with the number of workers that were lost during a task; None if the task must be sent
        again, as a single step is up to MOST_LOST times."""
        self._lost[task] += 1
        is_lost = len(task.steps) > 1 or self._lost[task] > MOST_LOST
        return Answer(lost=self._lost[task]) if is_lost else None

    def _start(self) -> None:
        name = next(self._names)
        self._workers[name] = Piped(_begin, partial(self._take, name))

    def _start_again(self, ended: Piped, was_ready: bool) -> None:
        lines = ended.wait()
        self._failures += not was_ready
        if self._failures >= MOST_FAILURES * (len(self._workers) + 1):
            last = lines[-1].strip() if lines else f"exit status {ended.status}"
            raise UsageError(f"--on {self._address}: the workers keep exiting: {last}")
        self._start()

    def _take(self, name: str, answer: Answer | Exception) -> None:
        self._arrived.put((name, answer))

    def close(self) -> None:
        for worker in self._workers.values():
            worker.end()
        for worker in self._workers.values():
            worker.wait()


def _begin(send: Send) -> None:
    """Compute the marks of this process, which takes seconds, and send an empty answer: the worker is ready."""
    from .about import marks

    keep_what_is_freed()
    marks()
    send(Answer())


def _measure(send: Send, *arguments: Any) -> None:
    """Measure a task, and send its answer."""
    from .tasks import measure

    send(measure(*arguments))
