"""A run whose workers and scheduler are killed again and again has the files of one that nobody disturbed."""

import random
import subprocess
import sys
import time
from pathlib import Path

import pytest
from attack.kills import figures, images, names

from normalbench.bench.workers.places import TIMES

# A part of the default run that takes a minute or two on two cores: JAX, GL and pictures.
PART = "quality,mix,frames,vectors"
WORKER_KILLS, SCHEDULER_KILLS = 20, 2
# Seconds between two kills, and how many there must have been before the run was over: how fast it is depends on what
# else the machine does.
PAUSES_S, FEWEST = (2.0, 4.0), 8
# The command, but that no step is given up: these workers are lost by chance, and the same step may be hit often.
COMMAND = """
import sys
from normalbench.bench.workers import pool
pool.MOST_LOST = 1000
from normalbench.bench.cli.start import program
program()
"""


def started(folder: Path, *on: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", COMMAND, "run", "--tables", PART, "-o", str(folder), *on]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def running(pid: int, module: str) -> list[int]:
    """A process's children that run a module."""
    found = subprocess.run(["ps", "-o", "pid=,args=", "--ppid", str(pid)], capture_output=True, text=True).stdout
    return sorted(int(line.split()[0]) for line in found.splitlines() if f"bench.workers.{module}" in line)


def has_rows(folder: Path) -> bool:
    path = folder / "rows.jsonl"
    return path.exists() and b"\n" in path.read_bytes()


def kill_one(process: subprocess.Popen[str], module: str, rng: random.Random) -> bool:
    """Kill one of its children that run a module; whether there was one."""
    there = running(process.pid, module)
    if there:
        subprocess.run(["kill", "-KILL", str(rng.choice(there))], check=False)
    return bool(there)


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_kills_of_workers_and_of_the_scheduler_change_nothing(tmp_path):
    """At random moments, from the first rows on: the same figures to the digit, the same pictures, the same files."""
    alone = started(tmp_path / "alone")
    _, err = alone.communicate()
    assert alone.returncode == 0, err

    rng = random.Random(20260801)
    process = started(tmp_path / "killed", "--on", "local:4")
    began = time.monotonic()
    while process.poll() is None and not has_rows(tmp_path / "killed"):
        time.sleep(0.2)
    victims = ["worker"] * WORKER_KILLS
    for at in range(SCHEDULER_KILLS):
        victims.insert(3 + 4 * at, "scheduler")
    killed = []
    for victim in victims:
        time.sleep(rng.uniform(*PAUSES_S))
        if process.poll() is not None:
            break
        while process.poll() is None and not kill_one(process, victim, rng):
            time.sleep(0.1)
        killed.append(victim)
    _, err = process.communicate()
    took = time.monotonic() - began
    assert process.returncode == 0 and "Traceback" not in err, err
    assert len(killed) >= FEWEST, f"{len(killed)} kills in {took:.0f} s: it was over too soon"
    assert figures(tmp_path / "killed") == figures(tmp_path / "alone")
    assert images(tmp_path / "killed") == images(tmp_path / "alone")
    assert names(tmp_path / "killed") - names(tmp_path / "alone") == {TIMES}
    assert not names(tmp_path / "alone") - names(tmp_path / "killed")
    print(f"{len(killed)} kills in {took:.0f} s")
