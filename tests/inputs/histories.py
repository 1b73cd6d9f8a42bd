"""Made-up runs of the commits of a repository: as `run` writes them, with figures that are given."""

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
    """A commit's name, as Git's are."""
    return f"{(at + 1) * 0x9E3779B97F4A7C15 % 2**64:016x}".ljust(40, "0")


def write_run(folder: Path, at: int, steps: Steps, **facts: Any) -> Path:
    """A run of the commit of a number."""
    about = {"name": name_of(at), "time": FIRST + DAY * at, "rank": 1, "changed": False}
    about |= {"subject": SUBJECTS.get(at, f"Change {at}")}
    made = {
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
    (folder / "run.json").write_text(json.dumps(made | seal(data) | facts))
    return folder


def seal(data: bytes) -> dict[str, Any]:
    """What a finished run remembers of its rows."""
    from normalbench.bench.keep.runs import _seal_columns

    return _seal_columns(data)


def steps(at: int, noise: np.random.Generator, more: int = 0) -> list[dict[str, Any]]:
    """The rows of a commit: errors of two codes, their instructions, and times that are noise.

    Args:
        more: further encodings, whose figures never change.
    """
    found = []
    for encoding in ("mine", "octahedral", *(f"code{number}" for number in range(more))):
        found += [_quality(encoding, storage, at) for storage in ("rg8", "rgba8")]
        found += [_cost(encoding, at)]
    return found + [_times(pipeline, noise) for pipeline in PIPELINES]


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
    """A frame's milliseconds, which waver from run to run, and now and then are twice as many."""
    middle = 10 * float(np.exp(noise.normal(0, NOISE))) * (2 if noise.random() < 0.05 else 1)
    each = [round(middle * float(np.exp(noise.normal(0, 0.002))), 4) for _ in range(9)]
    row = {"pipeline": pipeline, "ms_frame": float(np.median(each)), "ms_frame_each": " ".join(map(str, each))}
    return {"table": "sweep", "key": {"pipeline": pipeline}, "rows": [row]}


def write_history(folder: Path, commits: int = COMMITS, more: int = 0, seed: int = 0) -> Path:
    """A folder with a run of each commit, whose names are in no order of theirs."""
    noise = np.random.default_rng(seed)
    for at in range(commits):
        write_run(folder / name_of(at)[:8], at, steps(at, noise, more))
    return folder
