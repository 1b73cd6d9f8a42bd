"""Rows that one test measured, shared by all processes of one pytest run that ask for the same rows.

A step's rows follow from its key unless somebody changes the program, and tests that do so measure by themselves.
Steps that read a clock, and tables that leave more behind than rows, are measured each time.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from kept_runs import write_json

from normalbench.bench.ground.output.cache import key_of
from normalbench.bench.keep.plain import key_text, plain
from normalbench.bench.run.measuring import Asked
from normalbench.bench.tables.table import Row, Step, Tick

Measure = Callable[..., Iterator[tuple[Step, list[Row]]]]


def shared(measure: Measure, folder: Path) -> Measure:
    """Return a `Here.measure` with shared rows: it takes a request, steps and a function for each finished part."""

    def shared_measure(
        place: object, ask: Asked, steps: Sequence[Step], tick: Tick
    ) -> Iterator[tuple[Step, list[Row]]]:
        table = ask.table
        if table.work.stays:
            yield from measure(place, ask, steps, tick)
            return
        known = {id(step): _read(folder / _key(ask, step)) for step in steps if not table.work.is_timed(step)}
        missing = [step for step in steps if known.get(id(step)) is None]
        measured = iter(measure(place, ask, missing, tick))
        for step in steps:
            rows = known.get(id(step))
            if rows is None:
                rows = next(measured)[1]
                if id(step) in known:
                    write_json(folder / _key(ask, step), plain(rows))
            yield step, rows

    return shared_measure


def _key(ask: Asked, step: Step) -> str:
    return key_of(key_text(ask.table.name, step.key))


def _read(path: Path) -> list[Row] | None:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError:
        return None
