"""How the table of readers' devices is made of their files, and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..table import Role, Row, Step, Work, each
from .agreement import sheets
from .charts import charts
from .reading import codec_rows, newest, steps_of
from .table import TABLE, DevicesOptions

KEYS = [column.name for column in TABLE.of_role(Role.KEY)]


def _steps(options: DevicesOptions, _: object) -> list[Step]:
    return steps_of(options.devices)


def _finish(rows: Sequence[Row]) -> list[Row]:
    return newest(rows, KEYS)


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    """Devices whose codes differ from the run's by more than one step: no rounding explains that."""
    for sheet in sheets(rows):
        yield from (line for line in sheet.said if "more than one step" in line)


WORK = Work(
    steps=_steps,
    measure=each(lambda device: [TABLE.empty() | row for row in codec_rows(device)]),
    finish=_finish,
    summary=sheets,
    warnings=_warnings,
    charts=lambda rows: charts(_finish(rows)),
    needs=lambda _: frozenset(),
    # Reading a file here takes less time than sending it.
    stays=True,
)
