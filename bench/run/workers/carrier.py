"""What carries tasks to workers and answers back: pipes to processes of this machine, or a scheduler of dask."""

from __future__ import annotations

import queue
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any


@dataclass(eq=False)
class Flight:
    """A task under way: to which worker, what it is of, and what the carrier has of its answer."""

    address: str
    what: Any
    carried: Any = field(default=None, repr=False)


class Lost:
    """What is there in place of an answer that does not come."""


LOST = Lost()


class Carrier(ABC):
    """Workers that are there, tasks sent to one of them, and answers as they come.

    Attributes:
        address: what `--on` names.
    """

    def __init__(self, address: str):
        self.address = address
        self._arrived: queue.SimpleQueue[Flight] = queue.SimpleQueue()

    @abstractmethod
    def workers(self) -> dict[str, bool] | None:
        """The addresses of the workers that are there, and whether each is normalbench's. None where nobody answers:
        what was under way is lost.

        Raises:
            UsageError: none stays.
        """

    def connect(self) -> None:  # noqa: B027 # nothing, where workers are this process's own
        """Connect anew, where nobody answers. Raises UsageError where that goes on."""

    @abstractmethod
    def send(self, flight: Flight, function: Callable[..., Any], *arguments: Any) -> None:
        """Have a worker call a function; the flight arrives once there is an answer, unless its worker ends."""

    def next_arrival(self, seconds: float) -> Flight | None:
        """A flight that has arrived; None where none does in time."""
        with suppress(queue.Empty):
            return self._arrived.get(timeout=seconds)
        return None

    def answer(self, flight: Flight) -> Any:
        """What a flight brings; LOST where that was lost on the way, as with the worker that has it; an exception where
        it was none of the connection's, and would come again."""
        return flight.carried

    @abstractmethod
    def close(self) -> None:
        """End the connection, and the workers that were started for it."""
