"""`normalbench check`: gates that pass or fail, and messages about errors in gates."""

import json
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from normalbench.bench.door.gates.gates import checked, read_gates
from normalbench.bench.ground.output.errors import MissingError, UsageError


def test_the_error_about_an_unmeasured_figure_names_its_option(run, tmp_path):
    path, folder = tmp_path / "gates.toml", str(tmp_path / "results")
    words = ("--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax")
    assert run("run", "--tables", "quality", *words, "-o", folder)[0] == 0
    path.write_text('[[gate]]\nencoding = "xy"\nangle_sup_deg = "at most 90"\n')
    status, out, err = run("check", str(path), "--run", folder)
    assert (status, out) == (2, "") and f"{folder} has no angle_sup_deg; measure the run with --worst-case" in err


@pytest.mark.usefixtures("gl")
def test_a_layout_without_a_codec_is_measured_unchanged(run, tmp_path):
    """The default codec of gates does not replace the layout's own."""
    path = tmp_path / "gates.toml"
    path.write_text(
        '[[gate]]\ntable = "render"\nlayout = "cryengine3"\nsize = "64x48"\nlights = 4\npsnr_db = "at least 1"\n'
    )
    (row,) = json.loads(run("check", str(path), "--format", "json")[1])
    assert row["row"].startswith("hybrid cryengine3 best_fit rgba8 nearest"), row


LIMITS = st.sampled_from(["at least 1", "at most nan"])


VALUES = st.one_of(st.text(max_size=8), st.integers(), st.floats(), st.booleans(), LIMITS)


NAMES = st.sampled_from(["encoding", "storage", "table", "count", "seed", "psnr_db", "x", "normals"])


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.one_of(st.text(max_size=200), st.lists(st.dictionaries(NAMES, VALUES, max_size=5), max_size=3)))
def test_no_gate_causes_a_traceback(tmp_path_factory, content):
    """Any text, and gates with any values, are measured or refused."""
    path = tmp_path_factory.mktemp("gates") / "gates.toml"
    if not isinstance(content, str):
        lines = (f"{name} = {json.dumps(value)}" for gate in content for name, value in [("", None), *gate.items()])
        content = "\n".join("[[gate]]" if line.startswith(" = ") else line for line in lines)
    path.write_text(content, encoding="utf-8", errors="surrogatepass")
    try:
        gates = [gate for gate in read_gates(path) if gate.options.get("count", 10**9) in range(1, 1000)]
        list(checked(gates, None, lambda _: None))
    except (UsageError, MissingError) as error:
        assert "\n" not in str(error) or "gates" in str(error)


def test_paths_in_a_gate_are_relative_to_the_gate_file(run, tmp_path, monkeypatch):
    """The shell's folder does not matter; a file that exists only there is a one-line error."""
    folder, shell = tmp_path / "gates", tmp_path / "shell"
    folder.mkdir()
    shell.mkdir()
    monkeypatch.chdir(shell)
    np.save(folder / "bumps.npy", np.eye(3))
    path, asked = folder / "gates.toml", '[[gate]]\nencoding = "xyz"\nnormals = "bumps.npy"\npsnr_db = "at least 1"\n'
    path.write_text(asked + 'matches_baseline = "kept.json"\n')
    assert run("check", str(path), "--write-baseline")[0] == 0
    monkeypatch.chdir(tmp_path)
    assert run("check", "gates/gates.toml")[0] == 0, "its baseline does not depend on the shell's folder"
    monkeypatch.chdir(shell)
    (folder / "bumps.npy").rename(shell / "bumps.npy")
    path.write_text(asked)
    status, out, err = run("check", str(path))
    message = "gate 1: normals: bumps.npy is in the current folder, but paths are relative to the gates file; write "
    assert (status, out, err.count("\n")) == (2, "", 1) and message + os.path.relpath("bumps.npy", folder) in err, err


def test_a_gate_on_a_distance_judges_only_that_distance(run, tmp_path):
    """The whole range, which has another error, is measured too."""
    path = tmp_path / "gates.toml"
    asked = 'table = "depth"\ndepth = "linear"\nstorage = "r32f"\nbackend = "jax"\ncount = 16\ndistance = "10"\n'
    path.write_text(f'[[gate]]\n{asked}error_max = "at most 1"\n')
    rows = json.loads(run("check", str(path), "--format", "json")[1])
    assert [row["row"].split() for row in rows] == [
        ["linear", "r32f", "nearest", "eye_ray", "jax", "0.1", "1000.0", "10.0"]
    ]


@pytest.mark.parametrize(
    "encoding, said",
    [("xyz,octahedral", "xyz/rg8: 3 components, but RG8 has 2 channels"), ("{}/broken.glsl,octahedral", "broken.glsl")],
)
def test_a_gate_fails_if_a_requested_row_is_missing(run, tmp_path, encoding, said):
    """An encoding that does not fit or compile is an error, although the other encoding would pass."""
    (tmp_path / "broken.glsl").write_text("vec2 broken_encode(vec3 n, vec3 view) { return n.xyz; }")
    path = tmp_path / "gates.toml"
    words = f'encoding = "{encoding.format(tmp_path)}"\nstorage = "rg8"\nnormals = "sphere"\ncount = 1000\n'
    path.write_text(f'[[gate]]\n{words}psnr_db = "at least 1"\n')
    status, out, err = run("check", str(path))
    assert (status, out) == (2, "") and "a requested row cannot be measured" in err and said in err
    path.write_text(path.read_text().replace(encoding.format(tmp_path), "all"))
    assert run("check", str(path))[0] == 0, "of all encodings some never fit"


@pytest.mark.usefixtures("gl")
def test_a_gate_may_judge_an_image(run, tmp_path):
    path = tmp_path / "gates.toml"
    path.write_text('[[gate]]\ntable = "render"\nsize = "64x48"\nlights = 4\npsnr_db = "at least 20"\n')
    status, out, _ = run("check", str(path), "--format", "json")
    assert status == 0 and json.loads(out)[0]["table"] == "render"
    path.write_text(path.read_text().replace("at least 20", "at least 99") + 'flip = "at most 0.5"\n')
    status, out, _ = run("check", str(path), "--format", "json")
    psnr, flip = json.loads(out)
    assert status == 1 and "decodes to" in psnr["worst_normal"] and flip["holds"] == "pass" and flip["figure"] > 0


TABLES_GATED = {
    "cost": 'encoding = "octahedral"\noperation = "encode"\ninstructions = "at most {}"',
    "lights": 'light_buffer = "rgbm"\nexperiment = "random"\ncounts = "8"\nmodel_max = "at most {}"',
    "depth": 'depth = "linear"\nstorage = "packed16"\nerror_max = "at most {}"',
    "frames": 'encoding = "qtangent"\nstorage = "rgba8"\ncount = 4096\nrotation_max_deg = "at most {}"',
    "vectors": 'encoding = "sqrt"\nstorage = "rg8"\ncount = 256\nspeed = 1\nerror_max_px = "at most {}"',
    "pick": 'encoding = "octahedral"\nstorage = "rg8"\ncount = 4096\nangle_max_deg = "at most {}"',
    "quality": 'encoding = "octahedral"\narithmetic = "half"\ncount = 4096\nangle_max_deg = "at most {}"',
    "mix": 'encoding = "octahedral"\nstorage = "rg8"\ncount = 4096\nangle_max_deg = "at most {}"',
    "tune": 'encoding = "stereographic"\nnormals = "hemisphere"\ncount = 4096\ntuned = "at most {}"',
}


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("table", TABLES_GATED)
def test_a_gate_may_judge_any_table(run, tmp_path, table):
    path = tmp_path / "gates.toml"
    for most, status, holds in ((1e6, 0, "pass"), (1e-9, 1, "FAIL")):
        path.write_text(f'[[gate]]\ntable = "{table}"\n{TABLES_GATED[table].format(most)}\n')
        exit_status, out, err = run("check", str(path), "--format", "json")
        assert exit_status == status and {row["table"] for row in json.loads(out)} == {table}, err
        assert holds in {row["holds"] for row in json.loads(out)}


MINE = """
vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }
vec3 mine_decode(vec2 e, vec3 view) { return DECODED; }
"""


PLAIN = "vec3(e, sqrt(max(1.0 - dot(e, e), 0.0)))"


def golden_gate(tmp_path, decoded: str) -> str:
    """Write a gate that compares the cost of an encoder's decode with a baseline; return the gate's path."""
    (tmp_path / "mine.glsl").write_text(MINE.replace("DECODED", decoded))
    path = tmp_path / "gates.toml"
    asked = f'encoding = "{tmp_path}/mine.glsl"\nfamily = "navi21"\noperation = "decode"\nstage = "fragment"\n'
    path.write_text(f'[[gate]]\ntable = "cost"\n{asked}storage = "rgba8"\nmatches_baseline = "kept/costs.json"\n')
    return str(path)


@pytest.mark.usefixtures("radv")
def test_a_gate_on_decoding_does_not_judge_unpacking(run, tmp_path):
    (row,) = json.loads(run("check", golden_gate(tmp_path, PLAIN), "--write-baseline", "--format", "json")[1])
    assert row["row"] == "isa mine decode fragment navi21"


@pytest.mark.usefixtures("radv")
def test_a_cost_increase_is_shown_with_the_added_instructions(run, tmp_path):
    gates = golden_gate(tmp_path, PLAIN)
    assert run("check", gates, "--write-baseline")[0] == 0
    status, out, _ = run("check", gates, "--format", "json")
    assert status == 0 and {row["holds"] for row in json.loads(out)} == {"pass"}
    status, out, err = run("check", golden_gate(tmp_path, f"normalize({PLAIN})"), "--format", "json")
    (row,) = [row for row in json.loads(out) if row["holds"] == "FAIL"]
    assert status == 1 and "instructions is 10, but 4 in the baseline (+6)" in row["changed"]
    added = [line.split() for line in row["changed"].splitlines() if line.startswith(("  +", "  -"))]
    names = [f"{sign} {name}" for sign, name, *_ in added]
    # Two multiply-adds make the squared length, then its reciprocal root scales three components.
    assert names == ["+ v_fmac_f32_e32", "+ v_fmac_f32_e32", "+ v_rsq_f32_e32", *["+ v_mul_f32_e32"] * 3]
    assert "\n  + v_rsq_f32_e32" in err and err.count("+ v_mul_f32_e32") == 3


@pytest.mark.usefixtures("radv")
def test_costs_from_different_compilers_are_kept_separately_and_not_compared(run, tmp_path):
    gates, kept = golden_gate(tmp_path, PLAIN), tmp_path / "kept" / "costs.json"
    status, _, err = run("check", gates)
    assert status == 1 and err.count("\n") == 3, err
    assert "costs.json has no row isa mine decode fragment navi21; run normalbench check --write-baseline" in err
    run("check", gates, "--write-baseline")
    entries = json.loads(kept.read_text())
    mesa = entries[0]["key"]["driver"]
    kept.write_text(kept.read_text().replace(mesa, "Mesa 0.0.1"))
    status, _, err = run("check", gates)
    assert status == 1 and f"for {mesa}, only for Mesa 0.0.1" in err
    run("check", gates, "--write-baseline")
    assert len(json.loads(kept.read_text())) == 2 * len(entries) and run("check", gates)[0] == 0
