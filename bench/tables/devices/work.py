"""Construction and display of the table of readers' devices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..table import Role, Row, Sheet, Step, Work, each
from . import agreement, facts
from .charts import charts
from .reading import newest, rows_of, steps_of
from .table import FACT, TABLE, DevicesOptions

KEYS = [column.name for column in TABLE.of_role(Role.KEY)]


def _steps(options: DevicesOptions, _: object) -> list[Step]:
    return steps_of(options.devices, options.facts)


def _finish(rows: Sequence[Row]) -> list[Row]:
    return newest(rows, KEYS)


def _of_codecs(rows: Sequence[Row]) -> list[Row]:
    return [row for row in rows if row.get("row_of") != FACT]


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    yield from agreement.sheets(_of_codecs(rows))
    yield from facts.sheets([row for row in rows if row.get("row_of") == FACT])


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the sentences on devices whose codes differ by more than one step, which rounding cannot explain."""
    for sheet in agreement.sheets(_of_codecs(rows)):
        yield from (line for line in sheet.said if "more than one step" in line)


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [TABLE.empty() | row for row in rows_of(*case)]),
    finish=_finish,
    summary=_summary,
    warnings=_warnings,
    charts=lambda rows: charts(_of_codecs(rows)),
    needs=lambda _: frozenset(),
    # Reading a file here takes less time than sending it.
    stays=True,
)
