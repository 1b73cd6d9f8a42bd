"""Measurement and display of the budget table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ...ground.machine.devices import require_device, require_jax
from ...ground.output.errors import tell
from ...ground.output.writing import check_folder, write_text
from ..table import Measured, Row, Sheet, Step, Tick, Work
from .charts import charts, plotted
from .contract import IN_LIGHT, as_known
from .measure import in_order, measure
from .question import question
from .sentences import conditions, enough, in_short, smallest, targets, told
from .table import IMPROVED, MINE, PROPOSAL, TABLE, BudgetOptions, BudgetOutputs
from .written import file_of

# The rows whose layouts are this table's own.
WRITTEN = (PROPOSAL, IMPROVED)
SHOWN = (
    "layout",
    "bytes_per_pixel",
    "contract_bytes",
    "worst_db",
    "worst_class",
    "psnr_db",
    "flip_p99",
    "slots",
    "next_bytes",
    "next_db",
)


def _steps(options: BudgetOptions, outputs: BudgetOutputs) -> list[Step]:
    require_jax()
    asked = question(options)
    if outputs.layouts:
        check_folder(outputs.layouts)
    count = sum(code.trip is not None for attribute in asked.attributes for code in attribute.codes) * len(asked.stages)
    return [Step(_key(options), asked, asked.scenes, count + len(asked.rules) + len(asked.against))]


def _write(done: Measured, _: Tick) -> None:
    folder = done.outputs.layouts
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
    for row in done.rows if folder else ():
        if row["kind"] in WRITTEN and not row["skipped"]:
            path = folder / f"{row['layout']}.toml"
            write_text(lambda row=row: file_of(row), path)
            tell(f"{path}: {row['bytes_per_pixel']} bytes per pixel")


def _key(options: BudgetOptions) -> Row:
    return {name: getattr(options, name) for name in options.__dataclass_fields__}


def _measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    for step in steps:
        yield measure(require_device(), step.case, tick)


def _sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a comparison of all layouts; then the recommendation for each limit, in sentences and target by target,
    and possible changes to a user's layout."""
    yield from _compared(rows, list(filter(None, [smallest(rows)])))
    answer = enough(rows)
    for row in sorted(rows, key=lambda row: row is not answer):
        if row["kind"] == MINE and row["changes"]:
            yield Sheet("", [], said=(f"{row['layout']}: {row['changes']}",))
        if row["kind"] in WRITTEN:
            name = f"{row['limit']} bytes" if row["kind"] == PROPOSAL else row["layout"]
            held = targets(row)
            notes = (conditions(row),) if held else ()
            yield Sheet(f"{name}, target by target" if held else "", held, said=tuple(told(row)), notes=notes)


def _compared(rows: Sequence[Row], sentences: Sequence[str] = ()) -> Iterator[Sheet]:
    shown = [{name: row[name] for name in SHOWN} for row in rows if row["worst_db"] is not None]
    if shown:
        yield Sheet("layouts, by bytes", shown, TABLE.drops(shown), said=tuple(sentences))


def _shown(done: Measured) -> Iterator[Sheet]:
    more = " Emissive goes to the light buffer." * (IN_LIGHT in as_known(done.options.hold))
    more += " Use -v for details." * (not done.outputs.verbose)
    for sheet in _sheets(done.rows) if done.outputs.verbose else _short_sheets(done.rows):
        yield replace(sheet, notes=tuple(note + more for note in sheet.notes))


def _short_sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a short answer for each limit, then all layouts if there are several."""
    answered: set[str] = set()
    rest = [f"{row['layout']}: {row['changes']}" for row in rows if row["kind"] == MINE and row["changes"]]
    rest = [*filter(None, [smallest(rows)]), *rest]
    for row in rows:
        if row["kind"] not in WRITTEN:
            continue
        if row["skipped"] or row["targets"] in answered:
            # A layout that a smaller limit has is shown there.
            rest.append(next(told(row)))
            continue
        answered.add(row["targets"])
        yield Sheet("", targets(row), said=tuple(in_short(row)), notes=(conditions(row),))
    if sum(row["worst_db"] is not None for row in rows) > 1:
        yield from _compared(rows, rest)
    elif rest:
        yield Sheet("", [], said=tuple(rest))


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    proposals = [row for row in rows if row["kind"] == PROPOSAL]
    if proposals and all(row["skipped"] for row in proposals):
        yield str(proposals[0]["skipped"])


WORK = Work(
    steps=_steps,
    measure=_measure,
    finish=in_order,
    shown=_shown,
    summary=_sheets,
    failures=_failures,
    write=_write,
    charts=charts,
    plotted=lambda done: plotted(done.rows),
)
