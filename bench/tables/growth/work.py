"""How the growth table is measured and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from ....reports.charts import growth as charts
from ....reports.charts.drawings import Drawing
from ...ground.machine.devices import require_jax
from ...ground.options.counts import checked_numbers
from ...ground.output.errors import UsageError, pick
from ...ground.output.writing import check_plot, save_plot
from ...measures.metrics.growth import exponent, growth_lines
from ..charts import drawing, having
from ..table import GL, Measured, Row, Sheet, Step, Tick, Work, each
from . import measure
from .measure import Case
from .table import KINDS, TABLE, GrowthOptions, GrowthOutputs


def cases(options: GrowthOptions) -> list[Case]:
    """One for each row. Raises UsageError for what is unknown or out of range."""
    kinds = pick("kind", options.over, {name: name for name in KINDS})
    if options.sizes is not None and len(kinds) > 1:
        raise UsageError(f"--sizes {options.sizes}: sizes are of one kind; name it, such as --over {kinds[0]}")
    sizes = [(over, size) for over in kinds for size in _sizes(over, options.sizes)]
    return [Case(*one) for one in dict.fromkeys((over, measure.rounded(over, size)) for over, size in sizes)]


def _sizes(over: str, asked: str | None) -> tuple[int, ...]:
    kind = KINDS[over]
    return kind.usual if asked is None else checked_numbers("--sizes", asked, int, kind.least, kind.most)


def _steps(options: GrowthOptions, outputs: GrowthOutputs) -> list[Step]:
    require_jax()
    check_plot(outputs.plot)
    return [Step({"over": case.over, "size": case.size}, case, case.name) for case in cases(options)]


def _by_kind(rows: Sequence[Row]) -> list[list[Row]]:
    """The rows of each kind, the smallest size first."""
    kinds = dict.fromkeys(row["over"] for row in rows)
    return [sorted((row for row in rows if row["over"] == kind), key=lambda row: row["size"]) for kind in kinds]


def with_exponents(rows: Sequence[Row]) -> list[Row]:
    """Rows with the exponent from the next smaller size that was timed."""
    made: list[Row] = []
    for part in _by_kind(rows):
        pairs = pairwise(having(part, "seconds"))
        exponents = {large["size"]: exponent(*_sizes_and_times([small, large])) for small, large in pairs}
        made += [row | {"exponent": exponents.get(row["size"])} for row in part]
    return made


def _sizes_and_times(rows: Sequence[Row]) -> tuple[list[int], list[float]]:
    return [row["size"] for row in rows], [row["seconds"] for row in rows]


def notes(rows: Sequence[Row]) -> Iterator[str]:
    """How the time of each kind grows, over all of its sizes."""
    for part in _by_kind(having(rows, "seconds")):
        over = part[0]["over"]
        yield from growth_lines(over, over, *_sizes_and_times(part))


def _shown(done: Measured) -> Iterator[Sheet]:
    rows = TABLE.without_hidden(done.rows)
    yield Sheet("", rows, TABLE.drops(rows), notes=tuple(notes(done.rows)))


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    shown = [{name: row[name] for name in ("over", "size", "seconds", "exponent")} for row in rows]
    yield Sheet("seconds by size", shown, notes=tuple(notes(rows)))


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    yield from dict.fromkeys(f"{row['over']}: not timed: {row['skipped']}" for row in rows if row["skipped"])


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.plot:
        save_plot(done.outputs.plot, charts.growth_chart(having(done.rows, "seconds")))


def _drawings(_: Any, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = having(rows, "seconds")
    if usable:
        said = "Seconds over the size, both on logarithmic scales: a line for each kind. The figures are in the table."
        yield drawing("growth", "Time over size", said, usable, charts.growth_chart, charts.growth_specs)


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [measure.measure(case)]),
    finish=with_exponents,
    shown=_shown,
    summary=_summary,
    warnings=_warnings,
    write=_write,
    drawings=_drawings,
    needs=lambda step: frozenset({GL}) if KINDS[step.case.over].draws else frozenset(),
    is_timed=lambda _: True,
)
