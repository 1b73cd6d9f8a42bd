"""`normalbench check`: gates that pass or fail, and messages about errors in gates."""

import json

import pytest

from normalbench.bench.door.gates import listings
from normalbench.bench.door.gates.limits import Limit
from normalbench.bench.door.gates.measured import named_rows
from normalbench.bench.keep.runs import opened
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Step

PASSES = '[[gate]]\nencoding = "spheremap"\nstorage = "rgba8"\nnormals = "playground"\npsnr_db = "at least 47.5"\n'


def test_a_gate_passes_if_its_threshold_holds_and_fails_otherwise(run, tmp_path):
    path = tmp_path / "gates.toml"
    path.write_text(PASSES)
    status, out, err = run("check", str(path), "--format", "json")
    (row,) = json.loads(out)
    assert (status, err) == (0, "") and row["holds"] == "pass" and row["figure"] > 47.5
    path.write_text(PASSES + 'angle_max_deg = "at most 0.95"\n')
    status, out, err = run("check", str(path))
    assert status == 1 and "1 of 2 thresholds failed" in err
    assert "pass" in out.splitlines()[1] and "FAIL" in out.splitlines()[2] and "decodes to" in out
    rows = json.loads(run("check", str(path), "--format", "json")[1])
    off = f"{rows[1]['figure']:.6g} degrees off"
    assert rows[0]["worst_normal"] is None and rows[1]["worst_normal"].endswith(off), rows


@pytest.mark.usefixtures("gl")
def test_a_shader_without_a_twin_is_measured_in_glsl(run, tmp_path):
    (tmp_path / "mine.glsl").write_text(
        "vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }\n"
        "vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }\n"
    )
    path = tmp_path / "gates.toml"
    words = f'encoding = "{tmp_path}/mine.glsl"\nstorage = "rg8"\nnormals = "hemisphere"\ncount = 1000\n'
    path.write_text(f'[[gate]]\n{words}psnr_db = "at least 1"\n')
    status, out, err = run("check", str(path), "--format", "json")
    (row,) = json.loads(out)
    assert (status, row["holds"]) == (0, "pass") and row["row"].endswith("glsl"), err


@pytest.mark.usefixtures("gl")
def test_a_gate_does_not_ignore_a_few_nan_results(run, tmp_path):
    (tmp_path / "hole.glsl").write_text(
        "vec2 hole_encode(vec3 n, vec3 view) { return n.xy; }\n"
        "vec3 hole_decode(vec2 e, vec3 view) {\n"
        "    float z = sqrt(distance(e, vec2(0.61, 0.473)) < 0.004 ? -1.0 : max(1.0 - dot(e, e), 0.0));\n"
        "    return vec3(e, z);\n"
        "}\n"
    )
    path = tmp_path / "gates.toml"
    words = f'encoding = "{tmp_path}/hole.glsl"\nstorage = "rg8"\nnormals = "hemisphere"\ncount = 100000\n'
    path.write_text(f'[[gate]]\n{words}angle_mean_deg = "at most 90"\n')
    status, out, _ = run("check", str(path), "--format", "json")
    rows = [(row["column"], row["limit"], row["holds"]) for row in json.loads(out)]
    assert status == 1
    assert rows == [("angle_mean_deg", "at most 90", "pass"), ("invalid", "at most 0", "FAIL")]
    path.write_text(path.read_text() + 'invalid = "at most 10000"\n')
    assert run("check", str(path))[0] == 0, "it says how many may be"


def test_figures_may_come_from_a_run(run, tmp_path):
    folder, path = tmp_path / "run", tmp_path / "gates.toml"
    rows = [{"depth": name, "distance": 10.0, "error_max": error} for name, error in (("a", 0.5), ("b", float("inf")))]
    with opened(folder, {}) as open_run:
        open_run.keep("depth", Step({}, None, ""), rows)
    gate = '[[gate]]\ntable = "depth"\ndepth = "{}"\ndistance = 10\nerror_max = "at most 0.5"\n'
    path.write_text(gate.format("a") + gate.format("a, b"))
    status, out, _ = run("check", str(path), "--run", str(folder), "--format", "json")
    assert status == 1 and [row["holds"] for row in json.loads(out)] == ["pass", "pass", "FAIL"]


def rendered(encoding: str, db: float) -> dict:
    about = {"encoding": encoding, "storage": "rgba8", "pipeline": "hybrid", "scene": "gloss", "normal_bits": 16}
    return TABLES["render"].empty() | about | {"psnr_db": db, "normal_psnr_db": db, "mse": 1 / db}


def test_a_rank_is_the_place_of_a_row_among_all_rows_of_the_run(run, tmp_path):
    """The rank is the same as in the run's exported files, whichever rows a gate names."""
    folder, path = tmp_path / "run", tmp_path / "gates.toml"
    with opened(folder, {}) as open_run:
        open_run.keep("render", Step({}, None, ""), [rendered("xy", 40.0), rendered("octahedral", 50.0)])
    path.write_text('[[gate]]\ntable = "render"\nencoding = "xy"\nrank = "at most 1"\n')
    status, out, _ = run("check", str(path), "--run", str(folder), "--format", "json")
    assert status == 1 and [row["figure"] for row in json.loads(out)] == [2]


def test_rows_from_another_version_are_not_blamed_on_the_gate(run, tmp_path):
    folder, path = tmp_path / "run", tmp_path / "gates.toml"
    with opened(folder, {}) as open_run:
        open_run.keep("quality", Step({}, None, ""), [{"encoding": "xy", "psnr": 40.0}])
    path.write_text('[[gate]]\nencoding = "xy"\npsnr_db = "at least 1"\n')
    status, _, err = run("check", str(path), "--run", str(folder))
    assert status == 2 and "do not match this version; measure them again: " in err, err


def test_an_identity_that_matches_no_row_of_a_run_is_a_one_line_error(run, tmp_path):
    folder, path = tmp_path / "run", tmp_path / "gates.toml"
    with opened(folder, {}) as open_run:
        rows = [{"depth": "linear", "far": 1.0, "error_max": 1.0}, {"depth": "log", "far": 10.0, "error_max": 1.0}]
        open_run.keep("depth", Step({}, None, ""), rows)
    path.write_text('[[gate]]\ntable = "depth"\ndepht = "linear"\nerror_max = "at most 2"\n')
    status, out, err = run("check", str(path), "--run", str(folder))
    assert (status, out) == (2, "") and err.count("\n") == 1 and "have no 'depht'; their keys are depth" in err, err
    for asked, message in (
        ('depth = "linaer"', "no row of depth in {} has depth 'linaer'; values there: linear, log"),
        ('depth = "linear"\nfar = 10', "combines depth 'linear', far 10"),
    ):
        path.write_text(f'[[gate]]\ntable = "depth"\n{asked}\nerror_max = "at most 2"\n')
        status, out, err = run("check", str(path), "--run", str(folder))
        assert (status, out, err.count("\n")) == (2, "", 1) and message.format(folder) in err, err


def test_thresholds_include_their_value_and_reject_values_that_are_not_numbers():
    least, most = Limit("x", "at least", 2.0), Limit("x", "at most", 2.0)
    assert least.holds(2) and most.holds(2.0) and least.holds(float("inf")) and not most.holds(float("inf"))
    assert not any(limit.holds(figure) for limit in (least, most) for figure in (None, float("nan"), "2"))


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "no [[gate]] table"),
        ("gate = 1", "no [[gate]] table"),
        ("gate = []", "0 gates; a file may have 1 to"),
        ("[[gate]]\n[other]", "unknown key 'other'; a gates file has only [[gate]] tables"),
        ('[[gates]]\nencoding = "xy"', "unknown key 'gates'; a gates file has only [[gate]] tables"),
        ("[[gate]", "this is not TOML"),
        ('[[gate]]\nencoding = "xy"', "no threshold given"),
        ("[[gate]]\npsnr_db = 49", "psnr_db: 49 is not a threshold; write"),
        ("[[gate]]\ncount = " + "9" * 5000, "a number has too many digits"),
        ('[[gate]]\npsnr_db = "at least many"', "gate 1: psnr_db: many is not a number"),
        ('[[gate]]\npsnr_db = "at least nan"', "nan is not a number"),
        ('[[gate]]\nangle_max_deg = "at most 1e999"', "1e999 is not a finite number; write one below 1e308"),
        ('[[gate]]\npsnr_db = "at least 1 2"', "1 2 is not a number"),
        ('[[gate]]\npsnr_db = "at least 1"\nreading = "x"', "unknown option 'reading'"),
        ('[[gate]]\npsnr_db = "at least 1"\nnormalise = 1', "normalise is 1; it must be true or false"),
        ('[[gate]]\npsnr_db = "at least 1.2.3"', "1.2.3 is not a number"),
        ('[[gate]]\npsnr_db = "at least 1"\nencoding = ["xy"]', "encoding is ['xy']; it must be text or a number"),
        ('[[gate]]\npsnr_db = "at least 1"\nseed = true', "seed is True; it must be a whole number"),
        ('[[gate]]\npsnr_db = "at least 1"\nseed = "one"', "seed is 'one'; it must be a whole number"),
        ('[[gate]]\npsnr_db = "at least 1"\ncodec = "xy"', "unknown option 'codec'; known: "),
        ('[[gate]]\npsnr_db = "at least 1"\nencoding = "xyy"', "gate 1: unknown encoding 'xyy'"),
        ('[[gate]]\npsnr = "at least 1"\nencoding = "xy"\ncount = 10', "quality: no column 'psnr'; figures: bits"),
        (
            '[[gate]]\ntable = "depths"\nerror_max = "at most 1"',
            "unknown table 'depths'; did you mean depth? known: pick, budget, quality, render",
        ),
        ('[[gate]]\ntable = 3\nerror_max = "at most 1"', "unknown table 3; known: pick, budget, quality, render"),
        ('[[gate]]\ntable = ["depth"]\nerror_max = "at most 1"', "table is ['depth']; it must be text or a number"),
        ('[[gate]]\ndevice = "at least 3"', "quality: device is not a figure"),
    ],
)
def test_bad_gates_are_a_one_line_error_with_their_position(run, tmp_path, text, said):
    path = tmp_path / "gates.toml"
    path.write_text(text)
    status, out, err = run("check", str(path))
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err and "gates.toml" in err, err


def test_a_missing_file_and_a_folder_that_is_not_a_run_are_one_line_errors(run, tmp_path):
    assert "none.toml: there is no such file" in run("check", str(tmp_path / "none.toml"))[2]
    (tmp_path / "gates.toml").write_text(PASSES)
    status, _, err = run("check", str(tmp_path / "gates.toml"), "--run", str(tmp_path))
    assert status == 2 and "is not a results folder" in err and err.count("\n") == 1


@pytest.mark.parametrize(
    "given, expected",
    [
        # An encoding, its storage's packing and another storage's, as `cost` gives them.
        ({"encoding": "xy", "operation": "decode", "storage": "12:12"}, ["xy decode"]),
        ({"encoding": "xy"}, ["xy encode", "xy decode"]),
        ({"storage": "12:12"}, ["12:12 unpack"]),
        ({"encoding": "xy", "storage": "12:12"}, ["xy encode", "xy decode", "12:12 unpack"]),
        ({"family": "radeon"}, ["xy encode", "xy decode", "12:12 unpack"]),
        ({}, ["xy encode", "xy decode", "12:12 unpack"]),
    ],
)
def test_a_gate_judges_the_rows_that_it_names(given, expected):
    rows = [
        {"encoding": "xy", "storage": None, "operation": "encode", "family": "vega10"},
        {"encoding": "xy", "storage": None, "operation": "decode", "family": "vega10"},
        {"encoding": None, "storage": "12:12", "operation": "unpack", "family": "vega10"},
    ]
    matches = named_rows(TABLES["cost"], given, rows)
    assert [f"{row['encoding'] or row['storage']} {row['operation']}" for row in matches] == expected


@pytest.mark.parametrize(
    "words, said",
    [
        ('matches_baseline = 3\npsnr_db = "at least 3"', "matches_baseline is 3; it must be a file name"),
        ('matches_baseline = "gates.toml"', "gates.toml is not a baseline"),
        ('psnr_db = "at least 3"', 'no gate names a baseline; add matches_baseline = "costs.json" to one'),
    ],
)
def test_an_invalid_baseline_is_a_one_line_error(run, tmp_path, words, said):
    path = tmp_path / "gates.toml"
    path.write_text(f'[[gate]]\nencoding = "xy"\nstorage = "rg8"\nnormals = "axes"\n{words}\n')
    for more in ([], ["--write-baseline"]) if "no gate" not in said else (["--write-baseline"],):
        status, out, err = run("check", str(path), *more)
        # Gates that name themselves are not written over.
        written = "gates.toml: this is an input of the command" if more and "not a baseline" in said else said
        assert (status, out) == (2, "") and written in err


def test_figures_of_any_table_are_compared_with_a_baseline(run, tmp_path):
    path = tmp_path / "gates.toml"
    path.write_text(
        PASSES.replace("psnr_db", "mse").replace("at least 47.5", "at most 1") + 'matches_baseline = "q.json"\n'
    )
    assert run("check", str(path), "--write-baseline")[0] == 0 and run("check", str(path))[0] == 0
    kept = json.loads((tmp_path / "q.json").read_text())
    kept[0]["row"]["psnr_db"] += 1.0
    (tmp_path / "q.json").write_text(json.dumps(kept))
    status, _, err = run("check", str(path))
    measured = kept[0]["row"]["psnr_db"] - 1.0
    assert status == 1 and f"psnr_db is {measured:.2f}"[:-1] in err and "1 of 2 thresholds failed" in err


def test_listings_that_differ_only_in_registers_are_the_same():
    before = ["v_mul_f32 v1, v2, s[2:3]", "mul(16) g2<1>F -g13<8,8,1>F", "s_endpgm"]
    after = ["v_mul_f32 v7, v9, s[4:5]", "mul(16) g18<1>F -g12<8,8,1>F", "v_add_f32 v1, v2, v3", "s_endpgm"]
    assert list(listings.differences(before, after)) == ["+ v_add_f32 v1, v2, v3"]
    assert list(listings.differences(after, before)) == ["- v_add_f32 v1, v2, v3"]
    nvidia = ["        /*{:04x}*/    FMUL R3, R2, R4 ;   /* 0x0000000402037220 */", "   /* 0x000fe20000410000 */"]
    lines = [listings.lines_of("\n".join([nvidia[0].format(pc), nvidia[1], "/*0200*/ NOP;"])) for pc in (16, 48)]
    assert lines == [["FMUL R3, R2, R4"]] * 2
    long = list(listings.differences([], [f"v_op{number}" for number in range(100)]))
    assert len(long) == listings.MOST_LINES + 1 and long[-1] == "... and 60 more lines"
