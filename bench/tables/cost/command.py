"""What `cost` does. Imports JAX only for what needs it: instructions from the cache are there sooner than it is."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.storage import STORAGES, Storage
from ....gbuffer.defines.kernels import STAGES
from ....gbuffer.defines.packings import PACKINGS, Packing
from ....reports.charts import pareto, plots
from ...cli import listing
from ...codecs.user_encodings import encodings_named
from ...isa import isa
from ...options.command_options import CostOptions
from ...options.counts import MAX_REPEATS, MAX_TIMED_COUNT, check_seed, checked_count, in_range
from ...output.errors import MissingError, UsageError, pick
from ...output.progress import progress
from ...output.writing import check_folder, check_writable, say, whole_file, without, write
from . import measure as cost
from . import sheets as cost_sheets
from .measure import Case, Row

MEASURES = ("isa", "time", "jax")
# What a narrow terminal goes without, the first first.
EXPENDABLE = (
    *("compiler", "driver", "device", "kernel_latency", "kernel_inverse_throughput", "kernel_sgprs", "kernel_vgprs"),
    *("code_bytes", "sgprs", "spills", "waiting", "quarter_rate", "branches", "conversion", "scalar", "memory"),
    *("clock", "vgprs", "full_rate"),
    *(name for name in ("GeForce 7800GT", "Radeon HD 3870", "GeForce 6200")),
)


@dataclass(frozen=True, kw_only=True)
class CostRequest(CostOptions):
    """What to measure, as typed: names are comma-separated."""

    @property
    def measures(self) -> list[str]:
        """The measures asked for by name, or all of them."""
        asked = [name for name in MEASURES if getattr(self, name)]
        return asked or list(MEASURES)

    @cached_property
    def encodings(self) -> list[Encoding]:
        """Raises UsageError, as the others do."""
        return encodings_named(self.encoding)

    @cached_property
    def operations(self) -> list[str]:
        return pick("operation", self.operation, {name: name for name in cost.OPERATIONS})

    @cached_property
    def stages(self) -> list[str]:
        return pick("stage", self.stage, {name: name for name in STAGES})

    @cached_property
    def families(self) -> list[str]:
        return pick("family", self.family, {name: name for name in isa.FAMILIES})

    @cached_property
    def packings(self) -> list[Packing]:
        return list(
            dict.fromkeys(packing for several in pick("storage", self.storage, PACKINGS) for packing in several)
        )

    @cached_property
    def drawn_storages(self) -> list[Storage]:
        """The storages whose error can be measured. Raises UsageError where none is."""
        found = dict.fromkeys(packing.storage for packing in self.packings if packing.storage)
        if not found:
            raise UsageError(f"--plot needs a storage whose error is measured; known: {', '.join(STORAGES)}")
        return list(found)

    def cases(self) -> list[Case]:
        """What is compiled: encodings, and what packings add."""
        return cost.cases(self.encodings, self.packings, self.operations)

    def check(self) -> None:
        """Raises UsageError for what is unknown or out of range."""
        in_range("--repeats", self.repeats, 2, MAX_REPEATS)
        checked_count(self.count)
        if "jax" in self.measures and self.count > MAX_TIMED_COUNT:
            raise UsageError(f"--count {self.count}: in JAX a count is at most {MAX_TIMED_COUNT} (2^28)")
        check_seed(self.seed)
        pick("error", self.error, pareto.ERRORS)
        pick("normal set", self.normals, listing.NORMAL_SETS)
        _ = self.cases(), self.stages, self.families
        if self.measures != ["isa"]:
            from ..quality.measure import check_twin

            for encoding in self.encodings:
                check_twin(encoding)


class Measured:
    """Rows as they are measured, the disassembly beside those that have one, and what this machine lacks."""

    def __init__(self, request: CostRequest):
        self.listed: list[tuple[Row, str]] = []
        self.missing: list[str] = []
        for measure in request.measures:
            try:
                self.listed += getattr(self, f"_{measure}")(request)
            except MissingError as error:
                self.missing.append(str(error))
                row = dict.fromkeys(cost.COLUMNS) | {"measure": measure, "skipped": str(error)}
                self.listed.append((row, ""))

    @property
    def rows(self) -> list[Row]:
        return [row for row, _ in self.listed]

    def _isa(self, request: CostRequest) -> Iterator[tuple[Row, str]]:
        with progress(len(request.families)) as tick:
            yield from cost.isa_rows(request.cases(), request.stages, request.families, self.missing, tick)

    def _time(self, request: CostRequest) -> Iterator[tuple[Row, str]]:
        from ..quality.measure import require_device
        from ..render.command import checked_target
        from . import clocks as cost_clocks

        device = require_device()
        usual = cost_clocks.SOFTWARE_SIZE if device.is_software else cost_clocks.SIZE
        size, _ = checked_target(request.size or usual, 1, 1, device)
        chosen = request.cases()
        with progress(len(chosen) + request.repeats) as tick:
            for row in cost_clocks.time_rows(device, chosen, size, request.repeats, tick):
                yield row, ""

    def _jax(self, request: CostRequest) -> Iterator[tuple[Row, str]]:
        from ..quality.measure import require_jax
        from .jax_time import jax_rows

        require_jax()
        chosen = cost.cases(request.encodings, (), request.operations)
        with progress(len(chosen) + request.repeats) as tick:
            for row in jax_rows(chosen, request.count, request.repeats, tick):
                yield row, ""


def cost_command(
    request: CostRequest, seeds: bool, disassembly: Path | None, plot: Path | None, format: str, output: Path | None
) -> None:
    """Measure, write the rows, then disassembly and plot if asked for; raises MissingError in the end where this
    machine lacks something of what was asked for."""
    request.check()
    _check_outputs(request, disassembly, plot, output)
    measured = Measured(request)
    _say_reasons(measured)
    article = cost_sheets.article_rows((e.name for e in request.encodings), request.operations) if seeds else []
    if format == "table" and output is None:
        _show(measured, article)
    else:
        write([*measured.rows, *article], format, output, EXPENDABLE, by="measure")
    if disassembly:
        write_listings(disassembly, measured.listed)
    is_drawn = not plot or _plot(request, measured.rows, plot)
    if measured.missing:
        raise MissingError("; ".join(dict.fromkeys(measured.missing)))
    if not is_drawn:
        raise UsageError("--plot: there is nothing to draw; see why above")


def _plot(request: CostRequest, rows: Sequence[Row], path: Path) -> bool:
    from ...normals.normal_sets import NORMAL_SETS
    from .plot import draw

    sets = [make(request.count, request.seed) for make in pick("normal set", request.normals, NORMAL_SETS)]
    return draw(rows, request.encodings, request.drawn_storages, sets, request.error, path)


def write_listings(folder: Path, listed: Iterable[tuple[Row, str]]) -> None:
    """Each row's disassembly as a file, what it costs at its head, in a folder for each family."""
    for path, text in (cost.listing(row, text) for row, text in listed if text):
        with whole_file(folder / path) as partial:
            partial.write_text(text, encoding="utf-8")


def _check_outputs(request: CostRequest, disassembly: Path | None, plot: Path | None, output: Path | None) -> None:
    """Raises UsageError for what cannot be written, before anything is measured."""
    for path in filter(None, (plot, output)):
        check_writable(path)
    if disassembly:
        check_folder(disassembly)
        if "isa" not in request.measures:
            raise UsageError("--disassembly is of what compilers make; ask for --isa")
    if plot:
        plots.check_format(plot)
        if set(request.measures) == {"jax"}:
            raise UsageError("--plot draws instructions or time; ask for --isa or --time")
        _ = request.drawn_storages


def _say_reasons(measured: Measured) -> None:
    """Why rows have no figures, each reason once, to standard error; not what the command ends with."""
    reasons = dict.fromkeys(row["skipped"] for row in measured.rows if row["skipped"])
    for reason in reasons:
        if not any(missing in reason for missing in measured.missing):
            print(f"normalbench: rows without figures: {' '.join(reason.split())}", file=sys.stderr)
    for note in cost.static_notes(measured.rows):
        print(f"normalbench: {note}", file=sys.stderr)


def _show(measured: Measured, article: Sequence[Row]) -> None:
    """The tables for people: families side by side where there are several."""
    by_measure = {name: [r for r in measured.rows if r["measure"] == name and r["operation"]] for name in MEASURES}
    families = {row["family"] for row in by_measure["isa"]}
    if len(families) > 1:
        write(cost_sheets.isa_sheet(by_measure["isa"], article), "table", None, EXPENDABLE, by="stage")
    elif by_measure["isa"]:
        write(without(by_measure["isa"], ("skipped",)), "table", None, EXPENDABLE, by="stage")
    if families and article:
        say("\n" + "".join(f"{note}\n" for note in cost_sheets.order_notes(measured.listed, article)))
    for rows in (by_measure["time"], by_measure["jax"], cost_sheets.article_sheet(article)):
        if rows:
            say("\n")
            write(without(rows, ("skipped",)), "table", None, EXPENDABLE)
