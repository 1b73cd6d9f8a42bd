"""Results of Mesa's compilers and NVIDIA's CUDA compiler for GPU families; the machine needs none of these GPUs.

Each family compiles in a child process, because drivers crash and hang: a job that crashes its child is reported as
failed, with the reason, and the other jobs continue in a new child. Results are kept in the user's cache, by shader,
driver files and family.
"""

from __future__ import annotations

import base64
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ....gbuffer.defines.kernels import PLANES
from ...ground.machine.children import python
from ...ground.machine.cores import cores
from ...ground.options.gpu_families import FAMILIES, NVRTC, RADV, TITLES
from ...ground.output import cache as kept
from . import null_device
from .compiler import DRIVERS
from .driver_files import driver_file, no_driver
from .null_device import NullDeviceError
from .nvidia import tools
from .nvidia.child import ARCHITECTURE
from .process import Driver, child

# What RADV says before it gives up.
REFUSAL = "Unknown family"
# After so many jobs that were never answered a family is given up.
MOST_LOST = 5
# What decides what a child makes of a job, beside the driver.
OWN_FILES = ("compiler.py", "child.py", "null_i915.c", "null_drm.h")


@dataclass(frozen=True)
class Job:
    """A shader to compile: its stage ("compute" or "fragment"), its SPIR-V or CUDA text, and its vertex shader."""

    stage: str
    code: bytes
    vertex: bytes


@dataclass(frozen=True)
class Kernel:
    """A shader compiled for one number of lanes.

    Attributes:
        simd_width: the number of lanes that an instruction works on.
        statistics: the driver's statistics, under its own names.
        assembly: the disassembly; empty if the driver gives none.
    """

    simd_width: int
    statistics: dict[str, float]
    assembly: str


@dataclass(frozen=True)
class Compiled:
    """The result of a job.

    Attributes:
        family: the name that the driver accepted.
        device, version: the driver's name for the device, and Mesa's version; for NVIDIA also the compiler's name.
        kernels: one for each number of lanes; Intel's drivers compile for up to three, the others for one.
    """

    family: str
    device: str
    version: str
    kernels: tuple[Kernel, ...]


@dataclass(frozen=True)
class Failure:
    """The reason why a job has no result, in one line, and whether a missing package is the reason."""

    reason: str
    is_missing: bool = False


Outcome = Compiled | Failure


@cache
def _loaded(path: Path) -> str | Failure:
    """Return a key that changes with the driver and with the library that disassembles for it, from the names and
    fingerprints of the files that a child process loads; empty if these are unknown, a Failure if the driver cannot
    be loaded."""
    with child({}, Driver(path, threading.Event()), {}) as (lines, why):
        line = lines()
        if line is None:
            return Failure(why())
        if "missing" in line or "failed" in line:
            return Failure(line.get("missing") or line["failed"], "missing" in line)
        files = line.get("loaded", {})
    ours = [(Path(__file__).parent / name).read_text(encoding="utf-8") for name in OWN_FILES]
    is_there = any(Path(name).name.startswith(DRIVERS[0]) for name in files)
    return kept.key_of(*(part for item in sorted(files.items()) for part in item), *ours) if is_there else ""


def missing(library: str = RADV) -> str:
    """Return a one-line message on what a driver needs and this machine lacks; empty if nothing is missing."""
    if library == NVRTC:
        return tools.missing()
    path = driver_file(library)
    if path is None:
        return no_driver(library)
    outcome = _loaded(path)
    if isinstance(outcome, Failure) and outcome.is_missing:
        return outcome.reason
    try:
        _null_device(library)
    except NullDeviceError as error:
        return str(error) if error.is_missing else ""
    return ""


def _null_device(library: str) -> None:
    """Build the null device for a driver, except for RADV, which has its own. Raises NullDeviceError."""
    if library != RADV:
        null_device.library()


def compile_all(
    jobs: Sequence[Job], families: Sequence[str], tick: Callable[[str], None]
) -> dict[tuple[str, Job], Outcome]:
    """Compile each job for each family; return outcomes by (family, job). Call `tick` with each finished family."""
    by_job: dict[tuple[str, Job], Outcome] = {}
    stop = threading.Event()
    with ThreadPoolExecutor(cores()) as pool:
        try:
            # Asked of each driver once, before its families ask at the same time.
            list(pool.map(missing, dict.fromkeys(FAMILIES[family].library for family in families)))
            for family, outcomes in zip(families, pool.map(lambda f: _family(f, stop, jobs), families), strict=True):
                by_job |= {(family, job): outcome for job, outcome in zip(jobs, outcomes, strict=True)}
                tick(family)
        except BaseException:
            # An interrupted command ends at once, whatever a driver does.
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return by_job


def driver_versions() -> dict[str, str]:
    """Return the drivers' versions, by driver name; for a driver that cannot compile, the reason in one line."""
    with ThreadPoolExecutor(cores()) as pool:
        return dict(zip(TITLES.values(), pool.map(_driver_version, TITLES), strict=True))


def _driver_version(library: str) -> str:
    """Return a driver's version, for Mesa with the driver's device name for its first family; if the driver cannot
    compile, the reason in one line."""
    if reason := missing(library):
        return reason
    first = next(name for name, family in FAMILIES.items() if family.library == library)
    try:
        variables = _variables(first, first)
    except NullDeviceError as error:
        return str(error)
    with child(variables, _driver(library, threading.Event()), _job_fields({})) as (lines, why):
        line = lines() or {}
        if "device" in line and library == NVRTC:
            return line["version"]
        if "device" in line:
            # RADV's null device says itself that it is none.
            return f"Mesa {line['version']}, {line['device']}" + (", a null device" if library != RADV else "")
        return line.get("missing") or line.get("failed") or why()


def _family(family: str, stop: threading.Event, jobs: Sequence[Job]) -> list[Outcome]:
    """Return a family's outcomes, in the order of the jobs; a Failure for a job whose stage is not counted."""
    known = FAMILIES[family]
    counted = [job for job in jobs if job.stage in known.stages]
    outcomes = dict(zip(counted, _counted(family, stop, counted), strict=True))
    return [outcomes.get(job, Failure(f"{known.title}: {job.stage} shaders are not counted")) for job in jobs]


def _counted(family: str, stop: threading.Event, jobs: Sequence[Job]) -> list[Outcome]:
    """Return a family's outcomes, in the order of the jobs, from the cache or from child processes that compile; if
    the driver is missing, the same Failure for all jobs."""
    if not jobs:
        return []
    library, gpu = FAMILIES[family].library, FAMILIES[family].null_device
    if reason := missing(library):
        return [Failure(reason, True)] * len(jobs)
    driver, identity = _driver(library, stop), _identity(library)
    keys = [kept.key_of("isa", identity, family, gpu, job.stage, job.code, job.vertex) for job in jobs]
    outcomes: dict[str, Outcome] = {}
    for key in keys if identity else ():
        if cached := _as_compiled(kept.read(key)):
            outcomes[key] = cached
    left = {key: job for key, job in zip(keys, jobs, strict=True) if key not in outcomes}
    if left:
        compiled = _compiled(family, driver, left)
        for key, outcome in compiled.items():
            if identity and isinstance(outcome, Compiled):
                kept.write(key, vars(outcome) | {"kernels": [vars(kernel) for kernel in outcome.kernels]})
        outcomes |= compiled
    return [outcomes[key] for key in keys]


def _driver(library: str, stop: threading.Event) -> Driver:
    """Return a library's driver; `missing` must have found that nothing is missing."""
    if library == NVRTC:
        return Driver(tools.found()[0], stop, python("normalbench.bench.shaders.isa.nvidia.child"))
    path = driver_file(library)
    assert path
    return Driver(path, stop)


def _identity(library: str) -> str:
    """Return a key that changes with the driver; empty if the driver's files are unknown."""
    if library == NVRTC:
        return tools.identity()
    path = driver_file(library)
    identity = _loaded(path) if path else ""
    return "" if isinstance(identity, Failure) else identity


def _as_compiled(value: dict[str, Any] | None) -> Compiled | None:
    """Return the result in a cached value; None if the value has the wrong form."""
    texts, kernels = ("family", "device", "version"), (value or {}).get("kernels")
    if value is None or set(value) != {*texts, "kernels"} or not isinstance(kernels, list) or not kernels:
        return None
    is_sound = all(isinstance(value[text], str) for text in texts) and all(map(_is_kernel, kernels))
    return Compiled(**{text: value[text] for text in texts}, kernels=_kernels(kernels)) if is_sound else None


def _is_kernel(value: Any) -> bool:
    """Whether a value has the form of a child's result for one kernel."""
    if not isinstance(value, dict) or set(value) != {"simd_width", "statistics", "assembly"}:
        return False
    width, numbers, assembly = value["simd_width"], value["statistics"], value["assembly"]
    is_sound = isinstance(width, int) and isinstance(assembly, str) and isinstance(numbers, dict)
    return is_sound and all(isinstance(number, int | float) for number in numbers.values())


def _kernels(values: Sequence[dict[str, Any]]) -> tuple[Kernel, ...]:
    return tuple(Kernel(**value) for value in values)


def _compiled(family: str, driver: Driver, jobs: Mapping[str, Job]) -> dict[str, Outcome]:
    """Compile jobs under the first of the family's names that the driver accepts, and return their outcomes by key; a
    Failure for each job if the driver accepts none of the names."""
    names = FAMILIES[family].names
    for name in names:
        try:
            variables = _variables(family, name)
        except NullDeviceError as error:
            return dict.fromkeys(jobs, Failure(str(error), error.is_missing))
        outcomes = _by_children(name, variables, driver, jobs)
        if not all(isinstance(o, Failure) and REFUSAL in o.reason for o in outcomes.values()):
            return outcomes
    return dict.fromkeys(jobs, Failure(f"this Mesa version does not know family {' or '.join(names)}"))


def _variables(family: str, name: str) -> dict[str, str]:
    """Return the environment with which a driver compiles for a family under this name. Raises NullDeviceError."""
    if FAMILIES[family].library == NVRTC:
        return {ARCHITECTURE: name}
    words = FAMILIES[family].null_device
    return null_device.variables(words) if words else {"RADV_FORCE_FAMILY": name}


def _by_children(
    name: str, variables: Mapping[str, str], driver: Driver, jobs: Mapping[str, Job]
) -> dict[str, Outcome]:
    """Compile jobs in a child process, and return each job's outcome by key. If the child ends during a job, that job
    is a Failure and a new child takes the other jobs, until MOST_LOST children are lost."""
    outcomes: dict[str, Outcome] = {}
    lost = 0
    while len(outcomes) < len(jobs):
        left = {key: job for key, job in jobs.items() if key not in outcomes}
        begun, end = "", Failure("the driver ended without a message")
        for line in _answers(name, variables, driver, left):
            if isinstance(line, Failure):
                end = line
            elif isinstance(line, str):
                begun = line
            else:
                key, outcome = line
                outcomes[key], begun = outcome, ""
        if len(outcomes) == len(jobs):
            break
        lost += 1
        if not begun or lost >= MOST_LOST or driver.stop.is_set():
            return dict.fromkeys(left, end) | outcomes
        outcomes[begun] = end
    return outcomes


def _answers(
    name: str, variables: Mapping[str, str], driver: Driver, jobs: Mapping[str, Job]
) -> Iterator[str | Failure | tuple[str, Outcome]]:
    """Yield a child's messages: a job's key at its start, its key and outcome, and finally why the child ended."""
    facts: dict[str, str] = {}
    with child(variables, driver, _job_fields(jobs)) as (lines, why):
        while (line := lines()) is not None:
            if "missing" in line or ("failed" in line and "key" not in line):
                yield Failure(line.get("missing") or line["failed"], "missing" in line)
                return
            if "device" in line:
                facts = {"family": name, "device": line["device"], "version": line["version"]}
            elif "begun" in line:
                yield line["begun"]
            elif "failed" in line:
                yield line["key"], Failure(line["failed"])
            else:
                yield line["key"], Compiled(**facts, kernels=_kernels(line["kernels"]))
        yield Failure(why())


def _job_fields(jobs: Mapping[str, Job]) -> dict[str, Any]:
    """Return the input of a child, as values for JSON: the jobs, and the binding of the storage buffer."""
    return {"planes": PLANES, "jobs": [_as_json(key, job) for key, job in jobs.items()]}


def _as_json(key: str, job: Job) -> dict[str, str]:
    code, vertex = (base64.b64encode(part).decode() for part in (job.code, job.vertex))
    return {"key": key, "stage": job.stage, "code": code, "vertex": vertex}
