"""How the table of readers' devices is made of their files, and shown."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts import devices as charts
from ....reports.charts.drawings import Drawing
from ..charts import drawing
from ..table import Role, Row, Sheet, Step, Work, each
from . import agreement, facts
from .agreement import codec_name, device_of, time_of
from .reading import newest, rows_of, steps_of
from .table import FACT, TABLE, DevicesOptions

# Codecs of a chart.
MOST_DRAWN = 60
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
    """Devices whose codes differ from the run's by more than one step: no rounding explains that."""
    for sheet in agreement.sheets(_of_codecs(rows)):
        yield from (line for line in sheet.said if "more than one step" in line)


def timed(rows: Sequence[Row]) -> list[Row]:
    """What the chart shows: codec, device and milliseconds, the codec with the least geometric mean first.

    A logarithmic axis has no place for times that are not above 0.
    """
    made = [{"codec": codec_name(row), "device": device_of(row), "ms": time_of(row)} for row in rows]
    made = [row for row in made if row["ms"] is not None and row["ms"] > 0]
    logs: dict[str, list[float]] = {}
    for row in made:
        logs.setdefault(row["codec"], []).append(math.log(row["ms"]))
    order = sorted(logs, key=lambda name: statistics.fmean(logs[name]))[:MOST_DRAWN]
    return sorted((row for row in made if row["codec"] in order), key=lambda row: order.index(row["codec"]))


def _drawings(_: Any, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = timed(_of_codecs(_finish(rows)))
    if usable:
        said = "Milliseconds per megapixel to encode and to decode, a dot for each device. The fastest codec is on top."
        said += f" At most {MOST_DRAWN} codecs are drawn. The figures are in the table."
        title = "How long codecs take on readers' devices"
        yield drawing("devices", title, said, usable, charts.devices_chart, charts.devices_specs)


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [TABLE.empty() | row for row in rows_of(*case)]),
    finish=_finish,
    summary=_summary,
    warnings=_warnings,
    drawings=_drawings,
    needs=lambda _: frozenset(),
    # Reading a file here takes less time than sending it.
    stays=True,
)
