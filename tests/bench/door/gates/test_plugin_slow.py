"""The pytest plugin, by pytest inside pytest: gates that hold and fail, no GL driver, xdist, baselines, misuse."""

import json
import re
from pathlib import Path

import devices
import pytest
import test_plugin
from test_plugin import BASELINE, BOTH, PLAIN, SMALL

inside = test_plugin.inside
loaded = test_plugin.loaded


NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "VIRTUAL_DISPLAY": ""}


(MINE,) = re.findall(r"```glsl\n(.*?)```", (Path(__file__).parents[4] / "README.md").read_text(), re.S)


@pytest.mark.usefixtures("gl")
def test_a_users_own_encoding_lies_beside_the_test(inside, pytester):
    """In a folder that is not the one pytest was started in; what is typed lies where it is typed."""
    folder = pytester.mkdir("deep")
    (folder / "mine.glsl").write_text(MINE)
    test = """
        def test_it(normalbench):
            row = normalbench.quality({}normals="hemisphere", backend="glsl", count=4096)
            row.assert_that(angle_max_deg="at most 1")
            assert row["encoding"] == "mine"
    """
    (folder / "test_it.py").write_text(test.format('encoding="mine.glsl", ').replace("\n        ", "\n"))
    inside().assert_outcomes(passed=1)
    (folder / "test_it.py").unlink()
    inside("--normalbench-encoding", "deep/mine.glsl", test_b=test.format("")).assert_outcomes(passed=1)


HLSL = Path(__file__).parents[3] / "inputs/hlsl/octahedral.hlsl"


@pytest.mark.usefixtures("gl", "hlsl")
def test_a_users_file_in_hlsl_lies_beside_the_test(inside, pytester):
    """With the names of its functions or without."""
    (pytester.path / "mine.hlsl").write_text(HLSL.read_text())
    result = inside(
        test_a="""
        def test_mine(normalbench):
            for name in ("mine.hlsl", "mine.hlsl:EncodeNormal:DecodeNormal"):
                row = normalbench.quality(encoding=name, storage="rg8", normals="sphere", count=4096)
                row.assert_that(angle_mean_deg="at most 0.4")
        """
    )
    result.assert_outcomes(passed=1)


def test_a_test_holds_devices(inside, pytester):
    """By the marker, with a file beside the test."""
    devices.write(pytester.path / "a.json")
    limits = 'further="at most 0", same_percent="at least 99.9"'
    marked = f'@pytest.mark.normalbench(table="devices", devices="a.json", {limits})\ndef test_it(): pass\n'
    inside(test_it=f"import pytest\n{marked}").assert_outcomes(passed=1)


def test_without_a_gl_driver_rows_of_jax_are_held_and_the_others_skipped(pytester, monkeypatch):
    for name, value in NO_GL.items():
        monkeypatch.setenv(name, value)
    pytester.makepyfile(BOTH)
    result = pytester.runpytest_subprocess("-rs", *PLAIN)
    result.assert_outcomes(passed=1, failed=1, skipped=3)
    result.stdout.fnmatch_lines(["*test_jax_breaks_it*", "SKIPPED*no GL 4.3 device: *apt-get install libegl1*"])


@pytest.mark.usefixtures("loaded")
def test_two_workers_measure_and_write_one_baseline(pytester):
    """Rows of both are in the file, which the process that started them writes once."""
    pytest.importorskip("xdist")
    test = f"""
        from pathlib import Path
        def test_it(normalbench, worker_id):
            normalbench.quality(**{SMALL}, seed=SEED).matches_baseline()
            Path(worker_id).touch()
    """
    for seed in range(4):
        pytester.makepyfile(**{f"test_{seed}": test.replace("SEED", str(seed))})
    arguments = ("-n", "2", "--dist", "loadfile", *PLAIN, *BASELINE)
    pytester.runpytest_subprocess(*arguments, "--normalbench-write-baseline").assert_outcomes(passed=4)
    assert (pytester.path / "gw0").exists() and (pytester.path / "gw1").exists(), "both had work"
    entries = json.loads((pytester.path / "kept/rows.json").read_text())
    assert [one["key"]["seed"] for one in entries] == [0, 1, 2, 3]
    for name in ("test_0", "test_1", "test_2", "test_3"):
        path = pytester.path / f"{name}.py"
        path.write_text(path.read_text().replace(", worker_id", "").replace("Path(worker_id)", "Path('alone')"))
    pytester.runpytest_inprocess(*PLAIN, *BASELINE).assert_outcomes(passed=4)
