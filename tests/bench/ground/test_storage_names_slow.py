"""Storages by rule: the catalogue's where there is one, ranges, and what cannot be."""

import json


def test_centred_numbers_are_measured_and_not_laid_out(run):
    """In both languages: axes are exact, as in SNORM, and in a UNORM target. What cannot have them says so."""
    words = ("--encoding", "octahedral", "--storage", "centred:8:8", "--format", "json")
    status, out, err = run("quality", *words, "--normals", "axes")
    assert status == 0 and {row["backend"] for row in json.loads(out)} == {"jax", "glsl"}, err
    assert all(row["angle_max_deg"] < 1e-4 and row["storage"] == "rg8_centred" for row in json.loads(out))
    status, _, err = run("render", "--scene", "gloss", *words)
    assert status == 2 and err == "normalbench: layout fp32: RG8 centred: a layout cannot store centred numbers\n"
