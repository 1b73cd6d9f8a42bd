"""Worker processes of this machine, reached through pipes. Whichever of them ends is started again."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

from ...ground.machine.memory import keep_what_is_freed
from ...ground.output.errors import UsageError
from ..piped import Piped, Send
from .carrier import Carrier, Flight

# Workers that end by themselves, one for each that there should be, this often: none will stay.
MOST_FAILURES = 3


class LocalWorkers(Carrier):
    """Some worker processes, which are ended with `close`."""

    def __init__(self, count: int):
        super().__init__(f"local:{count}")
        self._names = (f"local {number}" for number in itertools.count(1))
        self._workers: dict[str, Piped] = {}
        # What each was sent last.
        self._flights: dict[str, Flight] = {}
        self._failures = 0
        try:
            for _ in range(count):
                self._start()
        except BaseException:
            self.close()
            raise

    def workers(self) -> dict[str, bool]:
        for name, worker in list(self._workers.items()):
            if worker.status is not None:
                self._start_again(self._workers.pop(name))
        return dict.fromkeys(self._workers, True)

    def _start(self) -> None:
        name = next(self._names)
        self._workers[name] = Piped(_begin, partial(self._take, name))

    def _start_again(self, ended: Piped) -> None:
        said = ended.wait()
        self._failures += (ended.status or 0) > 0
        if self._failures >= MOST_FAILURES * (len(self._workers) + 1):
            last = said[-1].strip() if said else f"exit status {ended.status}"
            raise UsageError(f"--on {self.address}: the workers do not stay: {last}")
        self._start()

    def send(self, flight: Flight, function: Callable[..., Any], *arguments: Any) -> None:
        if worker := self._workers.get(flight.address):
            self._flights[flight.address] = flight
            worker.call(_answer, function, *arguments)

    def _take(self, name: str, answer: Any) -> None:
        if flight := self._flights.get(name):
            flight.carried = answer
            self._arrived.put(flight)

    def close(self) -> None:
        for worker in self._workers.values():
            worker.end()
        for worker in self._workers.values():
            worker.wait()


def _begin(send: Send) -> None:  # noqa: ARG001 # as of all that a process calls
    """What takes seconds is done before anybody waits for it."""
    from .tasks import probe

    keep_what_is_freed()
    probe()


def _answer(send: Send, function: Callable[..., Any], *arguments: Any) -> None:
    """What a function returns."""
    send(function(*arguments))
