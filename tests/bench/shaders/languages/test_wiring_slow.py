"""Functions that take or return more than a normal and its code."""

import json

import pytest
from test_wiring import FORMS, MATERIAL

# The mean angle in bytes on the sphere of what each file does, in degrees: the catalogue's xyz_renormalised, xy with a
# side, octahedral, and the three times ten bits that one packs itself.
MEANS = {
    "vec4.hlsl": 0.1696,
    "rough.hlsl": 0.1696,
    "rough.glsl": 0.1696,
    "out.hlsl": 0.4673,
    "sign_in_w.hlsl": 0.4673,
    "material.hlsl": 0.3354,
    f"material.hlsl:{MATERIAL}": 0.3354,
    "uint_out.hlsl": 0.0423,
}


@pytest.mark.usefixtures("gl", "slang")
def test_roughness_structures_and_out_parameters_are_bound(run):
    """The files are unchanged; bindings are found by types and names, tried and reported."""
    words = ("--storage", "rgba8", "--normals", "sphere", "--count", "65536", "--backend", "glsl", "--format", "json")
    status, out, err = run("quality", "--encoding", ",".join(str(FORMS / name) for name in MEANS), *words)
    assert status == 0, err
    means = sorted(row["angle_mean_deg"] for row in json.loads(out))
    assert means == pytest.approx(sorted(MEANS.values()), abs=0.0005)
    assert "measured: EncodeNormal(n=n)->(n.xy; face):DecodeNormal(n.xy=e.xy; face=e.z)->n" in err
    assert "EncodeGBuffer(worldNormal=n; worldPos=view; depth=0.5)->xyw:DecodeGBuffer(gb.xyw=e)->worldNormal" in err
