"""Workers of a dask scheduler. Dask sends each task to a worker that has the task's marks, and to another worker if
the first is lost. Dask reconnects if the scheduler comes back, and encrypts connections if it is configured to."""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from concurrent.futures import CancelledError
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

from distributed import Client, KilledWorker

from ...ground.output.errors import UsageError
from .carrier import LOOK_S, Answer, Task
from .tasks import measure
from .worker import MISCONFIGURED, quiet, why

# Seconds for a scheduler to answer at first, and to hand over what a task brings; and between two looks who is there.
CONNECT_S, ANSWER_S, AGAIN_S = 5.0, 120.0, 2.0


class Scheduled:
    """Workers of the scheduler at an address. Raises UsageError if no scheduler responds."""

    def __init__(self, address: str):
        quiet()
        self._address, self._looked_at = address, 0.0
        # How many workers there are by their marks, and the tasks under way by their futures, which arrive.
        self._workers = Counter[frozenset[str]]()
        self._under_way: dict[Any, Task] = {}
        self._arrived = SimpleQueue[Any]()
        try:
            # Dask waits for a scheduler that went away as long as for the first answer: longer than a user does.
            Client(address, timeout=CONNECT_S, set_as_default=False).close()
            self._client: Any = Client(address, set_as_default=False)
        except (OSError, *MISCONFIGURED) as error:
            raise UsageError(f"--on {address}: {why(error)}") from error

    def count(self, needs: frozenset[str]) -> int:
        self._look()
        return sum(count for has, count in self._workers.items() if needs <= has)

    def room(self, needs: frozenset[str]) -> int:
        # One a worker: dask counts a lost worker against all that it had.
        return self.count(needs) - sum(task.needs == needs for task in self._under_way.values())

    def send(self, task: Task) -> None:
        future = self._client.submit(measure, *task.arguments(), resources=dict.fromkeys(task.needs, 1), pure=False)
        self._under_way[future] = task
        future.add_done_callback(self._arrived.put)

    def arrivals(self) -> list[tuple[Task, Answer | None]]:
        with suppress(Empty):
            future = self._arrived.get(timeout=LOOK_S)
            if task := self._under_way.pop(future, None):
                return [(task, _answer(future))]
        return []

    def _look(self) -> None:
        """Count the workers, at most every AGAIN_S seconds. Raises UsageError if the scheduler does not come back."""
        if self._client.status == "closed":
            raise UsageError(f"--on {self._address}: the connection to the scheduler was lost and not restored")
        if self._client.status != "running":
            self._workers.clear()
        elif time.monotonic() - self._looked_at > AGAIN_S:
            with suppress(Exception):
                workers = self._client.scheduler_info(n_workers=-1)["workers"].values()
                self._workers = Counter(frozenset(worker["resources"]) for worker in workers)
            self._looked_at = time.monotonic()

    def close(self) -> None:
        with suppress(Exception):
            self._client.close(timeout=CONNECT_S)


def _answer(future: Any) -> Answer | None:
    """Return a task's answer; None if the task was lost, for example with its scheduler. Raise the task's error."""
    if future.status == "error":
        error = future.exception(timeout=ANSWER_S)
        if isinstance(error, KilledWorker):
            return Answer(lost=error.allowed_failures + 1)
        raise error
    try:
        return future.result(timeout=ANSWER_S)
    except (OSError, CancelledError, asyncio.CancelledError):
        return None
