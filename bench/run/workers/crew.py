"""The workers that a carrier reaches: who is there, who may measure, and who is busy with what."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from ...ground.output.errors import MissingError, leave_out
from .about import About
from .admission import Admission
from .carrier import LOST, Carrier, Flight
from .tasks import probe

# How often workers are looked for, and how long there may be none, in seconds.
LOOK_S, PATIENCE_S = 0.5, 60.0
# Between two questions who is there: so often the time that the first took, and no more seconds than this.
PAUSES, LONGEST_S = 20.0, 3.0


class Probing:
    """What a worker is busy with that was asked what it is."""


PROBING = Probing()


class Crew:
    """Workers, each with one task at a time.

    Args:
        carrier: who brings them tasks.
        own: what this process says of itself.

    Attributes:
        admission: the workers that may measure.
        generation: how often the carrier lost all of them at once, as with a scheduler.
    """

    def __init__(self, carrier: Carrier, own: About):
        self.admission, self.generation = Admission(own), 0
        self._carrier = carrier
        self._flights: dict[str, Flight] = {}
        self._refused: set[str] = set()
        self._seen_at = self._looked_at = time.monotonic()
        self._ask_at = 0.0

    def idle(self) -> list[str]:
        """The workers that may measure and have nothing to do."""
        return [address for address in self.admission if address not in self._flights]

    def busy_hosts(self) -> set[str]:
        """The machines on which a worker measures."""
        return {self.admission.host(address) for address in self._flights if address in self.admission}

    @property
    def is_deciding(self) -> bool:
        """Whether a worker has yet to say what it is."""
        return any(flight.what is PROBING for flight in self._flights.values())

    def send(self, address: str, what: Any, function: Callable[..., Any], *arguments: Any) -> None:
        """Have an idle worker call a function; `arrival` brings `what` back with the answer."""
        self._flights[address] = flight = Flight(address, what)
        self._carrier.send(flight, function, *arguments)

    def arrival(self) -> tuple[str, Any, Any] | None:
        """A worker, what it was sent, and its answer; None where none comes for a while.

        An answer that was lost on the way is LOST. So is what a worker had that is gone: see `lost`.
        """
        flight = self._carrier.next_arrival(LOOK_S)
        if not flight or self._flights.get(flight.address) is not flight:
            return None
        answer = self._carrier.answer(flight)
        # What is gone with its worker is seen when that is looked for.
        if answer is LOST and flight.address not in (self._carrier.workers() or ()):
            return None
        del self._flights[flight.address]
        if flight.what is not PROBING:
            return flight.address, flight.what, answer
        if isinstance(answer, Exception):
            leave_out(f"worker {flight.address}: it does not say what it has: {str(answer).splitlines()[0]}")
            self._refused.add(flight.address)
        elif answer is not LOST and not self.admission.take(flight.address, answer):
            self._refused.add(flight.address)
        return None

    def lost(self) -> list[tuple[Any, bool]]:
        """Look for the workers where it is time to: what those had that are gone, and whether it was with them that it
        was lost, and not with the scheduler.

        Raises:
            UsageError: the scheduler is gone and does not come back, or workers of this machine do not stay.
            MissingError: no worker was there for a minute.
        """
        if time.monotonic() - self._looked_at < LOOK_S:
            return []
        found = self._looked_for()
        self._looked_at = time.monotonic()
        if len(self.admission) or self._flights:
            self._seen_at = self._looked_at
        elif self._looked_at - self._seen_at > PATIENCE_S:
            raise MissingError(f"--on {self._carrier.address}: no worker may measure; start one: normalbench worker")
        return [(what, is_fault) for what, is_fault in found if what is not PROBING]

    def _looked_for(self) -> list[tuple[Any, bool]]:
        """To ask after many workers takes a while; most of the time is for what they bring."""
        began = time.monotonic()
        if began < self._ask_at:
            return []
        there = self._carrier.workers()
        took = time.monotonic() - began
        self._ask_at = began + took + min(PAUSES * took, LONGEST_S)
        return self._start_again() if there is None else self._gone(there)

    def expect(self) -> None:
        """From now on workers are waited for."""
        self._seen_at = time.monotonic()

    def _gone(self, there: dict[str, bool]) -> list[tuple[Any, bool]]:
        """Forget workers that are gone, and ask new ones what they are."""
        found: list[tuple[Any, bool]] = []
        for address in (set(self.admission) | self._flights.keys()) - there.keys():
            self.admission.lose(address)
            if flight := self._flights.pop(address, None):
                # Who carries it forgets it.
                flight.carried = None
                found.append((flight.what, True))
        for address in there.keys() - self._flights.keys() - set(self.admission) - self._refused:
            if there[address]:
                self.send(address, PROBING, probe)
            else:
                self._refused.add(address)
                leave_out(f"worker {address}: it is not normalbench's; start it with: normalbench worker")
        return found

    def _start_again(self) -> list[tuple[Any, bool]]:
        """The scheduler is gone, and with it what it called its workers: connect anew."""
        found = [(flight.what, False) for flight in self._flights.values()]
        self._flights.clear()
        self._refused.clear()
        for address in set(self.admission):
            self.admission.lose(address)
        self.generation += 1
        self._carrier.connect()
        return found
