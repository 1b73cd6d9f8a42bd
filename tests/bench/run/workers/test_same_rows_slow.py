"""Rows and pictures from workers, equal to rows and pictures from one process to the last digit."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from speed.scheduled import scheduled
from written import as_document

import normalbench as nb
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Role
from normalbench.gbuffer.scenes.mesh import sphere

OCTAHEDRAL = """
vec2 wrap(vec2 v) { return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }
vec2 mine_encode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    return n.z >= 0.0 ? n.xy : wrap(n.xy);
}
vec3 mine_decode(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0) n.xy = wrap(n.xy);
    return normalize(n);
}
"""


LAYOUT = """
encoding = "own/mine.glsl"
targets = [
    { format = "rgba8", holds = "normal.x:11 normal.y:11 power:10" },
    { format = "rgba8", holds = "albedo.r albedo.g albedo.b kind" },
    { format = "rgba8", holds = "specular.r specular.g specular.b" },
]
"""


# Several back ends, and pictures; steps that are functions at night.
COMMANDS = {
    "quality": "--encoding octahedral,spheremap --storage rgba8,rg8 --normals sphere,axes --count 4096",
    "render": "--encoding octahedral,spheremap --scene gloss --size 64x36 --repeats 0",
}


PICTURED = ("lights", "render")


@pytest.fixture(scope="module")
def scheduler():
    """The address of a scheduler with two workers."""
    with scheduled({}, {}) as there:
        yield there.address


def rows_of(path: Path, table: str) -> list[dict]:
    times = {column.name for column in TABLES[table].of_role(Role.TIME)}
    return [{k: v for k, v in row.items() if k not in times} for row in json.loads(path.read_text())]


def pictures(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def measured(run, folder: Path, table: str, words: str, *on: str) -> tuple[list[dict], dict[str, bytes]]:
    pictured = ("--images", str(folder / "images")) if table in PICTURED else ()
    answer = run(table, *words.split(), *pictured, "-o", str(folder / "rows.json"), *on)
    assert answer[0] == 0, answer[2]
    assert "measured by this process" not in answer[2], answer[2]
    return rows_of(folder / "rows.json", table), pictures(folder / "images")


def compared(run, folder: Path, table: str, words: str) -> None:
    """Check that this process and two workers give the same rows and pictures."""
    (folder / "one").mkdir()
    (folder / "two").mkdir()
    here = measured(run, folder / "one", table, words)
    there = measured(run, folder / "two", table, words, "--on", "local:2")
    assert here[0] and here == there
    assert bool(here[1]) == (table in PICTURED), f"{len(here[1])} pictures"


@pytest.mark.parametrize("table", COMMANDS)
def test_workers_give_the_rows_and_pictures_of_one_process(gl, run, tmp_path, table):  # noqa: ARG001
    """Every figure matches to the last digit and in the same order, and every picture to the last byte."""
    compared(run, tmp_path, table, COMMANDS[table])


def test_workers_receive_users_files(gl, run, scheduler, tmp_path, monkeypatch, is_absolute=False):  # noqa: ARG001
    """An encoder with its includes, a layout that names the encoder, a scene and a set of normals give the same rows,
    however their paths are written."""
    typed = tmp_path / "typed" / "here"
    (typed / "own").mkdir(parents=True)
    monkeypatch.chdir(typed)
    wrap, rest = OCTAHEDRAL.strip().split("\n", 1)
    (typed / "own" / "wrap.glsl").write_text(wrap)
    (typed / "own" / "mine.glsl").write_text('#include "wrap.glsl"\n' + rest)
    (typed.parent / "other.glsl").write_text(OCTAHEDRAL.replace("mine", "other"))
    (typed / "lay.toml").write_text(LAYOUT)
    as_document([sphere(1.0, 16, 8)]).write(typed / "scene.glb")
    n = np.random.default_rng(1).normal(size=(500, 3))
    np.save(typed / "list.npy", (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32))
    prefix = f"{typed}/" if is_absolute else ""
    encoders = f"{prefix}own/mine.glsl,{typed.parent}/other.glsl,../other.glsl" if is_absolute else "own/mine.glsl"
    encoders = encoders.removesuffix(",../other.glsl") if is_absolute else f"{encoders},../other.glsl"
    commands = {
        "normals": f"quality --encoding {encoders} --storage rg8 --normals {prefix}list.npy --backend glsl",
        "encoders": f"render --encoding {encoders} --storage rg8 --scene {prefix}scene.glb --size 64x36 --repeats 0",
        "layout": f"render --layout {prefix}lay.toml,hybrid --scene {prefix}scene.glb --size 64x36 --repeats 0",
    }
    # To look at encoders first takes seconds, and paths are the same everywhere.
    for name in ("encoders", "layout") if is_absolute else ("normals", "layout"):
        table, words = commands[name].split(" ", 1)
        (tmp_path / f"{name}-one").mkdir()
        (tmp_path / f"{name}-two").mkdir()
        here = measured(run, tmp_path / f"{name}-one", table, words)
        there = measured(run, tmp_path / f"{name}-two", table, words, "--on", scheduler)
        assert len(here[0]) >= 2 and here == there, words


def test_the_python_interface_can_use_workers(scheduler):
    """The workers belong to a scheduler."""
    alone, others = (
        nb.quality(encoding=["octahedral", "xyz"], storage=["rgba8"], normals="axes", on=on) for on in (None, scheduler)
    )
    pd.testing.assert_frame_equal(others, alone)


def test_values_that_exist_only_in_python_are_refused():
    """Workers accept only names and files."""
    normals = {"own": np.eye(3)}
    with pytest.raises(UsageError, match="normals: own exists only in this process; with --on use names and files"):
        nb.quality(encoding="octahedral", storage="rg8", normals=normals, on="local:1")
