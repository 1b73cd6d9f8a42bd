"""A run with a user's encoder, capture, scene and layout: its rows, its page and the output of `compare`."""

import json

import pytest
from packed import packed_text
from written import as_document, planes_of, some_normals, write_exr

from normalbench.gbuffer.scenes.mesh import sphere

MINE = """
vec2 mine_encode(vec3 n, vec3 view) { return n.xy * SCALE; }
vec3 mine_decode(vec2 e, vec3 view) {
    vec2 p = e / SCALE;
    return normalize(vec3(p, sqrt(max(1.0 - dot(p, p), 0.0))));
}
"""


LAYOUT = """
title = "normals in 11:11 bits"
encoding = "octahedral"
space = "world"
targets = [
    { format = "rgba8", holds = "normal.x:11 normal.y:11 power:10" },
    { format = "rgba8", holds = "albedo.r albedo.g albedo.b kind" },
    { format = "rgba8", holds = "specular.r specular.g specular.b" },
]
"""


WORDS = {
    "--encoding": "mine.glsl,octahedral",
    "--storage": "rg8",
    "--normals": "frame.exr,sphere",
    "--scene": "scene.glb",
    "--layout": "mine.toml",
    "--tables": "quality,render,cost",
    "--count": "4096",
    "--family": "navi21",
}


@pytest.fixture
def runs(run, tmp_path, monkeypatch):
    """Two runs, `before` and `after`, that differ only in a constant of the encoder."""
    monkeypatch.chdir(tmp_path)
    write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    as_document([sphere(1.0, 16, 8)]).write(tmp_path / "scene.glb")
    (tmp_path / "mine.toml").write_text(LAYOUT)
    for name, scale in (("before", "1.0"), ("after", "0.7")):
        (tmp_path / "mine.glsl").write_text(MINE.replace("SCALE", scale))
        words = [word for pair in WORDS.items() for word in pair]
        status, _, err = run("run", *words, "-o", name)
        assert status == 0, err
    return tmp_path


@pytest.mark.usefixtures("gl", "radv")
def test_all_files_are_measured_shown_and_compared(run, runs):
    """Every row is on the page. The constant changes only the rows of the encoder; the worst row comes first."""
    tables = {name: json.loads((runs / f"before/{name}.json").read_text()) for name in ("quality", "render", "cost")}
    page = (runs / "before/report.html").read_text()
    for name, rows in tables.items():
        assert "mine" in {row["encoding"] for row in rows}, name
        data = json.loads(packed_text(page, f"data-{name}"))
        assert data["count"] == len(rows)
        words = {word for column in data["columns"] for word in column.get("words", ())}
        assert {str(row["encoding"] or row["storage"]) for row in rows} <= words, name
    assert {row["normals"] for row in tables["quality"]} == {"frame.exr", "sphere"}
    assert {row["scene"] for row in tables["render"]} == {"scene.glb"}
    assert any("mine" in row["layout"] for row in tables["render"])

    status, out, _ = run("compare", "before", "after", "--format", "json")
    changes = json.loads(out)
    assert status == 0 and changes and all("mine" in change["row"].split() for change in changes), changes
    assert changes[0]["verdict"] == "worse", "worst first"
    status, printed, _ = run("compare", "before", "after", "--fail-on", "worse")
    assert status == 1 and len(printed.splitlines()) <= 20 and "mine" in printed and "worse" in printed
