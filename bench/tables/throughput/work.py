"""How the throughput table is measured and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts import throughput as charts
from ....reports.charts.drawings import Drawing
from ...ground.machine.devices import require_jax
from ...ground.options.counts import MAX_TIMED_COUNT, checked_numbers
from ...ground.options.targets import that_fit
from ...ground.output.errors import pick
from ...ground.output.writing import check_plot, save_plot
from ...measures.metrics.growth import growth_lines
from ...subjects.codecs.names import check_twin, codecs_named
from ..charts import drawing, having
from ..table import Measured, Row, Sheet, Step, Tick, Work, each
from . import measure
from .measure import STORAGE, WHOLE, Case
from .table import STATISTICS, TABLE, ThroughputOptions, ThroughputOutputs


def cases(options: ThroughputOptions) -> list[Case]:
    """One for each row. Raises UsageError for what is unknown or out of range."""
    statistics = pick("statistics", options.statistics, {name: name for name in STATISTICS})
    asked = checked_numbers("--counts", options.counts, int, WHOLE, MAX_TIMED_COUNT)
    counts = dict.fromkeys(count // WHOLE * WHOLE for count in asked)
    encodings = [codec.encoding for codec in that_fit(codecs_named(options.encoding, STORAGE, "nearest"))]
    for encoding in encodings:
        check_twin(encoding)
    # Random directions of one count are made once.
    return [Case(encoding, name, count) for count in counts for name in statistics for encoding in encodings]


def _steps(options: ThroughputOptions, outputs: ThroughputOutputs) -> list[Step]:
    require_jax()
    made = cases(options)
    check_plot(outputs.plot)
    return [Step(_key(case), case, case.name) for case in made]


def _key(case: Case) -> Row:
    return {"encoding": case.encoding.name, "statistics": case.statistics, "count": case.count}


def exponents(rows: Sequence[Row]) -> Iterator[str]:
    """How the time grows with the count, of every encoding that was timed at several: least squares in logarithms."""
    for statistics, encoding in dict.fromkeys((row["statistics"], row["encoding"]) for row in rows):
        part = [row for row in rows if (row["statistics"], row["encoding"]) == (statistics, encoding)]
        counts = [row["count"] for row in part]
        times = [row["count"] / row["rate"] for row in part]
        yield from growth_lines(f"{encoding}, {statistics}", "count", counts, times, " normals")


def _shown(done: Measured) -> Iterator[Sheet]:
    rows = TABLE.without_hidden(done.rows)
    for statistics in dict.fromkeys(row["statistics"] for row in rows):
        part = [row for row in rows if row["statistics"] == statistics]
        yield Sheet("", part, TABLE.drops(part))
    if notes := tuple(exponents(having(done.rows, "rate"))):
        yield Sheet("", (), notes=notes)


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    yield from dict.fromkeys(f"no rate of C: {row['no_c']}" for row in rows if row["no_c"])


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.plot:
        save_plot(done.outputs.plot, charts.throughput_chart(having(done.rows, "rate")))


def _drawings(_: object, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = having(rows, "rate")
    if usable:
        said = (
            "Million normals a second over the number of normals, both on logarithmic scales: normalbench as lines, C "
            "as dashed lines, reading the input as dots. The figures are in the table."
        )
        draw, specs = charts.throughput_chart, charts.throughput_specs
        yield drawing("throughput", "Normals a second", said, usable, draw, specs)


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [measure.measure(case)]),
    shown=_shown,
    warnings=_warnings,
    write=_write,
    drawings=_drawings,
    needs=lambda _: frozenset(),
    is_timed=lambda _: True,
)
