"""Damaged gates, layouts, baselines and runs."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from damaged import mutated, revalued
from written import some_normals

from normalbench.bench.door.gates.baseline import Baseline, read_baseline
from normalbench.bench.door.gates.gates import checked, read_gates
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.scenes.frame_file import read_frame_file
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.registry import TABLES
from normalbench.gbuffer.layouts.layout import read_layout
from normalbench.gbuffer.layouts.words import LayoutError

from .kind import MEASURED, Attack, Kind, command, one_line, outcome

GATES = """
[[gate]]
encoding = "octahedral"
storage = "rgba8"
normals = "sphere"
count = 4096
seed = 1
psnr_db = "at least 49.5"
[[gate]]
table = "quality"
normals = "list.npy"
encoding = "xy"
nan_share = 0.5
normalise = true
angle_max_deg = "at most 1e2"
"""
LAYOUT = """
title = "a layout"
encoding = "octahedral"
space = "world"
rounding = "nearest"
targets = [
    { format = "rgba8", holds = "normal.x:11 normal.y:11 power:10" },
    { format = "rg16f", holds = "albedo.r albedo.g" },
]
"""
BASELINE = json.dumps([{"table": "quality", "key": {"seed": 1}, "row": {"psnr_db": 1.5, "exact": False}}] * 2)
EMPTY = TABLES["quality"].empty()


def made_up(cases: Any, _: Any) -> Iterator[dict[str, Any]]:
    """Return rows without measuring anything."""
    return (EMPTY | {"encoding": case.codec.name} for case in cases)


def gated(path: Path) -> None:
    with patch.object(quality, "rows", made_up):
        list(checked(read_gates(path), None, lambda _: None))


def based(path: Path) -> None:
    read_baseline(path)
    Baseline(path, False).differences({"table": "quality", "key": {"seed": 1}, "row": {"psnr_db": 1.5}}, {})


FRAME = json.dumps(
    {
        "fov": 60,
        "near": 0.1,
        "far": 100,
        "view_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "depth": {"file": "list.npy", "channel": "0", "depth_unit": 1.0},
        "normal": {"file": "list.npy", "channels": "0,1,2", "nan_share": 0.1, "unpack": False},
        "base_color": [0.5, 0.25, 1],
        "roughness": {"file": "list.npy", "scale": 2},
    }
)

TEXTS = {
    "gates": ("a.toml", GATES, gated, UsageError),
    "layout": ("a.toml", LAYOUT, read_layout, LayoutError),
    "baseline": ("a.json", BASELINE, based, (UsageError, AssertionError)),
    "frame": ("a.json", FRAME, read_frame_file, UsageError),
}


def texts(kind: str, folder: Path) -> Attack:
    """Return an attack on a text file: it is read, or refused in one line that names the file."""
    name, text, read, refused = TEXTS[kind]
    path = folder / name
    os.chdir(folder)
    np.save(folder / "list.npy", some_normals()[0])

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        change = revalued if path.suffix == ".json" and seed % 2 else mutated
        path.write_bytes(change(text.encode(), rng))
        try:
            read(path)
        except refused as error:
            assert str(path) in str(error), str(error)
            return one_line(type(error)(str(error).replace(str(path), "")))
        return MEASURED

    return case


RUN = ("run", "--tables", "quality,frames", "--encoding", "octahedral,spheremap", "--storage", "rg8,rgba8,rgb10a2")
RUN += ("--normals", "axes", "--backend", "jax", "--count", "4096")
CHECK = (
    '[[gate]]\nencoding = "octahedral"\npsnr_db = "at least 1"\n[[gate]]\ntable = "depth"\nerror_max = "at most 9"\n'
)


def runs(commands: str, folder: Path) -> Attack:
    """Return an attack on an edited results folder: other bytes or other values; half of the runs are unfinished."""
    os.chdir(folder)
    status, _, err = command(*RUN, "-o", "whole")
    assert status == 0, err
    Path("gates.toml").write_text(CHECK)
    facts, rows = (Path("whole", name).read_bytes() for name in ("run.json", "rows.jsonl"))
    shutil.copytree("whole", "run")
    open_facts = json.dumps(json.loads(facts) | {"finished": False}).encode()
    ways = {
        "report": ("report", "run", "--markdown"),
        "compare": ("compare", "whole", "run", "--format", "json"),
        "compare back": ("compare", "run", "whole"),
        "history": ("history", "whole", "run", "--format", "json"),
        "check": ("check", "gates.toml", "--run", "run"),
        "page": ("report", "run"),
        "go on": (*RUN, "-o", "run"),
    }

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        words = ways[commands.split(",")[seed % len(commands.split(","))]]
        kept, lines = (facts, open_facts)[int(rng.integers(2))], rows.splitlines()
        index = int(rng.integers(len(lines) + 1))
        change = (mutated, revalued)[int(rng.random() < 0.8)]
        if index == len(lines):
            kept = change(kept, rng)
        else:
            lines[index] = change(lines[index], rng)
        Path("run", "run.json").write_bytes(kept)
        Path("run", "rows.jsonl").write_bytes(b"\n".join(lines) + b"\n")
        status, _, err = command(*words)
        return outcome(status, err)

    return case


KINDS = (
    *(Kind(f"text: {kind}", partial(texts, kind), 3400, 100, reads_here_only=True) for kind in TEXTS),
    Kind("run: read", partial(runs, "report,compare,compare back,check,history"), 3000, 40, chunk=1500),
    Kind("run: page and going on", partial(runs, "page,go on"), 60, 0, seconds=30.0, chunk=30),
)
