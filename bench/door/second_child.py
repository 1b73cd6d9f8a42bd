"""What the second process of a run does; see `second.py`.

    python -m normalbench.bench.door.second_child < REQUEST

REQUEST is a line of JSON. Prints lines of JSON: a step and its rows, a table whose steps are all measured and whose
files are written, the charts that are drawn, or what is wrong. Ends when its standard input does, as when the first
process was killed.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import IO, Any

from ..ground.machine.devices import require_jax
from ..ground.machine.memory import (
    give_back_what_a_table_needed,
    have_few_heaps,
    keep_what_is_imported,
    look_for_garbage_seldom,
)
from ..ground.machine.posix.processes import end_group
from ..ground.output.errors import MissingError, UsageError, told
from ..keep.plain import key_text, plain
from ..keep.runs import read_run
from ..run.measuring import Asked, measured
from ..show.report import draw_ahead
from ..tables.registry import TABLES
from ..tables.table import Row, Step
from .run import asked_of
from .run_options import RunOptions


class Sent:
    """Rows that the first process keeps."""

    def __init__(self, folder: Path, out: IO[str]):
        run = read_run(folder)
        self._rows = {key_text(one["table"], one["key"]): one["rows"] for one in (*run.steps, *run.parts)}
        self._out = out

    def again(self, folder: Path) -> Sent:
        """With what the first process has kept since."""
        return Sent(folder, self._out)

    def find(self, table: str, step: Step) -> list[Row] | None:
        """The rows of a step that were kept before; None where there are none."""
        return self._rows.get(key_text(table, step.key))

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:
        """Send the rows of a step, and give them as they are read back."""
        kept = plain(rows)
        self.send({"step": key_text(table, step.key), "rows": kept})
        return kept

    def send(self, line: Mapping[str, Any]) -> None:
        """A line to the first process."""
        self._out.write(json.dumps(line) + "\n")
        self._out.flush()


def measure(given: Mapping[str, Any], sent: Sent) -> None:
    """The tables that are asked for, one after the other; then what the first process has measured is written."""
    folder = Path(given["folder"])
    asks = _asked(given["measure"], folder)
    keep_what_is_imported()
    for ask in asks:
        done = measured(ask, sent)
        ask.table.work.write(done, lambda _: None)
        sent.send({"written": ask.table.name})
        give_back_what_a_table_needed()
    _write_others(_asked(given["write"], folder), sent.again(folder))
    sent.send({"drawn": draw_ahead(folder)})


def _asked(order: Mapping[str, Any], folder: Path) -> list[Asked]:
    """What is asked of tables; nothing of none."""
    return asked_of(RunOptions(tables=",".join(order["tables"]), **order["said"]), folder) if order["tables"] else []


def _write_others(asks: Sequence[Asked], sent: Sent) -> None:
    """The files of tables that the first process has measured by now."""
    for ask in asks:
        if all(sent.find(ask.table.name, step) is not None for step in ask.steps):
            ask.table.work.write(measured(ask, sent), lambda _: None)
            sent.send({"written": ask.table.name})


def _import_what_is_needed() -> None:
    """While the first process looks for what to measure."""
    require_jax()
    for table in TABLES.values():
        if table.is_measured_beside:
            # Looked up when it is first asked for.
            _ = table.work


def _end_with_the_first() -> None:
    """End this process and what it started once nobody writes to it any more."""
    sys.stdin.read()
    end_group(0)


def _own_output() -> IO[str]:
    """Where lines go: what libraries print goes to standard error."""
    out = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return out


def main() -> None:
    """Measure what standard input asks for."""
    have_few_heaps()
    look_for_garbage_seldom()
    out = _own_output()
    # What is missing is said by the first process.
    with suppress(MissingError):
        _import_what_is_needed()
    given = json.loads(sys.stdin.readline())
    Thread(target=_end_with_the_first, daemon=True).start()
    # The first process has said it.
    told.update(given["told"])
    sent = Sent(Path(given["folder"]), out)
    try:
        measure(given, sent)
    except (UsageError, MissingError) as error:
        sent.send({"error": str(error), "status": error.exit_code})


if __name__ == "__main__":
    main()
    # What computed in other threads need not be tidied up.
    sys.stderr.flush()
    os._exit(0)
