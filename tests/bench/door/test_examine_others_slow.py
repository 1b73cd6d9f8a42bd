"""`doctor` on encodings of quantities other than normals: the quantity, errors, and the measuring command."""

import json

import pytest
from manual import ROOT

pytestmark = pytest.mark.usefixtures("gl", "slang")
INPUTS = ROOT / "tests" / "inputs" / "own_codes"
MEASURED = {
    "velocity.slang": ("motion vectors", "normalbench vectors --encoding {}", "a motion of 0 decodes exactly"),
    "depth.wgsl": ("depth", "normalbench depth --depth {}", "its components range from 0 to 1"),
    "roughness.hlsl": ("roughness and the like", "normalbench curves --encoding {}", "it declares 16-bit numbers"),
    "light.frag": ("light", "normalbench lights --light-buffer {}", "before any storage"),
    "frame.glsl": ("tangent frames", "normalbench frames --encoding {}", "its codes are in [0, 1]"),
}


# Two kinds by day, the others at night.
BY_DAY = ("velocity.slang", "light.frag")


@pytest.mark.parametrize("name", BY_DAY)
def test_doctor_names_the_quantity_and_the_command_that_measures_it(run, name):
    of, command, note = MEASURED[name]
    status, out, err = run("doctor", str(INPUTS / name), "--format", "json")
    assert status == 0 and not err
    rows = json.loads(out)
    assert [row["finding"] for row in rows if row["kind"] == "verdict"] == ["No problems found."]
    assert {row["domain"] for row in rows} == {of}
    notes = [row["finding"] for row in rows if row["kind"] == "note"]
    assert f"to measure it, run `{command.format(INPUTS / name)}`" in notes
    assert any(note in finding for finding in notes), notes


PAIR = "float2 DecodeVelocity(float2 e) { return e; }"
# A finding of status 1, or an error of status 2.
WRONG = {
    "float2 EncodeVelocity(float2 v) { return normalize(v); }" + PAIR: (1, "encode returns no number for (0, 0)"),
    "float2 EncodeVelocity(float2 v) { while (v.x < 9) v.x = min(v.x, 5); return v; }" + PAIR: (1, "do not end here"),
    "float2 EncodeVelocity(float2 v) { return 2 * v; }" + PAIR: (1, "do not undo each other"),
    "float2 EncodeVelocity(float2 v, float range) { return 2 * v; }"
    "float2 DecodeVelocity(float2 e, float range) { return e / 2; }": (1, "component 1 of the code leaves [-1, 1]"),
    "float2 EncodeVelocity(float2 v) { return v; }": (2, "EncodeVelocity has no decoder"),
    "float2 EncodeVelocity(float2 v) { return v * q; }" + PAIR: (2, "1:46: undefined identifier 'q'"),
    "float3 A(float3 v) { return v; }": (2, "no encoder and decoder found; the two functions must be float2"),
}


@pytest.mark.parametrize("text", [*WRONG][::3])
def test_doctor_reports_errors(run, tmp_path, text):
    status, message = WRONG[text]
    (tmp_path / "mine.hlsl").write_text(text)
    exit_status, out, err = run("doctor", str(tmp_path / "mine.hlsl"), "--format", "json")
    assert exit_status == status
    if status == 2:
        assert err.count("\n") == 1 and message in err
    else:
        assert any(message in row["finding"] and row["kind"] == "finding" for row in json.loads(out)), out


@pytest.mark.parametrize("words", [("--storage", "rg8"), ("--domain", "sphere"), ("--plot", "sphere.png")])
def test_options_for_normals_are_refused(run, tmp_path, words):
    words = [str(tmp_path / word) if word.endswith(".png") else word for word in words]
    status, _, err = run("doctor", str(INPUTS / "velocity.hlsl"), *words)
    assert status == 2 and f"{words[0]} requires normals; this file encodes motion vectors" in err
