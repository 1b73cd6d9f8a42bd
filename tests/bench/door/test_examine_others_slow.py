"""`doctor` of users' codes of something else than normals: what they are of, what is wrong, and what measures them."""

import json

import pytest
from manual import ROOT

pytestmark = pytest.mark.usefixtures("gl", "slang")
INPUTS = ROOT / "tests" / "inputs" / "own_codes"
MEASURED = {
    "velocity.slang": ("motion vectors", "normalbench vectors --encoding {}", "a motion of 0 comes back exactly"),
    "depth.wgsl": ("depth", "normalbench depth --depth {}", "its components range from 0 to 1"),
    "roughness.hlsl": ("roughness and the like", "normalbench curves --encoding {}", "it declares 16-bit numbers"),
    "light.frag": ("light", "normalbench lights --light-buffer {}", "before any storage"),
    "frame.glsl": ("tangent frames", "normalbench frames --encoding {}", "its codes are in [0, 1]"),
}


# Two kinds by day, the others at night.
BY_DAY = ("velocity.slang", "light.frag")


@pytest.mark.parametrize("name", BY_DAY)
def test_a_code_is_told_what_it_is_of_and_what_measures_it(run, name):
    of, command, note = MEASURED[name]
    status, out, err = run("doctor", str(INPUTS / name), "--format", "json")
    assert status == 0 and not err
    found = json.loads(out)
    assert [row["finding"] for row in found if row["kind"] == "verdict"] == ["No problems found."]
    assert {row["domain"] for row in found} == {of}
    notes = [row["finding"] for row in found if row["kind"] == "note"]
    assert f"`{command.format(INPUTS / name)}` measures it" in notes
    assert any(note in one for one in notes), notes


PAIR = "float2 DecodeVelocity(float2 e) { return e; }"
# A finding of status 1, or an error of status 2.
WRONG = {
    "float2 EncodeVelocity(float2 v) { return normalize(v); }" + PAIR: (1, "encode gives no number of (0, 0)"),
    "float2 EncodeVelocity(float2 v) { while (v.x < 9) v.x = min(v.x, 5); return v; }" + PAIR: (1, "do not end here"),
    "float2 EncodeVelocity(float2 v) { return 2 * v; }" + PAIR: (1, "do not undo each other"),
    "float2 EncodeVelocity(float2 v, float range) { return 2 * v; }"
    "float2 DecodeVelocity(float2 e, float range) { return e / 2; }": (1, "component 1 of the code leaves [-1, 1]"),
    "float2 EncodeVelocity(float2 v) { return v; }": (2, "EncodeVelocity has no decoder"),
    "float2 EncodeVelocity(float2 v) { return v * q; }" + PAIR: (2, "1:46: undefined identifier 'q'"),
    "float3 A(float3 v) { return v; }": (2, "no encoder and decoder found; the two functions must be float2"),
}


@pytest.mark.parametrize("text", [*WRONG][::3])
def test_what_is_wrong_is_told(run, tmp_path, text):
    status, said = WRONG[text]
    (tmp_path / "mine.hlsl").write_text(text)
    found, out, err = run("doctor", str(tmp_path / "mine.hlsl"), "--format", "json")
    assert found == status
    if status == 2:
        assert err.count("\n") == 1 and said in err
    else:
        assert any(said in row["finding"] and row["kind"] == "finding" for row in json.loads(out)), out


@pytest.mark.parametrize("words", [("--storage", "rg8"), ("--domain", "sphere"), ("--plot", "sphere.png")])
def test_what_is_asked_of_normals_is_refused(run, tmp_path, words):
    words = [str(tmp_path / word) if word.endswith(".png") else word for word in words]
    status, _, err = run("doctor", str(INPUTS / "velocity.hlsl"), *words)
    assert status == 2 and f"{words[0]} requires normals; this file is of motion vectors" in err
