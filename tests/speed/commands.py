"""Times of commands from start to end: wall and processor seconds, including those of their children.

The figures are medians of three runs, each in a process of its own. "warm" has the compiled programs, emitted code
and counts of earlier runs, and measures every row and figure; "cold" has an empty cache.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import cache_from_source
from pathlib import Path

from normalbench.bench.door.cli import start
from normalbench.bench.ground.machine.cores import cores

from .timing import Row

ROW = "quality --encoding octahedral --storage rg8 --normals sphere --count 1048576 --backend jax"
RUNS = 3


@dataclass(frozen=True)
class Command:
    """A command line.

    Attributes:
        words: the arguments.
        is_cold: whether the cache of earlier runs is empty.
        writes: whether it writes a folder, which -o names.
    """

    words: str
    is_cold: bool = False
    writes: bool = False


COMMANDS: Mapping[str, Command] = {
    "help": Command("--help"),
    "list": Command("list"),
    "row": Command(ROW),
    "pick again": Command("pick"),
    "pick warm": Command("--anew pick"),
    "pick cold": Command("pick", is_cold=True),
    "run again": Command("run", writes=True),
    "run warm": Command("--anew run", writes=True),
    "run cold": Command("run", is_cold=True, writes=True),
}


def rows(names: tuple[str, ...]) -> list[Row]:
    """Measure commands by name; warm commands run once before."""
    return [_measured(name, COMMANDS[name]) for name in names]


def _measured(name: str, command: Command) -> Row:
    if not command.is_cold:
        _seconds(command)
    times = [_seconds(command) for _ in range(RUNS)]
    wall, processor = (statistics.median(values) for values in zip(*times, strict=True))
    has_byte_code = Path(cache_from_source(start.__file__)).exists()
    about = {"cores": cores(), "load": os.getloadavg()[0], "byte_code": has_byte_code}
    return {"command": name, "typed": f"normalbench {command.words}", "wall_s": wall, "processor_s": processor, **about}


def _seconds(command: Command) -> tuple[float, float]:
    """Return the wall and processor seconds of one run. Raises CalledProcessError."""
    with tempfile.TemporaryDirectory() as folder:
        words = [*command.words.split(), *(["-o", f"{folder}/run"] if command.writes else [])]
        cache = {"XDG_CACHE_HOME": f"{folder}/cache"} if command.is_cold else {}
        begin, before = time.perf_counter(), _used()
        program = [str(Path(sys.executable).with_name("normalbench")), *words]
        subprocess.run(program, env={**os.environ, **cache}, capture_output=True, check=True)
        return time.perf_counter() - begin, _used() - before


def _used() -> float:
    """Return the processor seconds of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
