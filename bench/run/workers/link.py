"""The connection to a scheduler: workers that are there, tasks sent to one of them, and answers as they come.

Whatever the connection does, nothing here raises but `connect`: a task whose answer does not come is lost, and the pool
sends it again.
"""

from __future__ import annotations

import asyncio
import itertools
import queue
import time
import uuid
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from ...ground.output.errors import UsageError
from .worker import RESOURCE, check_certificates, quiet

CONNECT_S, ANSWER_S, LOOK_S = 5.0, 120.0, 1.0
# Whose exceptions say that something was lost.
DASK = ("distributed", "asyncio", "concurrent", "tornado")


@dataclass(eq=False)
class Flight:
    """A task under way: to which worker, and what it is of."""

    address: str
    what: Any
    future: Any = field(default=None, repr=False)


class Lost:
    """What is there in place of an answer that does not come."""


LOST = Lost()


class Link:
    """A connection to the scheduler at an address.

    Raises:
        UsageError: nobody answers, or TLS has no certificates.
    """

    def __init__(self, address: str):
        quiet()
        check_certificates("--on", address, "client")
        self.address = address
        self._arrived: queue.SimpleQueue[Flight] = queue.SimpleQueue()
        self._numbers, self._name = itertools.count(), uuid.uuid4().hex
        self._client: Any = None
        if not self.connect():
            raise UsageError(f"--on {address}: nobody answers; start a scheduler there: dask scheduler")

    def connect(self) -> bool:
        """Connect anew; whether that went well. Tasks that were under way are forgotten."""
        from distributed import Client

        self.close()
        self._arrived = queue.SimpleQueue()
        try:
            with warnings.catch_warnings():
                # The pool compares versions itself.
                warnings.simplefilter("ignore")
                self._client = Client(self.address, timeout=CONNECT_S, set_as_default=False)
        except (OSError, TimeoutError, ValueError, RuntimeError):
            return False
        return True

    @property
    def is_there(self) -> bool:
        """Whether the scheduler is."""
        return self._client is not None and self._client.status == "running"

    def workers(self) -> dict[str, bool] | None:
        """The addresses of the workers that are there, and whether each is normalbench's; None where nobody answers."""
        try:
            found = self._client.scheduler_info(n_workers=-1)["workers"]
        except Exception:
            return None
        return {address: RESOURCE in one["resources"] for address, one in found.items()}

    def send(self, flight: Flight, function: Callable[..., Any], *arguments: Any) -> None:
        """Have a worker call a function; the flight arrives once there is an answer, or none will come."""
        arrived = self._arrived
        key = f"normalbench-{self._name}-{next(self._numbers)}"
        try:
            with warnings.catch_warnings():
                # Files are large, and each worker is sent them once.
                warnings.simplefilter("ignore")
                flight.future = self._client.submit(
                    function, *arguments, key=key, workers=[flight.address], pure=False, retries=0
                )
            flight.future.add_done_callback(lambda _: arrived.put(flight))
        except Exception:
            arrived.put(flight)

    def next_arrival(self, seconds: float) -> Flight | None:
        """A flight that has arrived; None where none does in time."""
        with suppress(queue.Empty):
            return self._arrived.get(timeout=seconds)
        return None

    def answer(self, flight: Flight) -> Any:
        """What a flight brings; LOST where that was lost on the way, as with the worker that has it; an exception where
        it was none of the connection's, and would come again."""
        future, flight.future = flight.future, None
        until = time.monotonic() + ANSWER_S
        while future is not None and time.monotonic() < until:
            try:
                return future.result(timeout=LOOK_S)
            except TimeoutError:
                if flight.address not in (self.workers() or ()):
                    break
            except asyncio.CancelledError:
                break
            except Exception as error:
                return LOST if isinstance(error, OSError) or type(error).__module__.startswith(DASK) else error
        return LOST

    def forget(self, flight: Flight) -> None:
        """Take no answer from a flight any more."""
        with suppress(Exception):
            if flight.future is not None:
                flight.future.cancel()
        flight.future = None

    def close(self) -> None:
        """End the connection."""
        client, self._client = self._client, None
        if client is not None:
            with suppress(Exception), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                client.close(timeout=CONNECT_S)
