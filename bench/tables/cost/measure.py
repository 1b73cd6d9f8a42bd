"""Measurement of the cost of an encoding: the rows, and the number of instructions that compilers generate for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

from ....encodings.codecs.encoding import Encoding
from ....gbuffer.defines import kernels
from ....gbuffer.defines.kernels import Operation
from ....gbuffer.defines.packings import Packing
from ....gbuffer.gl.shader import ShaderError
from ...ground.machine.cores import on_all_cores
from ...ground.options.gpu_families import FAMILIES, NVRTC
from ...ground.output.errors import MissingError
from ...shaders.isa import disassembly, intel_disassembly, isa, occupancy, spirv
from ...shaders.isa.isa import Compiled, Failure, Job, Kernel, Outcome
from ...shaders.isa.nvidia import sass
from ...shaders.isa.nvidia.source import cuda_of
from ...subjects.codecs.half.kernels import half_operation
from ..table import Row
from . import executed
from .recorded import recorded
from .table import TABLE

# The drivers' statistics by their own names: RADV's, then Intel's; NVIDIA's by those of isa/nvidia/child.py. Later
# Mesas may have more; one that is missing is left empty.
INSTRUCTIONS = (("Instructions",), ("Instruction Count",))
SPILLS = (("Spilled VGPRs", "Spilled SGPRs"), ("Spill Count", "Fill Count"), ("STP Count", "LDP Count"))
STATISTICS = {
    "instructions": INSTRUCTIONS,
    "vgprs": (("VGPRs",), ("Registers",)),
    "sgprs": (("SGPRs",),),
    "spills": SPILLS,
    "code_bytes": (("Code size",),),
    "stall_cycles": (("Stall cycles",),),
}
# Of the whole kernel. What the driver's model calls latency and throughput is a maximum over units and over what waits
# for what: one kernel's less another's is nobody's cost.
WHOLE = {
    "kernel_vgprs": (("VGPRs",), ("Registers",)),
    "kernel_sgprs": (("SGPRs",),),
    "kernel_latency": (("Latency",), ("Cycle Count",)),
    "kernel_inverse_throughput": (("Inverse Throughput",),),
}
# Of the listing: what adds up, and what makes the other counts static ones.
READERS: Mapping[str, Any] = {
    "radeon": disassembly,
    "intel": intel_disassembly,
    "nvidia": sass,
}
KINDS = tuple(dict.fromkeys(name for reader in READERS.values() for name in reader.KINDS))
LISTED = ("issue_slots", "executed_slots", *KINDS, "packed", "branches", "loops", "looped")
OPERATIONS = ("encode", "decode")
PACKING_OPERATIONS = {"encode": "pack", "decode": "unpack"}
NOT_ASKED = Failure("CUDA was not requested")
GLSLANG_STAGES = {"fragment": "frag", "compute": "comp"}


@dataclass(frozen=True, eq=False)
class CostCase:
    """An operation whose cost is measured, of an encoding, a packing or a layout.

    Attributes:
        encoding: the encoding; None for a packing or a layout.
        storage: the name of the packing or layout; None for an encoding.
        operation: "encode", "decode", "pack" or "unpack".
        make: returns the operation; raises ShaderError.
    """

    encoding: Encoding | None
    storage: str | None
    operation: str
    make: Callable[[], Operation]

    @property
    def name(self) -> str:
        return f"{self.encoding.name if self.encoding else self.storage} {self.operation}"

    def row(self, measure: str, **more: Any) -> Row:
        """Return a row of the cost table for the case, with this measure and more columns; the rest are empty."""
        name = self.encoding.name if self.encoding else None
        about = {"encoding": name, "storage": self.storage, "operation": self.operation}
        return TABLE.empty() | {"measure": measure} | about | more


def cases(encodings: Iterable[Encoding], packings: Iterable[Packing], operations: Sequence[str]) -> list[CostCase]:
    """Return a case for each operation of each encoding and of each packing."""
    cost_cases = [CostCase(e, None, name, partial(_operation, e, name)) for e in encodings for name in operations]
    for packing in packings:
        by_name = {"encode": packing.pack, "decode": packing.unpack}
        cost_cases += [CostCase(None, packing.name, PACKING_OPERATIONS[name], by_name[name]) for name in operations]
    return cost_cases


def _operation(encoding: Encoding, operation: str) -> Operation:
    if encoding.is_half:
        return half_operation(encoding, operation)
    return {"encode": kernels.encode, "decode": kernels.decode}[operation](encoding)


@dataclass(frozen=True)
class Prepared:
    """The kernel of a case and the empty kernel, in the form that compilers accept: SPIR-V, and CUDA on request.

    `cuda` is a Failure if there is no CUDA version.
    """

    job: Job
    empty: Job
    spirv_instructions: int | None
    cuda: tuple[Job, Job] | Failure = NOT_ASKED

    def jobs(self, family: str) -> tuple[Job, Job] | Failure:
        """Return the kernel and the empty kernel for a family's compiler, or the reason why neither exists."""
        return self.cuda if _takes_cuda(family) else (self.job, self.empty)


def prepare(case: CostCase, stage: str, as_cuda: bool = False) -> Prepared | Failure:
    """Return a case's kernels, with CUDA on request, or the reason why they cannot be made. Raises MissingError if
    there is no SPIR-V compiler."""
    try:
        operation = case.make()
        (job, count), (empty, empty_count) = (
            _job_and_instructions(o, stage, operation.is_portable) for o in (operation, operation.empty)
        )
    except spirv.ToolError as error:
        return Failure(str(error))
    except ShaderError as error:
        return Failure(f"{case.name}: {error}")
    more = count - empty_count if count is not None and empty_count is not None else None
    return Prepared(job, empty, more, _cuda_jobs(case, operation, stage) if as_cuda else NOT_ASKED)


def _cuda_jobs(case: CostCase, operation: Operation, stage: str) -> tuple[Job, Job] | Failure:
    if case.encoding and case.encoding.is_half:
        return Failure(f"{case.name}: half arithmetic is not counted for NVIDIA")
    try:
        job, empty = (Job(stage, cuda_of(each).encode(), b"") for each in (operation, operation.empty))
    except ShaderError as error:
        return Failure(f"{case.name}: {error}")
    return job, empty


def _takes_cuda(family: str) -> bool:
    return family in FAMILIES and FAMILIES[family].library == NVRTC


def _job_and_instructions(operation: Operation, stage: str, counted: bool) -> tuple[Job, int | None]:
    module = spirv.compiled(operation.source(kernels.STAGES[stage]), GLSLANG_STAGES[stage], counted)
    # A vertex shader feeds each fragment shader; a compute shader has none.
    vertex = spirv.compiled(operation.source("kernel.vert"), "vert", False).binary if stage == "fragment" else b""
    return Job(stage, module.binary, vertex), module.instructions


def isa_rows(
    chosen: Sequence[CostCase],
    stages: Sequence[str],
    families: Sequence[str],
    lacks: list[str],
    tick: Callable[[str], None],
) -> Iterator[tuple[Row, str]]:
    """Yield a row for each case, stage and family, with its disassembly.

    A family that compiles nothing at all has one row, with the reason. If no family compiles anything, rows without
    a family keep the SPIR-V figures.

    Args:
        lacks: receives what this machine lacks, one line for each.
        tick: called with a family when it is done.

    Raises:
        MissingError: there is no GLSL compiler.
    """
    pairs = [(case, stage) for stage in stages for case in chosen]
    compiler = spirv.titles()
    if spirv.version(spirv.OPTIMISER) is None:
        lacks.append(spirv.NO_OPTIMISER)
    takes_cuda = any(map(_takes_cuda, families))
    prepared = list(on_all_cores(lambda pair: prepare(*pair, takes_cuda and "compute" in pair), pairs))
    outcomes: dict[tuple[str, Job], Outcome] = {}
    for some in ([f for f in families if _takes_cuda(f) == is_cuda] for is_cuda in (False, True)):
        outcomes |= isa.compile_all(_jobs(prepared, some[0]), some, tick) if some else {}
    lacks += dict.fromkeys(o.reason for o in outcomes.values() if isinstance(o, Failure) and o.is_missing)
    dead = {f: reason for f in families if (reason := _no_stage(f, stages) or _all_failed(outcomes, f))}
    for family, reason in dead.items():
        yield TABLE.empty() | {"measure": "isa", "family": family, "skipped": reason}, ""
    for family in [f for f in families if f not in dead] or [None]:
        for (case, stage), build in zip(pairs, prepared, strict=True):
            if family and _no_stage(family, [stage]):
                continue
            row = case.row("isa", stage=stage, family=family, compiler=compiler)
            if isinstance(build, Failure):
                yield row | {"skipped": build.reason}, ""
            elif family is None:
                yield row | {"spirv_instructions": build.spirv_instructions}, ""
            else:
                row["spirv_instructions"] = build.spirv_instructions
                jobs = build.jobs(family)
                compared = [outcomes[family, job] for job in jobs] if isinstance(jobs, tuple) else [jobs, jobs]
                figures, assembly = _figures(row, *compared)
                yield figures | {"executed_slots": _executed_slots(case, figures, assembly)}, assembly


def _jobs(prepared: Iterable[Prepared | Failure], family: str) -> list[Job]:
    """Return the jobs to compile for a GPU family, each once."""
    pairs = (build.jobs(family) for build in prepared if isinstance(build, Prepared))
    return list(dict.fromkeys(job for pair in pairs if isinstance(pair, tuple) for job in pair))


def _no_stage(family: str, stages: Sequence[str]) -> str:
    """Return the message that a family supports none of these stages, and which to use; empty if it supports any."""
    known = FAMILIES[family].stages if family in FAMILIES else stages
    if set(known) & set(stages):
        return ""
    title = FAMILIES[family].title
    return f"{title}: {' and '.join(stages)} shaders are not supported; use --stage {', '.join(known)}"


def _all_failed(outcomes: dict[tuple[str, Job], Outcome], family: str) -> str:
    """Return the first reason why a family compiled nothing; empty if any job compiled or there were no jobs."""
    stages = FAMILIES[family].stages if family in FAMILIES else tuple(kernels.STAGES)
    attempts = [outcome for (name, job), outcome in outcomes.items() if name == family and job.stage in stages]
    failures = [outcome for outcome in attempts if isinstance(outcome, Failure)]
    return failures[0].reason if attempts and len(failures) == len(attempts) else ""


def _figures(row: Row, outcome: Outcome, empty: Outcome) -> tuple[Row, str]:
    """Return a row with the difference between its kernel and the empty kernel, and the kernel's disassembly; if
    either is missing, the reason in `skipped` and an empty text."""
    if isinstance(outcome, Failure):
        return row | {"skipped": outcome.reason}, ""
    if isinstance(empty, Failure):
        return row | {"skipped": f"empty kernel: {empty.reason}"}, ""
    compared = alike(outcome.kernels, empty.kernels)
    if compared is None:
        return row | {"skipped": _width_mismatch(outcome.kernels, empty.kernels)}, ""
    kernel, nothing = compared
    for column, names in STATISTICS.items():
        row[column] = _difference(_total(kernel, names), _total(nothing, names))
    for column, names in WHOLE.items():
        row[column] = _total(kernel, names)
    ours, theirs = (_listed(k.assembly, int(_total(k, INSTRUCTIONS) or -1), row["family"]) for k in compared)
    if ours and theirs:
        row |= {column: _difference(ours[column], theirs[column]) for column in ours}
    row["kernel_waves"] = occupancy.waves(row["family"], row["kernel_vgprs"])
    about = {"simd_width": kernel.simd_width, "device": outcome.device, "driver": _driver_text(outcome, row["family"])}
    return row | about, kernel.assembly


def _driver_text(outcome: Compiled, family: str) -> str:
    """Return the name and version of the compiler that made the kernel; Mesa itself reports only the version."""
    return outcome.version if _takes_cuda(family) else f"Mesa {outcome.version}"


def alike(kernels: Sequence[Kernel], empties: Sequence[Kernel]) -> tuple[Kernel, Kernel] | None:
    """Return a kernel and the empty kernel for the same number of lanes: the largest number for which the kernel does
    not spill, or the largest number if it always spills. None if the two have no number of lanes in common."""
    widths = {empty.simd_width: empty for empty in empties}
    pairs = [(kernel, widths[kernel.simd_width]) for kernel in kernels if kernel.simd_width in widths]
    return max(pairs, key=lambda pair: (not _total(pair[0], SPILLS), pair[0].simd_width), default=None)


def _width_mismatch(kernels: Iterable[Kernel], empties: Iterable[Kernel]) -> str:
    ours, theirs = (" and ".join(str(k.simd_width) for k in some) for some in (kernels, empties))
    return f"compiled for {ours} lanes, but the empty kernel for {theirs}; these counts cannot be compared"


def _total(kernel: Kernel, names: Iterable[tuple[str, ...]]) -> float | None:
    """Return the sum of the first set of statistics that the driver reports in full; None if it reports none."""
    sets = ([kernel.statistics.get(name) for name in some] for some in names)
    return next((sum(numbers) for numbers in sets if None not in numbers), None)  # type: ignore[arg-type]


def _difference(a: float | None, b: float | None) -> float | None:
    return a - b if a is not None and b is not None else None


@cache
def _listed(assembly: str, total: int, family: str) -> Mapping[str, int | None] | None:
    """Return the columns to read from a kernel's disassembly: issue slots, instructions by kind, branches and loops.
    None if there is no disassembly, or it cannot be parsed."""
    read = listings_of(family)
    counts = read.kinds(assembly, total, family)
    if counts is None:
        return None
    branches, loops = read.jumps(assembly)
    # What some vendors' listings say alone.
    some: dict[str, int | None] = {"packed": read.packed(assembly)} if hasattr(read, "packed") else {}
    some |= {"looped": len(set().union(*read.loops(assembly)))} if hasattr(read, "loops") else {}
    return {"issue_slots": read.issue_slots(counts, family), **counts, **some, "branches": branches, "loops": loops}


def _executed_slots(case: CostCase, row: Row, assembly: str) -> float | None:
    """Return the issue slots that a case takes with its loops run, minus those of the empty kernel. Without loops,
    these are the static slots. None if not known."""
    read, family = listings_of(row["family"]), row["family"]
    if (rates := read.rates(family)) is None or any(row[kind] is None for kind in read.KINDS):
        return None
    static = sum(rate * row[kind] for kind, rate in rates.items())
    if not row["loops"]:
        return static
    turns = executed.turns_of(case.encoding) if case.encoding and hasattr(read, "loops") else None
    if turns is None:
        return None
    kinds, loops = read.kinds_in_order(assembly, family), read.loops(assembly)
    slots = executed.executed_slots(kinds, rates, loops, turns[case.operation])
    # The empty kernel has no loops: what they add is the whole kernel's.
    return None if slots is None else slots - sum(rates.get(kind, 0) for kind in kinds) + static


def listings_of(family: str) -> Any:
    """Return the module that parses the disassemblies for a family's vendor. It has `names`, `kinds`, `jumps`,
    `issue_slots` and `rates`; for some vendors also `packed`, or `loops` with `kinds_in_order`."""
    known = FAMILIES.get(family)
    return READERS[known.vendor] if known else disassembly


def counted(chosen: Sequence[CostCase], family: str, stage: str) -> dict[tuple[str, str], Row]:
    """Return a family's rows with instruction counts, by the name of the encoding, packing or layout and the
    operation. If nothing can be compiled here, the counts were recorded on another machine, and the rows have
    `recorded_by`."""
    try:
        pairs = isa_rows(chosen, [stage], [family], [], nobody)
        rows = [row for row, _ in pairs if row["family"] == family and row["instructions"] is not None]
    except MissingError:
        rows = []
    rows = rows or [case.row("isa", family=family, stage=stage) | row for case, row in recorded(chosen, family, stage)]
    return {(row["encoding"] or row["storage"], row["operation"]): row for row in rows}


def known_counts(chosen: Sequence[CostCase], family: str, stage: str) -> dict[tuple[str, str], Row]:
    """Return rows as `counted` does. Recorded rows, with only `recorded.COLUMNS`, are used instead of compiling if
    one operation shows that this machine has the compilers that recorded them."""
    known = dict(recorded(chosen, family, stage))
    if not known:
        return counted(chosen, family, stage)
    probe, row = next(iter(known.items()))
    others = [case for case in chosen if case not in known]
    fresh = counted([probe, *others], family, stage)
    here = fresh.get(_operation_of(probe), {})
    if f"{here.get('driver')}, {here.get('compiler')}" != row["recorded_by"]:
        return fresh | counted([case for case in known if case is not probe], family, stage)
    rows = {_operation_of(case): case.row("isa", family=family, stage=stage) | row for case, row in known.items()}
    return {operation: row | {"recorded_by": None} for operation, row in rows.items()} | fresh


def _operation_of(case: CostCase) -> tuple[str, str]:
    return case.encoding.name if case.encoding else str(case.storage), case.operation


def nobody(_: str) -> None:
    """Do nothing: a tick for measurements without a progress bar."""


def static_notes(rows: Iterable[Row]) -> list[str]:
    """Return the reasons why some counts differ from what a lane runs: a line for loops and a line for branches."""
    notes = {
        "loops": "each loop body counts once, however often it runs",
        "branches": "both sides of each branch count",
    }
    by_column: dict[str, dict[str, None]] = {column: {} for column in notes}
    for row in rows:
        column = next((column for column in notes if row[column]), None)
        if column:
            by_column[column][f"{row['encoding'] or row['storage']} {row['operation']}"] = None
    return [
        f"static count: {', '.join(by_column[column])}: {note}" for column, note in notes.items() if by_column[column]
    ]


def file_name(name: Any) -> str:
    """Return the name of an encoding or a packing for use in file names, with hyphens for spaces and colons."""
    return str(name).replace(" ", "-").replace(":", "-")


def listing(row: Row, assembly: str) -> tuple[Path, str]:
    """Return the file name for a row's disassembly, and the file's text: the cost, then the whole kernel."""
    name = file_name(row["encoding"] or row["storage"])
    costs = ", ".join(f"{row[column]} {column}" for column in ("instructions", *LISTED) if row[column] is not None)
    head = f"; {row['encoding'] or row['storage']} {row['operation']}, {row['stage']}, {row['family']}\n"
    head += f"; {row['device']}, {row['driver']}, {row['compiler']}\n; more than the empty kernel: {costs}\n"
    return Path(row["family"]) / f"{row['stage']}-{name}-{row['operation']}.asm", f"{head}{assembly}"
