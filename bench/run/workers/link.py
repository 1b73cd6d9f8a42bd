"""The connection to a scheduler of dask, which carries tasks to workers on any machine.

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
from typing import Any

from ...ground.output.errors import UsageError
from .carrier import LOST, Carrier, Flight
from .worker import PATIENCE_S, RESOURCE, check_certificates, quiet

CONNECT_S, ANSWER_S, LOOK_S = 5.0, 120.0, 1.0
# Whose exceptions say that something was lost.
DASK = ("distributed", "asyncio", "concurrent", "tornado")


class Link(Carrier):
    """A connection to the scheduler at an address.

    Raises:
        UsageError: nobody answers, or TLS has no certificates.
    """

    def __init__(self, address: str):
        quiet()
        check_certificates("--on", address, "client")
        super().__init__(address)
        self._numbers, self._name = itertools.count(), uuid.uuid4().hex
        self._client: Any = None
        if not self._connected():
            raise UsageError(f"--on {address}: nobody answers; start a scheduler there: dask scheduler")

    def connect(self) -> None:
        until = time.monotonic() + PATIENCE_S
        while not self._connected():
            if time.monotonic() > until:
                raise UsageError(f"--on {self.address}: the scheduler is gone and does not come back")

    def _connected(self) -> bool:
        """Connect anew; whether that went well."""
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

    def workers(self) -> dict[str, bool] | None:
        try:
            if self._client.status != "running":
                return None
            found = self._client.scheduler_info(n_workers=-1)["workers"]
        except Exception:
            return None
        return {address: RESOURCE in one["resources"] for address, one in found.items()}

    def send(self, flight: Flight, function: Callable[..., Any], *arguments: Any) -> None:
        arrived = self._arrived
        key = f"normalbench-{self._name}-{next(self._numbers)}"
        try:
            with warnings.catch_warnings():
                # Files are large, and each worker is sent them once.
                warnings.simplefilter("ignore")
                flight.carried = self._client.submit(
                    function, *arguments, key=key, workers=[flight.address], pure=False, retries=0
                )
            flight.carried.add_done_callback(lambda _: arrived.put(flight))
        except Exception:
            arrived.put(flight)

    def answer(self, flight: Flight) -> Any:
        future, flight.carried = flight.carried, None
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

    def close(self) -> None:
        client, self._client = self._client, None
        if client is not None:
            with suppress(Exception), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                client.close(timeout=CONNECT_S)
