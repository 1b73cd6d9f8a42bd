"""The work of a run's second process (see `run/second.py`).

This module has no slow imports, because the first process refers to its functions before it has imported the modules
that they need.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..ground.machine.memory import give_back_what_a_table_needed, have_few_heaps, keep_what_is_imported
from ..ground.output.errors import MissingError, told
from ..keep.plain import key_text, plain
from ..keep.runs import read_run
from ..run.measuring import Asked, asked_together, measured
from ..run.piped import Send
from ..run.second import Finished, Kept, Written
from ..tables.registry import TABLES
from ..tables.table import Row, Step


@dataclass(frozen=True)
class Asking:
    """A request for a table: the table's name, one or more sets of options, and its outputs."""

    table: str
    options: Sequence[Any]
    outputs: Any

    @classmethod
    def of(cls, ask: Asked) -> Asking:
        """Return a request in the form that one process sends to another."""
        return cls(ask.table.name, (ask.options, *ask.others), ask.outputs)

    def asked(self) -> Asked:
        """Return the same request in the other process. Raises UsageError and MissingError."""
        return asked_together(TABLES[self.table], self.options, self.outputs)


class Sent:
    """Rows that the first process keeps."""

    def __init__(self, folder: Path, send: Send):
        run = read_run(folder)
        self._rows = {key_text(step["table"], step["key"]): step["rows"] for step in (*run.steps, *run.parts)}
        self._send = send

    def find(self, table: str, step: Step) -> list[Row] | None:
        """Return the stored rows of a step; None if no rows are stored."""
        return self._rows.get(key_text(table, step.key))

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:
        """Send the rows of a step to the first process; return the rows as they are read back from JSON."""
        kept = plain(rows)
        self._send(Kept(key_text(table, step.key), kept))
        return kept


def prepare(send: Send, tables: Sequence[str] = ()) -> None:  # noqa: ARG001 # as of all that a process calls
    """Import what the tables need while the first process works out what to measure."""
    have_few_heaps()
    # What is missing is said by the first process.
    with suppress(MissingError):
        from ..ground.machine.devices import require_jax
        from ..show import report  # noqa: F401

        require_jax()
        for name in tables:
            # Looked up when it is first asked for.
            _ = TABLES[name].work


def measure(send: Send, folder: Path, own: Sequence[Asking], others: Sequence[Asking], printed: Iterable[str]) -> None:
    """Measure tables one after the other, then write the files of the tables that the first process has measured.

    Args:
        folder: the run's folder.
        own: the tables that this process measures and writes.
        others: the tables that the first process measures and whose files this process writes.
        printed: the lines that the first process has already printed.

    Raises:
        UsageError, MissingError: a table cannot be measured or written.
    """
    told.update(printed)
    sent = Sent(folder, send)
    asks = [asking.asked() for asking in own]
    keep_what_is_imported()
    for ask in asks:
        _write(ask, sent, send)
        give_back_what_a_table_needed()
    _write_others((asking.asked() for asking in others), Sent(folder, send), send)
    send(Finished())


def _write(ask: Asked, sent: Sent, send: Send) -> None:
    """Measure the missing rows of a table, write its files and send a message that the table is written."""
    ask.table.work.write(measured(ask, sent), lambda _: None)
    send(Written(ask.table.name))


def _write_others(asks: Iterable[Asked], sent: Sent, send: Send) -> None:
    """Write the files of each table if the first process has measured all its steps by now; leave out other
    tables."""
    for ask in asks:
        if all(sent.find(ask.table.name, step) is not None for step in ask.steps):
            _write(ask, sent, send)
