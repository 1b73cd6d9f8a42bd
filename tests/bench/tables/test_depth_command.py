"""`normalbench depth`: output, files and messages for bad input."""

import json

import pytest

QUICK = ["depth", "--depth", "linear,window", "--near", "1", "--far", "100", "--count", "500", "--backend", "jax"]


@pytest.mark.usefixtures("gl", "rows_are_shared")
def test_table_has_a_line_for_each_code_with_its_distances_side_by_side(run):
    status, out, _ = run(*QUICK[:-2], "--distance", "5,50")
    rows = json.loads(run(*QUICK[:-2], "--distance", "5,50", "--format", "json")[1])
    assert status == 0
    for way in ("inverse_projection", "projection_terms"):
        name = ["window", "depth16", way, "glsl"]
        (line,) = (line for line in out.splitlines() if [word for word in line.split() if word != "16"][:4] == name)
        wanted = [row for row in rows if [row[c] for c in ("depth", "storage", "rebuilt", "backend")] == name]
        assert all(f"{row['error_max']:#.4g}" in line or f"{row['error_max']:.2e}" in line for row in wanted), line


@pytest.mark.usefixtures("rows_are_shared")
def test_overflowing_errors_are_null_in_json(run):
    """Half floats end at 65504; for greater linear depths the error and the bound are both infinite."""
    arguments = ["--near", "1", "--far", "1e6", "--distance", "100,1e5", "--format", "json", "--backend", "jax"]
    status, out, _ = run("depth", "--depth", "linear", "--storage", "r16f", "--count", "100", *arguments)
    rows = json.loads(out)
    assert status == 0 and [row["error_max"] is None for row in rows] == [False, True, True]
    assert [row["bound"] is None for row in rows] == [False, True, True]


@pytest.mark.usefixtures("rows_are_shared")
def test_every_available_reconstruction_is_measured(run):
    status, out, err = run(*QUICK, "--rebuild", "all", "--storage", "depth24", "--format", "json")
    assert status == 0 and err == ""
    ways = {(row["depth"], row["rebuilt"]) for row in json.loads(out)}
    by_window = {("window", way) for way in ("inverse_projection", "projection_terms", "eye_ray")}
    assert ways == {("linear", "eye_ray")} | by_window


@pytest.mark.usefixtures("rows_are_shared")
def test_rows_cover_both_reconstructions_used_by_engines(run):
    """At 100, 24-bit z/w is off by 0.019 with the matrix and 0.0212 with the two terms; half a step is 0.0052."""
    words = ["depth", "--depth", "window,linear", "--storage", "depth24,packed16", "--near", "0.1", "--distance", "100"]
    rows = json.loads(run(*words, "--backend", "jax", "--format", "json")[1])
    by_key = {(row["depth"], row["storage"], row["rebuilt"]): row for row in rows if row["distance"]}
    ways = ["inverse_projection", "projection_terms"]
    assert [way for depth, storage, way in by_key if (depth, storage) == ("window", "depth24")] == ways
    assert {way for depth, _, way in by_key if depth == "linear"} == {"eye_ray"}
    by_matrix, by_terms = (by_key["window", "depth24", way] for way in ways)
    assert by_matrix["error_max"] == pytest.approx(0.019, abs=5e-4)
    assert by_terms["error_max"] == pytest.approx(0.0212, abs=5e-4)
    assert by_matrix["half_step"] == by_terms["half_step"] == pytest.approx(0.0052, abs=1e-4)


BAD = {
    "a depth": (["--depth", "lineal"], ["'lineal'", "linear", "reversed_window"]),
    "a storage": (["--storage", "depth8"], ["'depth8'", "packed16", "depth32f"]),
    "a way": (["--rebuild", "guess"], ["'guess'", "inverse_projection", "projection_terms", "eye_ray"]),
    "a back end": (["--backend", "vulkan"], ["'vulkan'", "jax", "glsl"]),
    "near zero": (["--near", "0"], ["--near 0", "1e-06"]),
    "near below": (["--near", "-1"], ["--near -1"]),
    "far before near": (["--near", "5", "--far", "1"], ["--near 5 --far 1"]),
    "far at near": (["--near", "5", "--far", "5"], ["--near 5 --far 5"]),
    "no number": (["--near", "close"], ["--near close", "numbers from"]),
    "nothing": (["--far", ","], ["--far : expected numbers from"]),
    "not a number": (["--near", "nan"], ["--near nan"]),
    "infinite": (["--far", "inf"], ["--far inf"]),
    "too far": (["--far", "1e30"], ["--far 1e30", "1e+09"]),
    "beyond far": (["--distance", "2000"], ["--distance 2000", "far 1000"]),
    "before near": (["--near", "1", "--distance", "0.5"], ["--distance 0.5", "near 1"]),
    "no points": (["--count", "0"], ["--count 0"]),
    "too many points": (["--count", "99999999999"], ["--count 99999999999", "use 2 to"]),
    "a seed": (["--seed", "-1"], ["--seed -1"]),
    "a view": (["--fov", "180"], ["--fov 180", "170"]),
    "no view": (["--fov", "nan"], ["--fov nan", "170"]),
    "no room": (["--depth", "linear_sign", "--storage", "depth24"], ["linear_sign/depth24", "no room for a sign"]),
    "a way to round": (["--rounding", "up"], ["'up'", "truncate", "dithered"]),
    "a depth buffer's rounding": (
        ["--depth", "window", "--storage", "depth24", "--rounding", "truncate"],
        ["window/depth24/truncate", "the device always rounds it to nearest"],
    ),
    "noise of floats": (["--depth", "linear", "--storage", "r16f", "--rounding", "dithered"], ["R16F", "fixed point"]),
    "no projection": (["--depth", "linear", "--rebuild", "inverse_projection"], ["linear/packed16"]),
    "a plot": (["--plot", "plot.gif"], ["plot.gif", ".png"]),
    "no folder": (["-o", "/proc/nowhere/rows.csv"], ["/proc/nowhere"]),
    "plot nowhere": (["--plot", "/proc/nowhere/plot.png"], ["/proc/nowhere"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error_with_valid_values(run, what, tmp_path, monkeypatch):
    arguments, parts = BAD[what]
    monkeypatch.chdir(tmp_path)
    status, out, err = run("depth", *arguments)
    assert status == 2 and out == ""
    lines = err.splitlines()
    assert len(lines) == 1 and lines[0].startswith("normalbench: "), err
    assert all(part in err for part in parts), err
    assert not list(tmp_path.iterdir()), "something was left behind"


def test_bits_of_a_depth_storage_can_be_chosen(run):
    """Linear depth in n bits is off by half of 1 / (2^n - 1) of the far plane, along its ray."""
    words = ("--depth", "linear", "--storage", "unorm:12..14", "--backend", "jax", "--near", "0.1", "--far", "1000")
    status, out, err = run("depth", *words, "--format", "json")
    rows = json.loads(out)
    by_storage = {row["storage"]: row for row in rows if row["distance"] == 100}
    assert status == 0 and not err and list(by_storage) == ["packed12", "packed13", "packed14"]
    ray = by_storage["packed12"]["half_step"] / (1000 / 4095 / 2)
    assert 1 < ray < 2, "the farthest pixel's"
    for bits, row in zip((12, 13, 14), by_storage.values(), strict=True):
        assert row["half_step"] == pytest.approx(ray * 1000 / (2**bits - 1) / 2, rel=1e-3)
        assert row["error_max"] == pytest.approx(row["half_step"], rel=0.05)
    status, _, err = run("depth", "--storage", "unorm:9:7")
    assert status == 2 and "unknown depth storage 'unorm:9:7'" in err and err.count("\n") == 1
