"""Measurement and display of the cost table.

JAX is imported only when needed, because cached instructions are read in less time than the import takes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ....encodings.codecs.encoding import Encoding
from ....gbuffer.defines.kernels import STAGES
from ....gbuffer.defines.packings import PACKINGS, Packing, packings_of
from ....reports.charts.chart import Chart
from ...ground.choose import choose
from ...ground.options import gpu_families as families
from ...ground.options.counts import MAX_REPEATS, in_range
from ...ground.options.words import Names
from ...ground.output.errors import MissingError, UsageError
from ...ground.output.writing import check_folder, whole_file
from ...shaders.isa import isa, spirv
from ...subjects.codecs.encoding_names import encodings_named
from ...subjects.names.storages import storages_said
from ..families_named import families_named
from ..table import Measured, Row, Sheet, Step, Tick, Work, each
from . import measure, sheets
from .charts import front_chart
from .extras import SOURCES, extras
from .measure import file_name
from .table import TABLE, CostOptions, CostOutputs

FLOAT = "float"
MEASURES = ("isa", "time")
# The most encodings that a verdict lists.
MOST_LISTED = 5


def measures(options: CostOptions) -> list[str]:
    """Return the names of the requested measures; all of MEASURES if no measure is requested."""
    asked = [name for name in MEASURES if getattr(options, name)]
    return asked or list(MEASURES)


def packings(names: Names) -> list[Packing]:
    """Return the packings that `--storage` names, by their names or by the bits of a storage. Raises UsageError."""
    storages = storages_said(map(str, names), PACKINGS)
    known = {**PACKINGS, **{word: packings_of(storage) for word, storage in storages.items() if storage}}
    if few := next((word for word, several in known.items() if not several), None):
        raise UsageError(
            f"--storage {few}: a normal's code has two or three numbers; use a storage with two or more channels"
        )
    chosen = choose("storage", storages, known)
    return list(dict.fromkeys(packing for several in chosen for packing in several))


def chosen_families(names: Names) -> list[str]:
    """Return the GPU families that `--family` names; a vendor stands for all of its families. `all` includes NVIDIA's
    families only if their compiler, which users install themselves, is present. Raises UsageError."""
    chosen = families_named(names)
    if names != ("all",) or not isa.missing(families.NVRTC):
        return chosen
    return [name for name in chosen if families.FAMILIES[name].library != families.NVRTC]


@dataclass
class Costing:
    """The checked options of `cost`, and the results and missing tools that the measurement adds."""

    options: CostOptions
    encodings: list[Encoding]
    packings: list[Packing]
    operations: list[str]
    stages: list[str]
    families: list[str]
    listed: list[tuple[Row, str]] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)

    @property
    def cases(self) -> list[measure.CostCase]:
        """The cases to compile or time: the encodings' operations and the packings'."""
        return measure.cases(self.encodings, self.packings, self.operations)

    @cached_property
    def texts(self) -> dict[str, str]:
        """The disassemblies from which rows were counted, by row name. Read it only after counting."""
        return {TABLE.name_of(row): text for row, text in self.listed if text}


def costing(options: CostOptions) -> Costing:
    """Return the options as values. Raises UsageError for values that are unknown or out of range."""
    in_range("--repeats", options.repeats, 2, MAX_REPEATS)
    asked = Costing(
        options,
        _encodings(options),
        packings(options.storage),
        choose("operation", options.operation, {name: name for name in measure.OPERATIONS}),
        choose("stage", options.stage, {name: name for name in STAGES}),
        chosen_families(options.family),
    )
    if "time" in measures(options):
        from ...subjects.codecs.names import check_twin

        for encoding in asked.encodings:
            check_twin(encoding)
    return asked


def _encodings(options: CostOptions) -> list[Encoding]:
    named = encodings_named(options.encoding)
    is_usual = options.arithmetic == CostOptions.arithmetic
    if options.arithmetic == (FLOAT,) or (is_usual and not any(encoding.is_also_half for encoding in named)):
        return named
    from ...subjects.codecs.names import with_arithmetics

    return with_arithmetics(named, options.arithmetic)


def _steps(options: CostOptions, outputs: CostOutputs) -> list[Step]:
    asked = costing(options)
    _check(asked, outputs)
    key: Row = {"encodings": [e.name for e in asked.encodings], "operations": asked.operations}
    key |= {"packings": [packing.name for packing in asked.packings]}
    keys = {
        "isa": key | {"stages": asked.stages, "families": asked.families},
        "time": key | {"size": options.size, "repeats": options.repeats},
    }
    steps = [
        Step({"measure": name} | keys[name], CostMeasure(asked, name, MEASURED[name]), name)
        for name in measures(options)
    ]
    article = [Step({"measure": "article"} | key, CostMeasure(asked, "article", _article), "article")]
    return steps + (article if options.article else [])


def _check(asked: Costing, outputs: CostOutputs) -> None:
    """Raise UsageError for output that cannot be written, before anything is measured."""
    chosen = measures(asked.options)
    if outputs.disassembly:
        check_folder(outputs.disassembly)
        if "isa" not in chosen:
            raise UsageError("--disassembly requires --isa")


@dataclass(frozen=True, eq=False)
class CostMeasure:
    """One measure of a request."""

    asked: Costing
    name: str
    rows: Callable[[Costing], Iterable[Row]]

    def measured(self) -> list[Row]:
        """Return the rows; if this machine lacks a tool for the measure, one row with the reason."""
        try:
            return list(self.rows(self.asked))
        except MissingError as error:
            self.asked.missing.append(str(error))
            return [TABLE.empty() | {"measure": self.name, "skipped": str(error)}]


def _isa(asked: Costing) -> list[Row]:
    asked.listed = list(_listings(asked, asked.missing))
    return [row for row, _ in asked.listed]


def _listings(asked: Costing, missing: list[str]) -> Iterator[tuple[Row, str]]:
    """Yield the rows of instruction counts with their disassembly; `missing` receives the tools that are missing."""
    return measure.isa_rows(asked.cases, asked.stages, asked.families, missing, measure.nobody)


def _time(asked: Costing) -> Iterable[Row]:
    from ...ground.machine.devices import require_device
    from ...ground.options.targets import checked_target
    from . import clocks

    device = require_device()
    usual = clocks.SOFTWARE_SIZE if device.is_software else clocks.SIZE
    size, _ = checked_target(asked.options.size or usual, 1, 1, device)
    return clocks.time_rows(device, asked.cases, size, asked.options.repeats, measure.nobody)


def _article(asked: Costing) -> list[Row]:
    return sheets.article_rows((encoding.name for encoding in asked.encodings), asked.operations)


MEASURED: dict[str, Callable[[Costing], Iterable[Row]]] = {"isa": _isa, "time": _time}


def _warnings(rows: Sequence[Row]) -> list[str]:
    return measure.static_notes(rows)


def _lacking(done: Measured) -> list[str]:
    return list(dict.fromkeys(reason for step in done.steps for reason in step.case.asked.missing))


def _shown(done: Measured) -> Iterator[Sheet]:
    """Yield a sheet of instructions for each stage, with families side by side if there are several, then a sheet of
    times and a sheet of the article's figures, if any."""
    by_measure = {
        name: [r for r in done.rows if r["measure"] == name and r["operation"]] for name in (*MEASURES, "article")
    }
    article = by_measure.pop("article")
    listed = by_measure["isa"]
    families = {row["family"] for row in listed}
    for stage in dict.fromkeys(row["stage"] for row in listed):
        part = [row for row in listed if row["stage"] == stage]
        rows = sheets.isa_sheet(part, article) if len(families) > 1 else TABLE.without_hidden(part)
        yield Sheet("", rows, TABLE.drops(rows))
    for rows in (by_measure["time"], sheets.article_sheet(article)):
        if rows:
            shown = TABLE.without_hidden(rows)
            yield Sheet("", shown, TABLE.drops(shown))


def _texts(done: Measured) -> list[tuple[Row, str]]:
    """Return the rows of instruction counts with their disassembly; if the rows came from the cache, count again.
    Empty if instructions were not requested."""
    asked = next((step.case.asked for step in done.steps if step.case.name == "isa"), None)
    return [] if not asked else asked.listed or list(_listings(asked, []))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence with the instruction counts of the cheapest encodings and of the most expensive on one family;
    nothing if no encoding has several operations."""
    listed = [row for row in rows if row["measure"] == "isa" and row["encoding"] and row["instructions"] is not None]
    family = next((row["family"] for row in sorted(listed, key=lambda row: row["family"] != families.USUAL)), None)
    counts: dict[str, dict[str, int]] = {}
    for row in listed:
        if (row["family"], row["stage"]) == (family, listed[0]["stage"]):
            counts.setdefault(row["encoding"], {})[row["operation"]] = row["instructions"]
    whole = sorted((name for name in counts if len(counts[name]) > 1), key=lambda name: sum(counts[name].values()))
    if whole:
        shown = [*whole[: MOST_LISTED - 1], *whole[MOST_LISTED - 1 :][-1:]]
        figures = ", ".join(f"{name} {' + '.join(map(str, counts[name].values()))}" for name in shown)
        yield f"Instructions on {family}, {' + '.join(counts[whole[0]])}: {figures}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet of instructions for each GPU vendor, with its families side by side: the encodings at the first
    stage in the rows, with the article's figures."""
    first = next((row for row in rows if row["stage"]), None)
    chosen = [row for row in rows if first and row["stage"] == first["stage"] and row["encoding"]]
    article = sheets.article_rows(dict.fromkeys(row["encoding"] for row in chosen), measure.OPERATIONS)
    for vendor in dict.fromkeys(map(_vendor, chosen)):
        part = [row for row in chosen if _vendor(row) == vendor]
        drivers = ", ".join(dict.fromkeys(row["driver"] for row in part if row["driver"]))
        title = f"instructions, {', '.join(filter(None, (vendor, part[0]['stage'], drivers)))}"
        title += "; the article's figures are for ps_3_0"
        yield Sheet(title, sheets.isa_sheet(part, article))


def _vendor(row: Row) -> str:
    known = families.FAMILIES.get(row["family"])
    return known.vendor if known else ""


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.disassembly:
        write_listings(done.outputs.disassembly, _texts(done))
        write_sources(done.outputs.disassembly / SOURCES, done.steps[0].case.asked.encodings)


def _front_charts(run: Any) -> Iterator[Chart]:
    """Yield a chart of instructions against error for each of the run's fronts."""
    for index, front in enumerate(run.fronts):
        yield front_chart(f"cost-{index}", front.label, front.panels)


def _listing(step: Step, row: Row) -> str | None:
    """Return the disassembly from which a row was counted; None if no compiler made a kernel for the row."""
    return step.case.asked.texts.get(TABLE.name_of(row))


def write_listings(folder: Path, listed: Iterable[tuple[Row, str]]) -> None:
    """Write each row's disassembly, with its cost at the top, to a file in the folder of its GPU family."""
    for path, text in (measure.listing(row, text) for row, text in listed if text):
        with whole_file(folder / path) as partial:
            partial.write_text(text, encoding="utf-8", newline="\n")


def write_sources(folder: Path, encodings: Iterable[Encoding]) -> None:
    """Write each encoding's own GLSL to a file, for reading next to the disassemblies."""
    for encoding in encodings:
        if encoding.glsl.is_file():
            with whole_file(folder / f"{file_name(encoding.name)}.glsl") as partial:
                partial.write_text(encoding.glsl.read_text(encoding="utf-8"), encoding="utf-8", newline="\n")


def _missing() -> str:
    """Return the reason why `run` leaves the table out on this machine; empty if it measures the table."""
    return spirv.NO_COMPILER if spirv.version(spirv.COMPILER) is None else isa.missing()


WORK = Work(
    extras=extras,
    steps=_steps,
    measure=each(lambda part: part.measured()),
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    warnings=_warnings,
    write=_write,
    joined=_front_charts,
    listing=_listing,
    lacking=_lacking,
    missing=_missing,
    stays=True,
)
