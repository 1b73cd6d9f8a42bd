"""Steps measured by workers: each is sent to one that can measure it, and sent again where that one is lost.

What a task brings is taken as it comes. A worker, or the scheduler, may go away and come back at any time: what was
under way is measured again, and nothing is taken twice.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

from ...ground.output.errors import leave_out, tell
from ...ground.output.writing import whole_file
from ...tables.table import Role, Row, Step, Table, Tick
from ..measuring import HERE, Asked
from . import tasks
from .carrier import LOST
from .chunks import MOST_LOST, Chunk, Group, Line, Waiting
from .crew import Crew
from .orders import PICTURES, Order, Parcel, parcels_of, step_name

# How long a worker may be missing that can measure a step before this process does, in seconds.
WAIT_S = 10.0
Found = Iterator[tuple[Waiting, list[Row]]]


class Pool:
    """A place where workers measure."""

    def __init__(self, crew: Crew):
        self._crew = crew

    def measure(self, ask: Asked, steps: Sequence[Step], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        """Each step with its rows, as they come; what no worker can measure is measured here in the end.

        Raises:
            UsageError, MissingError: what measuring raised; or no worker was there for a minute.
        """
        if ask.table.work.stays:
            yield from HERE.measure(ask, steps, tick)
            return
        queue = _Queue(self._crew, ask, steps)
        # Clocks are read when nothing else is under way.
        for is_timed in (False, True):
            for waiting, rows in self._measured(queue, is_timed):
                for _ in range(waiting.step.ticks):
                    tick(waiting.step.name)
                yield waiting.step, rows
        yield from self._measured_here(ask, queue.line.left, tick)

    def _measured(self, queue: _Queue, is_timed: bool) -> Found:
        """The steps that a clock is read for, or the others: all that workers can measure."""
        self._crew.expect()
        while queue.has_work(is_timed):
            queue.dispatch(is_timed)
            if arrived := self._crew.arrival():
                address, chunk, answer = arrived
                yield from self._taken(queue, address, chunk, answer)
            for chunk, is_fault in self._crew.lost():
                yield from queue.lose(chunk, is_fault)

    def _taken(self, queue: _Queue, address: str, chunk: Chunk, answer: tasks.Answer | object) -> Found:
        """What an answer brings; the steps that it does not bring wait again."""
        if isinstance(answer, Exception):
            raise answer
        if not isinstance(answer, tasks.Answer):
            assert answer is LOST
            yield from queue.lose(chunk, False)
            return
        for line in answer.told:
            tell(line)
        by_name = {one.name: one for one in chunk.steps}
        for step in answer.steps:
            yield by_name.pop(step.name), self._rows(queue.ask, step)
        queue.come_back(address, chunk, list(by_name.values()), answer)
        if answer.wrong:
            raise answer.wrong if isinstance(answer.wrong, Exception) else RuntimeError(answer.wrong)

    def _rows(self, ask: Asked, step: tasks.StepAnswer) -> list[Row]:
        """A step's rows, once its pictures are written."""
        for name, data in step.pictures.items():
            with whole_file(getattr(ask.outputs, PICTURES) / name) as partial:
                partial.write_bytes(data)
        return step.rows

    def _measured_here(self, ask: Asked, left: Sequence[Waiting], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        if left:
            names = ", ".join(sorted({name for one in left for name in one.needs}))
            why = f"no worker has this {names}" if names else "no worker can measure them"
            tell(f"{ask.table.name}: {len(left)} steps are measured by this process: {why}")
            yield from HERE.measure(ask, [one.step for one in left], tick)


class _Queue:
    """The steps of a table that wait for workers, and those that are under way."""

    def __init__(self, crew: Crew, ask: Asked, steps: Sequence[Step]):
        self.ask, self._crew = ask, crew
        place = {id(step): at for at, step in enumerate(steps)}
        parcels = parcels_of(ask, steps)
        self.line = Line(_waiting(ask.table, step, one, place[id(step)]) for one in parcels for step in one.steps)
        self._under_way: set[int] = set()
        # When a worker was last there that fits.
        self._fitted_at = time.monotonic()
        # Workers by the orders that they have, and by those that they refuse.
        self._sent: set[tuple[int, str, str]] = set()
        self._refused: set[tuple[str, str]] = set()

    def has_work(self, is_timed: bool) -> bool:
        """Whether something is under way, or waits for a worker that is there or may come."""
        wanted = self.line.groups(is_timed)
        if not wanted and not self._under_way:
            return False
        admission = self._crew.admission
        may_come = self._under_way or self._crew.is_deciding or not len(admission)
        if may_come or any(self._fits(address, group) for group in wanted for address in admission):
            self._fitted_at = time.monotonic()
        return time.monotonic() - self._fitted_at < WAIT_S

    def _fits(self, address: str, group: Group) -> bool:
        return (address, group.parcel.id) not in self._refused and self._crew.admission.fits(address, group.needs)

    def dispatch(self, is_timed: bool) -> None:
        """A chunk for each idle worker; of timed steps one for each machine."""
        admission, busy = self._crew.admission, self._crew.busy_hosts() if is_timed else set[str]()
        for address in self._crew.idle():
            host = admission.host(address)
            group = next((one for one in self.line.groups(is_timed) if self._fits(address, one)), None)
            if group and host not in busy:
                if is_timed:
                    busy.add(host)
                self._send(address, self.line.next_chunk(group, len(admission)))

    def _send(self, address: str, chunk: Chunk) -> None:
        key = (self._crew.generation, address, chunk.parcel.id)
        order: Order | str = chunk.parcel.id if key in self._sent else chunk.parcel.order()
        self._sent.add(key)
        self._under_way.add(id(chunk))
        self._crew.send(address, chunk, tasks.measure, order, tuple(one.name for one in chunk.steps))

    def come_back(self, address: str, chunk: Chunk, left: Sequence[Waiting], answer: tasks.Answer) -> None:
        """A chunk is there; the steps that are left of it wait again."""
        self._under_way.discard(id(chunk))
        self.line.again(left)
        if not answer.knows:
            self._sent.discard((self._crew.generation, address, chunk.parcel.id))
        if answer.refused:
            self._refused.add((address, chunk.parcel.id))
            leave_out(f"{self.ask.table.name} on worker {address}: {answer.refused}")

    def lose(self, chunk: Chunk, is_fault: bool) -> Found:
        """The steps of a chunk wait again, but for those that too many workers were lost with: these have a row with
        the reason."""
        # What an earlier command sent is nobody's now.
        if id(chunk) not in self._under_way:
            return
        self._under_way.discard(id(chunk))
        for one in chunk.steps:
            one.lost += is_fault
        self.line.again([one for one in chunk.steps if one.lost <= MOST_LOST])
        for one in chunk.steps:
            if one.lost > MOST_LOST:
                why = f"{one.lost} workers were lost while they measured it"
                leave_out(f"{self.ask.table.name}, {one.step.name}: {why}")
                yield one, [_lost_row(self.ask.table, one.step, why)]


def _waiting(table: Table, step: Step, parcel: Parcel, place: int) -> Waiting:
    work, name = table.work, step_name(table.name, step.key)
    return Waiting(step, parcel, name, work.needs(step), work.is_timed(step), place)


def _lost_row(table: Table, step: Step, why: str) -> Row:
    """A row without figures: what its key says, and the reason."""
    reasons = {column.name: why for column in table.of_role(Role.REASON)}
    named = {column.name: step.key[column.name] for column in table.columns if column.name in step.key}
    return table.empty() | named | reasons
