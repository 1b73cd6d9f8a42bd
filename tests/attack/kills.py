"""A run that is stopped again and again, at random moments, and continues each time.

    python tests/attack/kills.py [--kills N] [--seed N] [ARGUMENT of `normalbench run` ...]

One run is not disturbed. Another is interrupted, terminated or killed while it starts, measures or writes its page,
and the same command continues it. Each time it is complete, its files are compared with those of the first run, and
it starts from the beginning. Exit status: 1 if anything else happens. 200 kills of the default run take almost an
hour.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import numpy as np

from normalbench.bench.keep.runs import read_run
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Role

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
STATUS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}
TRACES = ("Traceback", "Fatal Python error", "Exception ignored", "terminate called")
# The latest moment in seconds, one of these: start-up takes a second, the page most of a minute.
MOMENTS_S = (2.0, 2.0, 20.0, 90.0)
# Drawn from rows, and with the times in them.
WITH_TIMES = {".json", ".csv", ".html", ".jsonl", ".svg"}


def started(folder: Path, arguments: list[str]) -> subprocess.Popen[str]:
    # With a trace of what crashes.
    environment = os.environ | {"PYTHONFAULTHANDLER": "1"}
    command = [sys.executable, "-m", "normalbench", "run", "-o", str(folder), *arguments]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment)


def figures(folder: Path) -> dict[str, list[dict[str, Any]]]:
    """Return a run's rows without times."""
    return {name: [_without_times(name, row) for row in rows] for name, rows in read_run(folder).tables.items()}


def _without_times(name: str, row: dict[str, Any]) -> dict[str, Any]:
    times = {column.name for column in TABLES[name].of_role(Role.TIME)} | {"ms_frame_each"}
    return {key: value for key, value in row.items() if not any(fnmatch(key, time) for time in times)}


def images(folder: Path) -> dict[str, bytes]:
    """Return a run's pictures except charts, which show times."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.suffix not in WITH_TIMES and "charts" not in path.parts
    }


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def differs(killed: Path, alone: Path) -> list[str]:
    """Return the differences between a resumed run and the undisturbed run."""
    differences = []
    if odd := names(killed) ^ names(alone):
        differences.append(f"other files: {sorted(odd)[:5]}")
    if figures(killed) != figures(alone):
        differences.append("other figures")
    if images(killed) != images(alone):
        differences.append("other pictures")
    return differences


def is_odd(status: int, err: str, number: signal.Signals) -> bool:
    """Whether a process ended neither by itself nor as the signal requires."""
    return status not in (0, STATUS[number], -number) or any(trace in err for trace in TRACES)


def main() -> int:
    """Run the attack and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    asked, arguments = parser.parse_known_args()
    chance = np.random.default_rng(asked.seed)
    ended, odd = Counter[str](), list[str]()
    with tempfile.TemporaryDirectory() as name:
        alone, killed = Path(name, "alone"), Path(name, "killed")
        _, err = (process := started(alone, arguments)).communicate()
        if process.returncode:
            sys.exit(f"the run that was left alone: status {process.returncode}: {err}")

        def compare() -> None:
            differences = differs(killed, alone)
            odd.extend(differences)
            ended["whole"] += 1
            print(f"whole: {differences or 'the same'}", file=sys.stderr)
            shutil.rmtree(killed)

        for kill in range(asked.kills):
            moment = chance.uniform(0, chance.choice(MOMENTS_S))
            number = SIGNALS[kill % len(SIGNALS)]
            process = started(killed, arguments)
            time.sleep(moment)
            process.send_signal(number)
            _, err = process.communicate()
            ended[f"{number.name} {process.returncode}"] += 1
            if is_odd(process.returncode, err, number):
                odd.append(f"{number.name} after {moment:.2f} s: {process.returncode}: {err}")
                print(odd[-1], file=sys.stderr)
            if process.returncode == 0:
                compare()
        _, err = (process := started(killed, arguments)).communicate()
        if process.returncode:
            odd.append(f"status {process.returncode}: {err}")
        else:
            compare()
    print(*(f"{count:6d}  {what}" for what, count in sorted(ended.items())), *odd, sep="\n")
    return int(bool(odd))


if __name__ == "__main__":
    sys.exit(main())
