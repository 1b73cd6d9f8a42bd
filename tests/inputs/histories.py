"""Made-up runs of a repository's commits, in the form that `run` writes, with given figures."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from normalbench.bench.keep.schema import SCHEMA

COMMITS = 30
# 2026-01-01, and a day.
FIRST, DAY = 1767225600, 86400
# The commit that makes the code of `mine` worse, the one that makes its decoder longer, and the one that mends that.
FOLD, LONGER, SHORTER = 9, 14, 21
SUBJECTS = {FOLD: "Shorten the fold", LONGER: "Guard the decoder against zero", SHORTER: "Drop the guard"}
NOISE = 0.04
PIPELINES = ("forward", "deferred", "hybrid", "inferred")
Steps = Iterable[Mapping[str, Any]]


def name_of(at: int) -> str:
    """Return a made-up commit name in Git's form."""
    return f"{(at + 1) * 0x9E3779B97F4A7C15 % 2**64:016x}".ljust(40, "0")


def write_run(folder: Path, at: int, steps: Steps, **facts: Any) -> Path:
    """Write a run of the commit with this number."""
    about = {"name": name_of(at), "time": FIRST + DAY * at, "rank": 1, "changed": False}
    about |= {"subject": SUBJECTS.get(at, f"Change {at}")}
    record = {
        "schema": SCHEMA,
        "request": {"tables": ["all"]},
        "machine": {"GL": "one"},
        "sources": "s",
        "finished": True,
        "commit": about,
    }
    data = b"".join(json.dumps(step).encode() + b"\n" for step in steps)
    folder.mkdir(parents=True)
    (folder / "rows.jsonl").write_bytes(data)
    (folder / "run.json").write_text(json.dumps(record | seal(data) | facts))
    return folder


def seal(data: bytes) -> dict[str, Any]:
    """Return what a finished run records about its rows."""
    from normalbench.bench.keep.runs import _seal_columns

    return _seal_columns(data)


def steps(at: int, noise: np.random.Generator, more: int = 0) -> list[dict[str, Any]]:
    """Return the rows of a commit: errors of two encodings, their instructions, and times that are noise.

    Args:
        more: number of other encodings, whose figures never change.
    """
    rows = []
    for encoding in ("mine", "octahedral", *(f"code{number}" for number in range(more))):
        rows += [_quality(encoding, storage, at) for storage in ("rg8", "rgba8")]
        rows += [_cost(encoding, at)]
    return rows + [_times(pipeline, noise) for pipeline in PIPELINES]


def _quality(encoding: str, storage: str, at: int) -> dict[str, Any]:
    is_worse = encoding == "mine" and storage == "rg8" and at >= FOLD
    row = {
        "encoding": encoding,
        "storage": storage,
        "normals": "sphere",
        "backend": "jax",
        "count": 65536,
        "invalid": 0,
    }
    row |= {"psnr_db": 45.125 if is_worse else 48.25, "angle_mean_deg": 0.4812 if is_worse else 0.3361}
    return {"table": "quality", "key": {"encoding": encoding, "storage": storage}, "rows": [row]}


def _cost(encoding: str, at: int) -> dict[str, Any]:
    is_longer = encoding == "mine" and LONGER <= at < SHORTER
    rows = [
        {"encoding": encoding, "operation": operation, "stage": "fragment", "family": family, "instructions": count}
        for operation, count in (("encode", 14), ("decode", 19 if is_longer else 16))
        for family in ("navi21", "navi31")
    ]
    return {"table": "cost", "key": {"encoding": encoding}, "rows": rows}


def _times(pipeline: str, noise: np.random.Generator) -> dict[str, Any]:
    """Return a frame's milliseconds, which vary from run to run and occasionally double."""
    middle = 10 * float(np.exp(noise.normal(0, NOISE))) * (2 if noise.random() < 0.05 else 1)
    each = [round(middle * float(np.exp(noise.normal(0, 0.002))), 4) for _ in range(9)]
    row = {"pipeline": pipeline, "ms_frame": float(np.median(each)), "ms_frame_each": " ".join(map(str, each))}
    return {"table": "sweep", "key": {"pipeline": pipeline}, "rows": [row]}


def write_history(folder: Path, commits: int = COMMITS, more: int = 0, seed: int = 0) -> Path:
    """Write a folder with a run for each commit; the folders' names are in no particular order."""
    noise = np.random.default_rng(seed)
    for number in range(commits):
        write_run(folder / name_of(number)[:8], number, steps(number, noise, more))
    return folder
