"""`normalbench quality --rounding dithered`: the cost of noise, the same noise in both languages, and refused
requests."""

import json

import numpy as np
import pytest
from test_quality_dithered import case

from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.storages.storage import STORAGES


def test_a_dithered_number_is_off_by_a_third_of_a_step_and_unbiased():
    """Without noise the error is a quarter of a step. A cube code's third number, the face, gets no noise."""
    dithered, nearest = (
        quality.image_round_trip(case("cube", "rgba8", rounding, normals="playground"))
        for rounding in ("dithered", "nearest")
    )
    exact = quality.image_round_trip(case("cube", "rgba32f", "nearest", normals="playground"))
    step, seen = STORAGES["rgba8"].step(0), exact.covered
    apart, usual = ((image.encoded - exact.encoded)[seen][:, :2] / step for image in (dithered, nearest))
    moves = abs(usual).max(axis=1) > 1e-3
    assert abs(usual[moves]).mean() == pytest.approx(1 / 4, rel=0.1)
    assert abs(apart[moves]).mean() == pytest.approx(1 / 3, rel=0.1)
    assert abs(apart.mean()) < 0.01
    assert np.array_equal(dithered.encoded[seen][:, 2], nearest.encoded[seen][:, 2])


@pytest.mark.usefixtures("rows_are_shared")
def test_files_of_a_dithered_codec_have_dithered_in_their_names(run, tmp_path):
    """A page cannot run a dithered codec, and the file for the page says so."""
    folders = {name: tmp_path / name for name in ("images", "maps", "live")}
    more = [word for name, folder in folders.items() for word in (f"--{name}", str(folder))]
    status, out, err = run(
        *["quality", "--encoding", "octahedral", "--storage", "rg8", "--rounding", "nearest,dithered"],
        *["--backend", "jax", "--normals", "playground", "--format", "json", *more],
    )
    assert (status, err) == (0, f"normalbench: the pictures are in {folders['images']}\n")
    assert [row["rounding"] for row in json.loads(out)] == ["nearest", "dithered"]
    for name in ("images", "maps"):
        assert any("dithered" in path.name for path in folders[name].iterdir()), name
    live = json.loads((folders["live"] / "octahedral-rg8-dithered.json").read_text())
    assert "noise" in live["left_out"] and "checks" in json.loads((folders["live"] / "octahedral-rg8.json").read_text())


@pytest.mark.usefixtures("rows_are_shared")
def test_an_exact_search_leaves_out_dithered_rounding(run):
    more = ["--backend", "jax", "--normals", "sphere", "--count", "4096", "--format", "json", "--codes"]
    status, out, err = run("quality", "--encoding", "octahedral", "--storage", "unorm:4:4", "--rounding", "all", *more)
    assert status == 0 and err.count("\n") == 1 and "left out: octahedral/" in err, err
    assert "--codes cannot be used with" in err, err
    assert {row["rounding"] for row in json.loads(out)} == {"nearest", "truncate", "truncate_half"}
