"""Seconds per test file. `pytest --seconds FILE` adds up the seconds and, if all tests pass, writes them; the seconds
of files that did not run are kept.

Each test's seconds run from the end of the test before it to its own end, in the process that ran it: processor time,
including all processes that it started, and wall time. Four processes on two cores wait for one another, so only
processor seconds add up to a machine's.
"""

import json
import os
import platform
import time
from collections import defaultdict
from pathlib import Path

import psutil
import pytest

from normalbench.bench.keep.machine import processor

ROOT = Path(__file__).parents[2]
COLLECTING = "collecting"


def processor_seconds() -> float:
    """Return the processor seconds of this process and of all that it started, whether they have ended or not."""
    return sum(os.times()[:4]) + sum(map(_seconds, psutil.Process().children(recursive=True)))


def _seconds(process: psutil.Process) -> float:
    try:
        return sum(process.cpu_times()[:4])
    except psutil.Error:
        return 0.0


class Seconds:
    """Seconds added up in each process that runs tests; if there are several, the parent writes the sum."""

    def __init__(self, path: Path):
        self._path = path
        self._processor, self._clock = defaultdict[str, float](float), defaultdict[str, float](float)
        self._before = 0.0, time.perf_counter()

    def _add(self, name: str) -> None:
        now = processor_seconds(), time.perf_counter()
        # A process that ends while it is looked for is counted by its parent a moment later.
        self._processor[name] += max(now[0] - self._before[0], 0.0)
        self._clock[name] += now[1] - self._before[1]
        self._before = now

    def pytest_collection_finish(self):
        """Add the seconds that a process spent before its first test."""
        self._add(COLLECTING)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        done = yield
        self._add(str(item.path.relative_to(ROOT)))
        return done

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session, exitstatus):
        if hasattr(session.config, "workeroutput"):
            session.config.workeroutput["seconds"] = [dict(self._processor), dict(self._clock)]
        elif exitstatus == pytest.ExitCode.OK:
            self._write()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node):
        for total, added in zip((self._processor, self._clock), node.workeroutput["seconds"], strict=True):
            for name, amount in added.items():
                total[name] += amount

    def _write(self) -> None:
        files = {
            name: [round(self._processor[name], 1), round(self._clock[name], 1)] for name in sorted(self._processor)
        }
        about = {
            "processor": processor(),
            "cores": os.cpu_count(),
            "python": platform.python_version(),
            "columns": ["seconds of processor", "seconds by the clock"],
        }
        kept = json.loads(self._path.read_text())["files"] if self._path.exists() else {}
        kept = {name: seconds for name, seconds in kept.items() if (ROOT / name).exists()}
        files = dict(sorted({**kept, **files}.items()))
        self._path.write_text(json.dumps(about | {"files": files}, indent=1) + "\n")
