"""What Mesa's compiler makes of shaders for GPUs that are not there, family by family.

Each family compiles in a child process, because drivers crash and hang: a job that does not come back costs itself,
with the reason, and the others go on in a fresh child. What was compiled is kept in the user's cache, by the shader,
the driver's own file and the family.
"""

from __future__ import annotations

import base64
import json
import os
import platform
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..gbuffer.kernels import PLANES
from . import cache as kept
from .metrics import cores

# One family for each generation, by every name that a Mesa may have for it.
FAMILIES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "polaris10": ("polaris10",),
        "vega10": ("vega10",),
        "navi10": ("navi10",),
        "navi21": ("navi21",),
        "navi31": ("navi31", "gfx1100"),
    }
)
CHILD: Sequence[str] = (sys.executable, "-m", "normalbench.bench.isa_child")
# Of one job, and of a driver that starts: a thousand times what they take.
SECONDS = 10.0
# What RADV says before it gives up.
REFUSAL = "Unknown family"
# After so many jobs that were never answered a family is given up.
MOST_LOST = 5
DRIVER = "libvulkan_radeon"
NO_DRIVER = (
    f"no RADV: no Vulkan driver file names {DRIVER}; install Mesa's (Debian: apt-get install mesa-vulkan-drivers)"
)
# What would have the driver compile in another way than it does for everybody.
UNWANTED = ("RADV_DEBUG", "RADV_PERFTEST", "ACO_DEBUG", "AMD_DEBUG", "NIR_DEBUG", "VK_INSTANCE_LAYERS", "VK_LAYER_PATH")


@dataclass(frozen=True)
class Job:
    """A shader to compile: "compute" or "fragment", as SPIR-V, and the vertex shader before it."""

    stage: str
    code: bytes
    vertex: bytes


@dataclass(frozen=True)
class Compiled:
    """What came of a job.

    Attributes:
        family: the name that the driver took.
        device, version: what the driver calls the device, and Mesa's version.
        statistics: the driver's, by its own names.
        assembly: the disassembly, empty where the driver has none.
    """

    family: str
    device: str
    version: str
    statistics: dict[str, float]
    assembly: str


@dataclass(frozen=True)
class Failure:
    """Why nothing came of a job, in one line; and whether a package is missing."""

    reason: str
    is_missing: bool = False


Outcome = Compiled | Failure


@dataclass(frozen=True)
class _Driver:
    """The driver's description for the loader, and what tells its children that nobody waits for them any more."""

    path: Path
    stop: threading.Event


@cache
def driver_file() -> Path | None:
    """RADV's own description for the Vulkan loader, or None where there is none."""
    found = [path for path in _descriptions() if DRIVER in _library(path)]
    # A machine may have the driver for several architectures; the file's name says for which, if anything does.
    return next((path for path in found if platform.machine() in path.name), found[0] if found else None)


def _descriptions() -> Iterator[Path]:
    """The files that the loader would look at, those named by its variables first."""
    for variable in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        yield from map(Path, filter(None, os.environ.get(variable, "").split(os.pathsep)))
    data = os.environ.get("XDG_DATA_DIRS") or "/usr/local/share:/usr/share"
    for root in ("~/.local/share", "/etc", *data.split(os.pathsep)):
        yield from sorted(Path(root).expanduser().glob("vulkan/icd.d/*.json"))


def _library(path: Path) -> str:
    """The driver that a description names; empty where it cannot be read."""
    try:
        return str(json.loads(path.read_text(encoding="utf-8"))["ICD"]["library_path"])
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def _identity(path: Path) -> str | None:
    """What differs once the driver does: which file, how large and how old; None where the file is not to be found."""
    library = (path.parent / _library(path)).resolve()
    try:
        found = library.stat()
    except OSError:
        return None
    ours = "".join(Path(__file__).with_name(name).read_text(encoding="utf-8") for name in ("radv.py", "isa_child.py"))
    return kept.key_of(str(library), f"{found.st_size} {found.st_mtime_ns}", ours)


def compile_all(
    jobs: Sequence[Job], families: Sequence[str], tick: Callable[[str], None]
) -> dict[tuple[str, Job], Outcome]:
    """What each family's compiler makes of each job; `tick` is called with a family as it is done."""
    path = driver_file()
    if path is None:
        return {(family, job): Failure(NO_DRIVER, True) for family in families for job in jobs}
    found: dict[tuple[str, Job], Outcome] = {}
    driver = _Driver(path, threading.Event())
    with ThreadPoolExecutor(cores()) as pool:
        try:
            for family, outcomes in zip(families, pool.map(lambda f: _family(f, driver, jobs), families), strict=True):
                found |= {(family, job): outcome for job, outcome in zip(jobs, outcomes, strict=True)}
                tick(family)
        except BaseException:
            # An interrupted command ends at once, whatever a driver does.
            driver.stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return found


def driver_version() -> str:
    """The driver as it names itself for the first family, with Mesa's version; or what is missing, in one line."""
    path = driver_file()
    if path is None:
        return NO_DRIVER
    family = next(iter(FAMILIES))
    with _child(family, _Driver(path, threading.Event()), {}) as (lines, why):
        line = lines() or {}
        if "device" in line:
            return f"Mesa {line['version']}, {line['device']}"
        return line.get("missing") or line.get("failed") or why()


def _family(family: str, driver: _Driver, jobs: Sequence[Job]) -> list[Outcome]:
    """A family's outcomes, in the order of the jobs: from the cache, or by a child under the first name it takes."""
    identity = _identity(driver.path)
    keys = [kept.key_of("isa", identity or "", family, job.stage, job.code, job.vertex) for job in jobs]
    columns = set(Compiled.__dataclass_fields__)
    outcomes: dict[str, Outcome] = {}
    for key in keys if identity else ():
        if value := kept.read(key, columns):
            outcomes[key] = Compiled(**value)
    missing = {key: job for key, job in zip(keys, jobs, strict=True) if key not in outcomes}
    if missing:
        compiled = _compiled(family, driver, missing)
        for key, outcome in compiled.items():
            if identity and isinstance(outcome, Compiled):
                kept.write(key, vars(outcome))
        outcomes |= compiled
    return [outcomes[key] for key in keys]


def _compiled(family: str, driver: _Driver, jobs: Mapping[str, Job]) -> dict[str, Outcome]:
    """A family's outcomes under the first of its names that the driver takes."""
    for name in FAMILIES[family]:
        outcomes = _by_children(name, driver, jobs)
        if not all(isinstance(o, Failure) and REFUSAL in o.reason for o in outcomes.values()):
            return outcomes
    return dict.fromkeys(jobs, Failure(f"this Mesa knows no family {' or '.join(FAMILIES[family])}"))


def _by_children(name: str, driver: _Driver, jobs: Mapping[str, Job]) -> dict[str, Outcome]:
    """Children one after the other until each job has its outcome: whoever leaves a job unanswered is replaced."""
    outcomes: dict[str, Outcome] = {}
    lost = 0
    while len(outcomes) < len(jobs):
        left = {key: job for key, job in jobs.items() if key not in outcomes}
        begun, end = "", Failure("the driver ended without a word")
        for line in _answers(name, driver, left):
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


def _answers(name: str, driver: _Driver, jobs: Mapping[str, Job]) -> Iterator[str | Failure | tuple[str, Outcome]]:
    """What one child says: the key of a job that it begins, a key and its outcome, and in the end why it ended."""
    facts: dict[str, str] = {}
    with _child(name, driver, jobs) as (lines, why):
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
                yield line["key"], Compiled(**facts, statistics=line["statistics"], assembly=line["assembly"])
        yield Failure(why())


Lines = Callable[[], dict[str, Any] | None]


@contextmanager
def _child(name: str, driver: _Driver, jobs: Mapping[str, Job]) -> Iterator[tuple[Lines, Callable[[], str]]]:
    """A child over jobs: a function that gives its next line, None at its end or when it has been silent for too long,
    and one that says why it ended. Killed when the block ends."""
    with tempfile.TemporaryDirectory(prefix="normalbench-") as folder:
        given, errors = Path(folder) / "jobs.json", Path(folder) / "errors"
        given.write_text(json.dumps({"planes": PLANES, "jobs": [_as_json(key, job) for key, job in jobs.items()]}))
        with (
            errors.open("wb") as said,
            subprocess.Popen(
                [*CHILD, str(given)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=said,
                text=True,
                env=_environment(name, driver.path, folder),
            ) as child,
        ):
            try:
                lines: queue.Queue[str | None] = queue.Queue()
                threading.Thread(target=_read, args=(child.stdout, lines), daemon=True).start()
                heard = _Heard(lines, driver.stop)
                yield heard.following, lambda: heard.why(child, errors)
            finally:
                child.kill()


class _Heard:
    """What a child says, line by line, as long as it says something."""

    def __init__(self, lines: queue.Queue[str | None], stop: threading.Event):
        self._lines, self._stop, self._is_silent = lines, stop, False

    def following(self) -> dict[str, Any] | None:
        """The next line; None at the end, when nothing has come for SECONDS, or when nobody waits any more."""
        until = time.monotonic() + SECONDS
        while not self._stop.is_set() and time.monotonic() < until:
            try:
                line = self._lines.get(timeout=0.1)
            except queue.Empty:
                continue
            return _parsed(line)
        self._is_silent = True
        return None

    def why(self, child: subprocess.Popen[str], errors: Path) -> str:
        """Why there is no more."""
        if self._is_silent:
            return f"the driver did not answer within {SECONDS:g} s"
        return _why(child.wait(SECONDS), errors.read_text(errors="replace"))


def _parsed(line: str | None) -> dict[str, Any] | None:
    """A child's line; None at the end, and for one that was cut off when the child died."""
    try:
        found = json.loads(line or "null")
    except ValueError:
        return None
    return found if isinstance(found, dict) else None


def _read(stream: Any, lines: queue.Queue[str | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)


def _as_json(key: str, job: Job) -> dict[str, str]:
    code, vertex = (base64.b64encode(part).decode() for part in (job.code, job.vertex))
    return {"key": key, "stage": job.stage, "code": code, "vertex": vertex}


def _environment(name: str, path: Path, folder: str) -> dict[str, str]:
    kept_ones = {key: value for key, value in os.environ.items() if key not in UNWANTED}
    driver = {"RADV_FORCE_FAMILY": name, "VK_ICD_FILENAMES": str(path), "VK_DRIVER_FILES": str(path)}
    # Mesa's own cache answers without compiling; the loader asks for a folder of the session's.
    return {"XDG_RUNTIME_DIR": folder, **kept_ones, **driver, "MESA_SHADER_CACHE_DISABLE": "true"}


def _why(status: int, errors: str) -> str:
    """How a child ended, and the last that it or its driver said."""
    how = f"signal {signal.Signals(-status).name}" if status < 0 else f"status {status}"
    last = [line.strip() for line in errors.splitlines() if line.strip()]
    return f"the driver ended with {how}" + (f": {last[-1][:200]}" if last else "")
