"""Storages defined by their bits: catalogue names if they match, ranges, and impossible storages."""

import json


def test_centred_numbers_can_be_measured_but_not_used_in_a_layout(run):
    """Axes are exact in both languages, as in SNORM but in a UNORM target. A layout reports the limitation."""
    words = ("--encoding", "octahedral", "--storage", "centred:8:8", "--format", "json")
    status, out, err = run("quality", *words, "--normals", "axes")
    assert status == 0 and {row["backend"] for row in json.loads(out)} == {"jax", "glsl"}, err
    assert all(row["angle_max_deg"] < 1e-4 and row["storage"] == "rg8_centred" for row in json.loads(out))
    status, _, err = run("render", "--scene", "gloss", *words)
    assert status == 2 and err == "normalbench: layout fp32: RG8 centred: a layout cannot store centred numbers\n"
