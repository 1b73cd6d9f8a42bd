"""Commands that are interrupted, terminated and killed while they start, measure and write their page."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from .kind import MEASURED, REFUSED, Attack, Kind, outcome

RUN = ("run", "--tables", "quality", "--encoding", "xyz,octahedral", "--storage", "rg8,rgba8", "--normals", "axes")
RUN += ("--backend", "jax", "-o", "run")
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
STATUS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}


def started(folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "normalbench", *RUN],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONFAULTHANDLER": "1"},
    )


def interruptions(folder: Path) -> Attack:
    """Return an attack that interrupts a run once; the same command then completes the rows of an undisturbed run."""
    began = time.monotonic()
    status, err = ended(started(folder), 120)
    whole, takes = (folder / "run" / "rows.jsonl").read_bytes(), time.monotonic() - began
    assert status == 0, err

    def case(seed: int) -> str:
        shutil.rmtree(folder / "run", ignore_errors=True)
        rng = np.random.default_rng(seed)
        number = SIGNALS[seed % len(SIGNALS)]
        process = started(folder)
        # Half of them while it starts, which takes a second.
        time.sleep(float(rng.uniform(0, takes if rng.random() < 0.5 else 1.0)))
        process.send_signal(number)
        status, err = ended(process, 60)
        # A process that is done, or that Python has not got to the point of hearing, ends by itself or by the signal.
        assert status in (0, STATUS[number], -number), f"status {status}: {err}"
        assert "Traceback" not in err and "Fatal Python error" not in err and "Exception ignored" not in err, err
        status, err = ended(started(folder), 120)
        assert outcome(status, "\n".join(err.splitlines()[-1:])) == MEASURED, err
        assert (folder / "run" / "rows.jsonl").read_bytes() == whole, "other rows"
        assert (folder / "run" / "report.html").exists(), "no page"
        assert not list(folder.rglob("*.partial")), "something is left"
        return MEASURED if status == 0 else REFUSED

    return case


def ended(process: subprocess.Popen[str], seconds: float) -> tuple[int, str]:
    try:
        _, err = process.communicate(timeout=seconds)
    finally:
        process.kill()
    return process.returncode, err


KINDS = (Kind("interruption", interruptions, 40, 0, seconds=400.0, chunk=10),)
