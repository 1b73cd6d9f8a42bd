"""Steps measured by workers: each is sent to one that can measure it, and sent again where that one is lost.

What a task brings is taken as it comes. A worker, or the scheduler, may go away and come back at any time: what was
under way is measured again, and nothing is taken twice.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Any

from ..output.errors import MissingError, UsageError, leave_out, tell
from ..output.writing import whole_file
from ..results.measuring import HERE, Asked
from ..tables.table import Role, Row, Step, Table, Tick
from . import tasks
from .about import About
from .admission import Admission
from .chunks import MOST_LOST, Chunk, Line, Waiting
from .link import LOST, Flight, Link
from .orders import PICTURES, Order, order_of, step_name

# How often the workers are looked after, and how long one that fits may be missing, in seconds.
LOOK_S, PATIENCE_S = 0.5, 60.0
# Workers that answer this much later than the first are not asked which processor is usual.
GATHER_S = 3.0


class Probe:
    """What a flight is of that asks a worker what it is."""


PROBE = Probe()


class Pool:
    """Workers at a scheduler.

    Args:
        address: of the scheduler.
        own: what this process says of itself.
        look_after: starts again what has ended on this machine; whether that was the scheduler.

    Attributes:
        times: of each step that was measured its table, its seconds on the worker, and the bytes of its pictures.

    Raises:
        UsageError: nobody answers.
    """

    def __init__(self, address: str, own: About, look_after: Callable[[], bool] = lambda: False):
        self.times: list[Row] = []
        self._admission, self._look_after = Admission(own), look_after
        self._link = Link(address)
        self._flights: dict[str, Flight] = {}
        self._probed: dict[str, About | str] = {}
        self._refused: set[str] = set()
        self._sent: set[tuple[str, str]] = set()
        self._cannot: set[tuple[str, str]] = set()
        self._lacks: dict[str, list[str]] = {}
        self._seen_at = self._looked_at = time.monotonic()
        self._first_probe_at = 0.0

    def lacking(self, table: str) -> Sequence[str]:
        """What workers turned out to lack for a table."""
        return self._lacks.get(table, ())

    def measure(self, ask: Asked, steps: Sequence[Step], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        """Each step with its rows, as they come; what no worker can measure is measured here in the end.

        Raises:
            UsageError, MissingError: what measuring raised; or no worker was there for a minute.
        """
        if not steps:
            return
        if ask.table.work.stays:
            yield from HERE.measure(ask, steps, tick)
            return
        order = order_of(ask)
        line = Line(order, [_waiting(ask.table, step, at) for at, step in enumerate(steps)])
        for is_timed in (False, True):
            for waiting, rows in self._measured(ask, line, is_timed):
                for _ in range(waiting.step.ticks):
                    tick(waiting.step.name)
                yield waiting.step, rows
        yield from self._measured_here(ask, line, tick)

    def _measured(self, ask: Asked, line: Line, is_timed: bool) -> Iterator[tuple[Waiting, list[Row]]]:
        """The steps that a clock is read for, or the others: when all are done that a worker can do."""
        self._seen_at = time.monotonic()
        while self._flights_of(line) or self._has_work(line, is_timed):
            self._dispatch(line, is_timed)
            flight = self._link.next_arrival(LOOK_S)
            if flight and self._flights.get(flight.address) is flight:
                del self._flights[flight.address]
                yield from self._taken(ask, line, flight, self._link.answer(flight))
            yield from self._after_a_look(ask.table, line)

    def _flights_of(self, line: Line) -> bool:
        return any(isinstance(f.what, Chunk) and f.what.order is line.order for f in self._flights.values())

    def _has_work(self, line: Line, is_timed: bool) -> bool:
        """Whether a step waits that a worker can do, or one that is still to come."""
        wanted = [one for one in line.waiting if one.is_timed == is_timed]
        if not wanted or not len(self._admission):
            return bool(wanted)
        if any(isinstance(flight.what, Probe) for flight in self._flights.values()) or not self._is_settled():
            return True
        return any(self._fits(line, address, one) for one in wanted for address in self._taken_workers())

    def _taken_workers(self) -> list[str]:
        return [address for address in self._probed if address in self._admission]

    def _fits(self, line: Line, address: str, one: Waiting) -> bool:
        return (address, line.order.id) not in self._cannot and self._admission.fits(address, one.needs)

    def _dispatch(self, line: Line, is_timed: bool) -> None:
        """A chunk for each worker that has nothing to do; of timed steps one for each machine."""
        if not self._is_settled():
            return
        workers = self._taken_workers()
        busy = {self._admission.host(address) for address in self._flights if address in self._admission}
        for address in workers:
            host = self._admission.host(address)
            if address in self._flights or (is_timed and host in busy):
                continue
            chunk = line.next_chunk(lambda one, at=address: self._fits(line, at, one), len(workers), is_timed)
            if chunk:
                busy.add(host)
                self._send(address, chunk)

    def _send(self, address: str, chunk: Chunk) -> None:
        key = (address, chunk.order.id)
        order: Order | str = chunk.order.id if key in self._sent else chunk.order
        self._sent.add(key)
        self._fly(Flight(address, chunk), tasks.measure, order, tuple(one.name for one in chunk.steps))

    def _fly(self, flight: Flight, function: Callable[..., Any], *arguments: Any) -> None:
        self._flights[flight.address] = flight
        self._link.send(flight, function, *arguments)

    def _taken(self, ask: Asked, line: Line, flight: Flight, answer: Any) -> Iterator[tuple[Waiting, list[Row]]]:
        """What an answer brings; the steps of a chunk without an answer wait again."""
        chunk = flight.what
        if isinstance(chunk, Probe):
            if answer is not LOST:
                self._probed[flight.address] = answer
            return
        if answer is LOST:
            # If the worker is gone, which is seen when it is looked for, it was lost with this chunk.
            self._flights[flight.address] = Flight(flight.address, chunk)
            return
        if not answer.knows:
            self._sent.discard((flight.address, chunk.order.id))
        for text in answer.told:
            tell(text)
        if answer.refused:
            self._cannot.add((flight.address, chunk.order.id))
            leave_out(f"{ask.table.name} on worker {flight.address}: {answer.refused}")
        by_name = {one.name: one for one in chunk.steps}
        for step in answer.steps:
            yield by_name.pop(step.name), self._rows(ask, step)
        line.again(by_name.values())
        if answer.wrong:
            raise answer.wrong if isinstance(answer.wrong, Exception) else RuntimeError(answer.wrong)

    def _rows(self, ask: Asked, step: tasks.StepAnswer) -> list[Row]:
        """A step's rows, once its pictures are written and what is to be remembered is."""
        for name, data in step.pictures.items():
            with whole_file(getattr(ask.outputs, PICTURES) / name) as partial:
                partial.write_bytes(data)
        kept = self._lacks.setdefault(ask.table.name, [])
        kept += [reason for reason in step.lacks if reason not in kept]
        size = sum(map(len, step.pictures.values()))
        self.times.append({"table": ask.table.name, "seconds": round(step.seconds, 4), "bytes": size})
        return step.rows

    def _after_a_look(self, table: Table, line: Line) -> Iterator[tuple[Waiting, list[Row]]]:
        """Look after the workers where it is time to; the rows of steps that are given up."""
        now = time.monotonic()
        if now - self._looked_at < LOOK_S:
            return
        self._looked_at = now
        there = None if self._look_after() or not self._link.is_there else self._link.workers()
        if there is None:
            self._connect_again(line)
            return
        yield from self._lose(table, line, there)
        self._ask_new(there)
        if self._taken_workers() or self._flights:
            self._seen_at = now
        elif now - self._seen_at > PATIENCE_S:
            raise MissingError(f"--on {self._link.address}: no worker is there; start one: normalbench worker")

    def _connect_again(self, line: Line) -> None:
        """The scheduler is gone: what was under way waits again. Raises UsageError where it does not come back."""
        for flight in self._flights.values():
            if isinstance(flight.what, Chunk) and flight.what.order is line.order:
                line.again(flight.what.steps)
        self._flights.clear()
        self._probed.clear()
        self._sent.clear()
        self._admission.lose_all()
        until = time.monotonic() + PATIENCE_S
        while not self._link.connect():
            self._look_after()
            if time.monotonic() > until:
                raise UsageError(f"--on {self._link.address}: the scheduler is gone and does not come back")

    def _lose(self, table: Table, line: Line, there: Collection[str]) -> Iterator[tuple[Waiting, list[Row]]]:
        """Workers that are gone: their steps wait again, except those that have lost too many workers."""
        for address in [*self._flights.keys() - there, *(self._probed.keys() - there)]:
            self._admission.lose(address)
            self._probed.pop(address, None)
            flight = self._flights.pop(address, None)
            if flight and isinstance(flight.what, Chunk) and flight.what.order is line.order:
                self._link.forget(flight)
                yield from self._after_a_loss(table, line, flight.what.steps)
        # An answer was lost, and the worker is there: it measures the steps again.
        for flight in [f for f in self._flights.values() if f.future is None and isinstance(f.what, Chunk)]:
            del self._flights[flight.address]
            line.again(flight.what.steps)

    def _after_a_loss(self, table: Table, line: Line, steps: Sequence[Waiting]) -> Iterator[tuple[Waiting, list[Row]]]:
        for one in steps:
            one.lost += 1
        line.again(one for one in steps if one.lost <= MOST_LOST)
        for one in steps:
            if one.lost > MOST_LOST:
                why = f"{one.lost} workers were lost while they measured it"
                leave_out(f"{table.name}, {one.step.name}: {why}")
                yield one, [_lost_row(table, one.step, why)]

    def _ask_new(self, there: dict[str, bool]) -> None:
        """Ask workers that are new what they are."""
        for address, is_ours in there.items():
            if address in self._probed or address in self._flights:
                continue
            if is_ours:
                self._first_probe_at = self._first_probe_at or time.monotonic()
                self._fly(Flight(address, PROBE), tasks.probe)
            elif address not in self._refused:
                self._refused.add(address)
                leave_out(f"worker {address}: it is not one of normalbench's; start it with: normalbench worker")

    def _is_settled(self) -> bool:
        """Whether workers may be sent something: those that answered are admitted once all have, or it takes long."""
        asked = any(isinstance(flight.what, Probe) for flight in self._flights.values())
        new = {
            address: said
            for address, said in self._probed.items()
            if address not in self._admission and address not in self._refused
        }
        is_late = time.monotonic() - self._first_probe_at > GATHER_S
        if new and (not asked or is_late or self._admission.processor):
            self._admission.take(new)
            self._refused |= new.keys() - set(self._taken_workers())
        return bool(len(self._admission))

    def _measured_here(self, ask: Asked, line: Line, tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        """The steps that no worker can measure."""
        if line.waiting:
            names = ", ".join(sorted({name for one in line.waiting for name in one.needs})) or "its steps"
            tell(f"{ask.table.name}: {len(line.waiting)} steps are measured here, as no worker has the same {names}")
            yield from HERE.measure(ask, [one.step for one in line.waiting], tick)

    def close(self) -> None:
        """End the connection."""
        self._link.close()


def _waiting(table: Table, step: Step, place: int) -> Waiting:
    return Waiting(step, step_name(table.name, step.key), table.work.needs(step), table.is_timed(step), place)


def _lost_row(table: Table, step: Step, why: str) -> Row:
    """A row without figures: what its key says, and the reason."""
    reasons = {column.name: why for column in table.of_role(Role.REASON)}
    named = {column.name: step.key[column.name] for column in table.columns if column.name in step.key}
    return table.empty() | named | reasons
