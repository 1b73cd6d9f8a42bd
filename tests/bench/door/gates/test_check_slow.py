"""`normalbench check`: gates that pass, fail, and say what is wrong with them."""

import json

import pytest


@pytest.mark.parametrize(
    "encoding, said",
    [("xyz,octahedral", "xyz/rg8: 3 components, but RG8 has 2 channels"), ("{}/broken.glsl,octahedral", "broken.glsl")],
)
def test_a_gate_does_not_pass_without_a_row_that_it_names(run, tmp_path, encoding, said):
    """One that does not fit or compile next to one that does: the others would pass for it."""
    (tmp_path / "broken.glsl").write_text("vec2 broken_encode(vec3 n, vec3 view) { return n.xyz; }")
    path = tmp_path / "gates.toml"
    words = f'encoding = "{encoding.format(tmp_path)}"\nstorage = "rg8"\nnormals = "sphere"\ncount = 1000\n'
    path.write_text(f'[[gate]]\n{words}psnr_db = "at least 1"\n')
    status, out, err = run("check", str(path))
    assert (status, out) == (2, "") and "a row that is asked for cannot be measured" in err and said in err
    path.write_text(path.read_text().replace(encoding.format(tmp_path), "all"))
    assert run("check", str(path))[0] == 0, "of all encodings some never fit"


@pytest.mark.usefixtures("gl")
def test_an_image_may_be_a_gate(run, tmp_path):
    path = tmp_path / "gates.toml"
    path.write_text('[[gate]]\ntable = "render"\nsize = "64x48"\nlights = 4\npsnr_db = "at least 20"\n')
    status, out, _ = run("check", str(path), "--format", "json")
    assert status == 0 and json.loads(out)[0]["table"] == "render"
    path.write_text(path.read_text().replace("at least 20", "at least 99") + 'flip = "at most 0.5"\n')
    status, out, _ = run("check", str(path), "--format", "json")
    psnr, flip = json.loads(out)
    assert status == 1 and "comes back as" in psnr["worst_normal"] and flip["holds"] == "pass" and flip["figure"] > 0


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
def test_every_table_may_be_a_gate(run, tmp_path, table):
    path = tmp_path / "gates.toml"
    for most, status, holds in ((1e6, 0, "pass"), (1e-9, 1, "FAIL")):
        path.write_text(f'[[gate]]\ntable = "{table}"\n{TABLES_GATED[table].format(most)}\n')
        found, out, err = run("check", str(path), "--format", "json")
        assert found == status and {row["table"] for row in json.loads(out)} == {table}, err
        assert holds in {row["holds"] for row in json.loads(out)}


MINE = """
vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }
vec3 mine_decode(vec2 e, vec3 view) { return DECODED; }
"""


PLAIN = "vec3(e, sqrt(max(1.0 - dot(e, e), 0.0)))"


def golden_gate(tmp_path, decoded: str) -> str:
    """A gate that compares what an encoder's decode costs with a file; the encoder's decode as given."""
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
def test_a_cost_that_grew_is_shown_with_the_instructions_that_came_to_it(run, tmp_path):
    gates = golden_gate(tmp_path, PLAIN)
    assert run("check", gates, "--write-baseline")[0] == 0
    status, out, _ = run("check", gates, "--format", "json")
    assert status == 0 and {row["holds"] for row in json.loads(out)} == {"pass"}
    status, out, err = run("check", golden_gate(tmp_path, f"normalize({PLAIN})"), "--format", "json")
    (row,) = [row for row in json.loads(out) if row["holds"] == "FAIL"]
    assert status == 1 and "instructions is 10, the baseline says 4 (+6)" in row["changed"]
    added = [line.split() for line in row["changed"].splitlines() if line.startswith(("  +", "  -"))]
    names = [f"{sign} {name}" for sign, name, *_ in added]
    # Two multiply-adds make the squared length, then its reciprocal root scales three components.
    assert names == ["+ v_fmac_f32_e32", "+ v_fmac_f32_e32", "+ v_rsq_f32_e32", *["+ v_mul_f32_e32"] * 3]
    assert "\n  + v_rsq_f32_e32" in err and err.count("+ v_mul_f32_e32") == 3


@pytest.mark.usefixtures("radv")
def test_costs_by_another_compiler_are_not_compared_and_both_are_kept(run, tmp_path):
    gates, kept = golden_gate(tmp_path, PLAIN), tmp_path / "kept" / "costs.json"
    status, _, err = run("check", gates)
    assert status == 1 and err.count("\n") == 3, err
    assert "costs.json has no row isa mine decode fragment navi21; normalbench check --write-baseline" in err
    run("check", gates, "--write-baseline")
    entries = json.loads(kept.read_text())
    mesa = entries[0]["key"]["driver"]
    kept.write_text(kept.read_text().replace(mesa, "Mesa 0.0.1"))
    status, _, err = run("check", gates)
    assert status == 1 and f"by {mesa}; it has one by Mesa 0.0.1" in err
    run("check", gates, "--write-baseline")
    assert len(json.loads(kept.read_text())) == 2 * len(entries) and run("check", gates)[0] == 0
