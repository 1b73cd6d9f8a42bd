"""The pytest plugin, tested inside pytest: gates that pass or fail, no OpenGL driver, xdist, baselines, misuse."""

import json
import re
import subprocess
import sys
from pathlib import Path

import devices
import pytest

from normalbench.bench.door.gates import baseline, measured
from normalbench.bench.ground.machine import devices as devices_of_the_machine
from normalbench.bench.ground.options.option import fields_of
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.registry import TABLES
from normalbench.gbuffer.gl.device import NoDeviceError

SMALL = 'dict(encoding="xy", normals="sphere", count=4096)'


# Hypothesis is rewritten anew each time pytest is run inside pytest, which takes seconds.
PLAIN = ("-p", "no:cacheprovider", "-p", "no:hypothesispytest", "-p", "no:jaxtyping")


PASSES = f"""
    def test_it(normalbench):
        row = normalbench.quality(**{SMALL})
        row.assert_that(psnr_db="at least 5", angle_max_deg="at most 180")
        assert 5 < row["psnr_db"] < 10 and row.rows[0]["count"] == 4096
"""


@pytest.fixture(scope="session")
def loaded():
    """Modules that are imported in advance, because the inner pytest forgets its own imports."""
    assert baseline
    for measurement in measured.measured(TABLES["quality"], {"encoding": "xy", "normals": "sphere", "count": 4096}):
        assert measurement.worst


@pytest.fixture
def inside(pytester, loaded):  # noqa: ARG001 # for what it does
    """A function that runs pytest inside pytest on test files, each given by name, and returns the result."""

    def run(*arguments: str, **tests: str) -> pytest.RunResult:
        if tests:
            pytester.makepyfile(**tests)
        return pytester.runpytest_inprocess(*PLAIN, *arguments)

    return run


def test_a_gate_that_holds_passes(inside):
    inside(test_a=PASSES).assert_outcomes(passed=1)


def test_a_failure_shows_value_threshold_and_worst_normal(inside):
    """In `xy` on the sphere, a normal that faces away comes back with z reversed. The figures match the row."""
    (measurement,) = measured.measured(TABLES["quality"], {"encoding": "xy", "normals": "sphere", "count": 4096})
    result = inside(
        test_a=f"""
        def test_it(normalbench):
            row = normalbench.quality(**{SMALL})
            row.assert_that(psnr_db="at least 5", angle_max_deg="at most 0.5", mse="at most 1e-3")
        """
    )
    result.assert_outcomes(failed=1)
    name = "xy rgba8 nearest sphere jax"
    result.stdout.fnmatch_lines(
        [
            '>*row.assert_that(psnr_db="at least 5", angle_max_deg="at most 0.5", mse="at most 1e-3")',
            f"E*{name}: angle_max_deg is {measurement.row['angle_max_deg']:.9g}, not at most 0.5",
            f"E*{name}: mse is {measurement.row['mse']:.9g}, not at most 0.001",
            f"E*worst normal: {measurement.worst}",
        ]
    )
    assert measurement.worst.angle_deg == pytest.approx(measurement.row["angle_max_deg"], rel=1e-6)
    assert measurement.worst.normal[2] < -0.9 and measurement.worst.decoded[2] > 0.9
    assert "session.py" not in result.stdout.str(), "the traceback is the test's own"


def test_a_marker_is_checked_before_its_test_runs(inside):
    result = inside(
        test_a=f"""
        import pytest
        @pytest.mark.normalbench(psnr_db="at least 5", **{SMALL})
        def test_holds(): pass
        @pytest.mark.normalbench(psnr_db="at least 50", **{SMALL})
        def test_does_not(): raise RuntimeError("this is not run")
        @pytest.mark.normalbench(encodin="xy", psnr_db="at least 5")
        def test_unknown(): pass
        @pytest.mark.normalbench("xy", psnr_db="at least 5")
        def test_by_position(): pass
        @pytest.mark.normalbench(encoding="xy")
        def test_no_limit(): pass
        @pytest.mark.normalbench(table="costs", latency="at most 5")
        def test_table(): pass
        @pytest.mark.normalbench(psnr="at least 5", **{SMALL})
        def test_column(): pass
        @pytest.mark.normalbench(table=["quality"], psnr_db="at least 5")
        def test_tables(): pass
        @pytest.mark.normalbench(encoding=["xy"], psnr_db="at least 5")
        def test_encodings(): pass
        """
    )
    result.assert_outcomes(passed=1, failed=8)
    result.stdout.fnmatch_lines(
        [
            "xy rgba8 nearest sphere jax: psnr_db is *, not at least 50",
            "  worst normal: (*) decodes to (*), * degrees off",
            "unknown option 'encodin'; known: encoding, storage, rounding, arithmetic, normals, *",
            "the marker normalbench takes options and thresholds by name, not 'xy'",
            'no threshold given; add for example psnr_db = "at least 47.5"',
            "unknown table 'costs'; did you mean cost? known: pick, budget, quality, render, *",
            "quality: no column 'psnr'; figures: bits, *",
            "unknown table *quality*; known: pick, budget, quality, render, *",
            "encoding is *xy*; it must be text",
        ]
    )
    assert "this is not run" not in result.stdout.str() and "Traceback" not in result.stdout.str()


MISUSE = {
    'quality(encoding="octahedron")': "unknown encoding 'octahedron'; did you mean octahedral? known: all, xyz",
    "quality(count=0)": "--count 0: out of range; use 1 to",
    'quality(count="many")': "count is 'many'; it must be a whole number",
    f"quality(**{SMALL}).assert_that()": 'no threshold given; add for example psnr_db="at least 47.5"',
    f"quality(**{SMALL}).assert_that(psnr_db=49.5)": 'psnr_db: 49.5 is not a threshold; write "at least 47.5"',
    f"quality(**{SMALL}).assert_that(psnr_db='at least x')": "psnr_db: x is not a number",
    f"quality(**{SMALL}).assert_that(psnr='at least 5')": "quality: no column 'psnr'; figures: bits",
    f"quality(**{SMALL}).assert_that(psnr_db='at least 5', mse='at least x')": "mse: x is not a number",
    f"quality(**{SMALL}).assert_that(psnr_db='at least 5', device='at least 5')": "quality: device is not a figure",
    f"quality(**{SMALL}).assert_that(angle_sup_deg='at most 5')": "angle_sup_deg is measured only with worst_case=True",
    f"quality(**{SMALL}, storage='rgba8,rg16f')['psnr_db']": "there are 2 rows; choose one from .rows",
    f"quality(**{SMALL}).matches_baseline()": "name one with --normalbench-baseline FILE",
}


def test_misuse_is_a_one_line_error(inside):
    tests = "\n".join(f"def test_{i}(normalbench):\n    normalbench.{call}" for i, call in enumerate(MISUSE))
    result = inside(test_a=tests)
    result.assert_outcomes(failed=len(MISUSE))
    lines = [line for line in result.stdout.lines if line.startswith("E ")]
    for line, message in zip(lines, MISUSE.values(), strict=True):
        assert "UsageError" in line and message in line, line
    assert "session.py" not in result.stdout.str(), "the traceback is the test's own"


def test_a_row_is_measured_once_per_session(inside):
    """Two files, a marker and a command-line option request the same row; another seed makes another row."""
    counting = f"""
        import pytest
        from normalbench.bench.tables.quality import measure as quality
        rows, cases = quality.rows, []
        def counting(chosen, tick):
            chosen = list(chosen)
            cases.extend(chosen)
            return rows(chosen, tick)
        @pytest.fixture(scope="session", autouse=True)
        def counted():
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(quality, "rows", counting)
                yield
            assert [case.normal_set.seed for case in cases] == [7, 8]
        @pytest.fixture
        def same():
            return {SMALL}
    """
    asked = "def test_it(normalbench, same):\n    normalbench.quality(**same)"
    marked = f"import pytest\n@pytest.mark.normalbench(psnr_db='at least 5', seed=7, **{SMALL})\ndef test_it(): pass"
    other = "def test_it(normalbench, same):\n    normalbench.quality(**same, seed=8)"
    result = inside(
        "--normalbench-seed", "7", conftest=counting, test_a=asked, test_b=asked, test_c=marked, test_d=other
    )
    result.assert_outcomes(passed=4)


def test_every_option_of_the_tables_is_an_option_of_the_plugin(pytester):
    shown = pytester.runpytest_inprocess("--help", *PLAIN).stdout.str()
    for table in TABLES.values():
        for name, field in fields_of(table.options).items():
            assert f"--normalbench-{name.replace('_', '-')}" in shown
            assert field.option.help.split(";")[0].rstrip(".") in re.sub(r"\s+", " ", shown), name


@pytest.mark.usefixtures("gl")
def test_an_image_may_have_thresholds(inside):
    result = inside(
        test_a="""
        def test_it(normalbench):
            row = normalbench.render(encoding="octahedral", size="64x48", lights=4)
            row.assert_that(psnr_db="at least 20")
            row.assert_that(psnr_db="at least 90")
        """
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["E*hybrid fp32 octahedral rgba8 nearest rgba32f 2 studio *: psnr_db is *, not at least 90"]
    )
    result.stdout.fnmatch_lines(["E*worst normal: (*) decodes to (*), 0.* degrees off"])


BOTH = """
    import pytest
    SMALL = dict(encoding="xy", normals="sphere", count=4096)
    def test_jax(normalbench):
        normalbench.quality(**SMALL).assert_that(psnr_db="at least 5")
    def test_both_hold(normalbench):
        normalbench.quality(**SMALL, backend="jax,glsl").assert_that(psnr_db="at least 5")
    def test_jax_breaks_it(normalbench):
        normalbench.quality(**SMALL, backend="jax,glsl").assert_that(psnr_db="at least 50")
    def test_glsl(normalbench):
        normalbench.quality(**SMALL, backend="glsl").assert_that(psnr_db="at least 5")
    @pytest.mark.normalbench(table="render", psnr_db="at least 5")
    def test_render(): pass
"""


def test_tests_fail_without_opengl_if_it_is_required(inside, monkeypatch):
    def missing():
        raise NoDeviceError("no OpenGL 4.3 device: none is here")

    for module in (quality, devices_of_the_machine):
        monkeypatch.setattr(module, "device", missing)
    result = inside("--normalbench-require-gl", test_a=BOTH)
    result.assert_outcomes(passed=1, failed=4)
    result.stdout.fnmatch_lines(["no OpenGL 4.3 device: none is here"])


STORED = """
    def test_sphere(normalbench):
        normalbench.quality(**SMALL).matches_baseline()
    def test_seed(normalbench):
        normalbench.quality(**SMALL, seed=1, storage="rgba8,rg16f").matches_baseline()
""".replace("SMALL", SMALL)


BASELINE = ("--normalbench-baseline", "kept/rows.json")


@pytest.fixture
def written(inside, pytester):
    """The path of a baseline with three rows."""
    inside(*BASELINE, "--normalbench-write-baseline", test_a=STORED).assert_outcomes(passed=2)
    return pytester.path / "kept/rows.json"


def test_a_baseline_is_written_on_request_and_holds(inside, written):
    entries = json.loads(written.read_text())
    keys = [(entry["key"]["seed"], entry["key"]["storage"]) for entry in entries]
    assert keys == [(0, "rgba8"), (1, "rg16f"), (1, "rgba8")]
    assert not any(name.startswith("ms_") for entry in entries for name in entry["row"])
    assert [path.name for path in written.parent.iterdir()] == ["rows.json"]
    before = written.read_bytes()
    inside(*BASELINE).assert_outcomes(passed=2)
    assert written.read_bytes() == before


def test_a_changed_figure_fails_unless_it_is_within_a_tolerance(inside, written):
    entries = json.loads(written.read_text())
    entries[2]["row"]["psnr_db"] += 1e-9
    written.write_text(json.dumps(entries))
    before = written.read_bytes()
    result = inside(*BASELINE)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(
        ["E*xy rgba8 nearest sphere jax: psnr_db is *, but * in the baseline (-1e-09)", "E*worst normal: (*)*"]
    )
    inside(*BASELINE, test_a=STORED.replace("baseline()", "baseline(psnr_db=1e-8)")).assert_outcomes(passed=2)
    result = inside(*BASELINE, test_a=STORED.replace("baseline()", "baseline(psnr=1, mse=-1)"))
    result.stdout.fnmatch_lines(["E*no column 'psnr'; known: encoding*"])
    assert written.read_bytes() == before, "reading does not write"


def test_a_missing_row_names_the_option_that_writes_it(inside, written):
    before = written.read_bytes()
    result = inside(*BASELINE, test_a=STORED.replace("count=4096", "count=4097"))
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(["E*rows.json has no row xy rgba8 * jax; write it with --normalbench-write-baseline"])
    assert written.read_bytes() == before
    assert inside("--normalbench-baseline", "none.json").ret == 1 and not Path("none.json").exists()


def test_writing_keeps_other_rows_and_files_that_are_not_baselines(inside, written, pytester):
    inside(*BASELINE, "--normalbench-write-baseline", test_a=STORED.replace("4096", "4097").replace("seed=1", "seed=2"))
    entries = json.loads(written.read_text())
    assert sorted((entry["key"]["count"], entry["key"]["seed"]) for entry in entries) == [
        *((4096, seed) for seed in (0, 1, 1)),
        *((4097, seed) for seed in (0, 2, 2)),
    ]
    other = pytester.makefile(".json", other='{"mine": 1}')
    result = inside("--normalbench-baseline", "other.json", "--normalbench-write-baseline")
    assert result.ret == 2 and other.read_text() == '{"mine": 1}'
    assert "other.json is not a baseline" in result.stdout.str() + result.stderr.str()
    for arguments, message in (
        (["--normalbench-write-baseline"], "--normalbench-write-baseline requires --normalbench-baseline FILE"),
        (["--normalbench-write-baseline", "--normalbench-baseline", "/proc/no/a.json"], "cannot write to /proc/no"),
    ):
        result = inside(*arguments)
        assert result.ret == 4 and message in result.stderr.str(), "before anything is measured"


def test_a_run_that_does_not_use_the_plugin_imports_only_its_options(pytester):
    """JAX, NumPy and the command line are not imported, and the plugin can be disabled completely."""
    pytester.makepyfile(
        """
        import sys
        def test_it():
            heavy = {"jax", "numpy", "moderngl", "typer", "rich", "pandas", "matplotlib", "PIL"}
            assert not heavy & set(sys.modules)
            named = [m.removeprefix("normalbench.bench") for m in sys.modules if m.startswith("normalbench.")]
            rooms = ("", ".door", ".door.pytest_plugin", ".ground", ".ground.options", ".ground.output", ".tables")
            assert {m for m in named if not m.startswith(".tables.")} <= {
                *rooms, ".door.pytest_plugin.plugin", ".door.pytest_plugin.own_options", ".ground.options.option",
                ".ground.options.counts", ".ground.options.gpu_families", ".ground.options.source_options",
                ".ground.options.words", ".ground.user_files", ".ground.output.errors",
                ".ground.spelling", ".ground.choose", "normalbench.reports", "normalbench.reports.sheets",
                "normalbench.gbuffer", "normalbench.gbuffer.layouts", "normalbench.gbuffer.layouts.names"
            }
            light = (".table", ".registry", ".rates")
            assert all(m.endswith(light) or m.count(".") == 2 for m in named if ".tables." in m)
        """
    )
    pytester.runpytest_subprocess("--strict-markers", *PLAIN).assert_outcomes(passed=1)
    result = pytester.runpytest_subprocess("-p", "no:normalbench", "--normalbench-seed", "1")
    assert result.ret == 4, "its options went with it"


def test_importing_the_plugin_is_cheap():
    """The import adds a few milliseconds; the limit is far above that and far below the second that JAX takes."""
    code = "import sys, time, pytest; began = time.process_time(); import normalbench.bench.door.pytest_plugin.plugin; "
    code += "print(time.process_time() - began, *{'jax', 'pandas', 'matplotlib', 'moderngl'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    seconds, *heavy = done.stdout.split()
    assert not heavy and float(seconds) < 0.2, done.stdout


NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "VIRTUAL_DISPLAY": ""}


(MINE,) = re.findall(r"```glsl\n(.*?)```", (Path(__file__).parents[4] / "README.md").read_text(), re.S)


@pytest.mark.usefixtures("gl")
def test_a_users_encoding_is_found_next_to_the_test(inside, pytester):
    """The test is not in the folder where pytest started; paths in command-line options start from that folder."""
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
def test_a_users_hlsl_file_is_found_next_to_the_test(inside, pytester):
    """The functions in the file may be named or left out."""
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


def test_a_test_may_check_devices(inside, pytester):
    """A marker names a file next to the test."""
    devices.write(pytester.path / "a.json")
    limits = 'further="at most 0", same_percent="at least 99.9"'
    marked = f'@pytest.mark.normalbench(table="devices", devices="a.json", {limits})\ndef test_it(): pass\n'
    inside(test_it=f"import pytest\n{marked}").assert_outcomes(passed=1)


def test_jax_rows_are_checked_and_others_skipped_without_an_opengl_driver(pytester, monkeypatch):
    for name, value in NO_GL.items():
        monkeypatch.setenv(name, value)
    pytester.makepyfile(BOTH)
    result = pytester.runpytest_subprocess("-rs", *PLAIN)
    result.assert_outcomes(passed=1, failed=1, skipped=3)
    result.stdout.fnmatch_lines(["*test_jax_breaks_it*", "SKIPPED*no OpenGL 4.3 device: *apt-get install libegl1*"])


@pytest.mark.usefixtures("loaded")
def test_two_workers_measure_and_write_one_baseline(pytester):
    """The file has the rows of both workers; the process that started them writes it once."""
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
    assert [entry["key"]["seed"] for entry in entries] == [0, 1, 2, 3]
    for name in ("test_0", "test_1", "test_2", "test_3"):
        path = pytester.path / f"{name}.py"
        path.write_text(path.read_text().replace(", worker_id", "").replace("Path(worker_id)", "Path('alone')"))
    pytester.runpytest_inprocess(*PLAIN, *BASELINE).assert_outcomes(passed=4)
