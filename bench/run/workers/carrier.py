"""The tasks and answers of workers, and what carries them: pipes to local processes, or a dask scheduler."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from ...tables.table import Row, Step
from .orders import Order, step_name

# How long an arrival is waited for, in seconds.
LOOK_S = 0.5


@dataclass(eq=False)
class Task:
    """Steps that are sent to a worker together.

    Attributes:
        needs: the marks that the worker must have.
        is_packed: whether the order itself is sent with the steps; otherwise only its id, which most workers know.
    """

    order: Order
    needs: frozenset[str]
    steps: Sequence[Step]
    is_packed: bool = False

    def arguments(self) -> tuple[Order | str, frozenset[str], list[str]]:
        """Return the arguments for `tasks.measure`: the order or its id, the needed marks and the names of steps."""
        order = self.order if self.is_packed else self.order.id
        return order, self.needs, [step_name(self.order.table, step.key) for step in self.steps]

    def singly(self) -> list[Task]:
        """Return a task for each step."""
        return [replace(self, steps=[step]) for step in self.steps]


@dataclass(frozen=True)
class Answer:
    """The result of a task.

    Attributes:
        steps: the rows and the images (by path) of each of the task's steps, in order.
        told: lines for standard error.
        knows: whether the worker has the order; if not, the order must be sent too.
        refused: why no worker measures the task; empty if a worker does.
        lost: the number of workers that were lost during the task; 0 if it was measured in the end.
        error: the UsageError or MissingError that the next step raised; None if nothing was raised.
    """

    steps: Sequence[tuple[list[Row], dict[str, bytes]]] = ()
    told: Sequence[str] = ()
    knows: bool = True
    refused: str = ""
    lost: int = 0
    error: Exception | None = None


class Carrier(Protocol):
    """A connection to workers, which may join later."""

    def count(self, needs: frozenset[str]) -> int:
        """Return the number of workers that have all of these marks."""
        ...

    def room(self, needs: frozenset[str]) -> int:
        """Return how many more tasks with these needs may be sent now."""
        ...

    def send(self, task: Task) -> None:
        """Have a worker measure a task, without waiting for its answer."""
        ...

    def arrivals(self) -> Sequence[tuple[Task, Answer | None]]:
        """Wait briefly, and return the tasks that have come back, each with its answer, or with None if the task must
        be sent again.

        Raises:
            UsageError, MissingError: a measurement failed, or the workers or their scheduler were lost.
        """
        ...

    def close(self) -> None:
        """Close the connection, and end the workers that were started for it."""
        ...
