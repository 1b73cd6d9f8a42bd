"""Findings on pairs in the forms that engines use: which function is wrong, and what is missing between the two."""

import json
import re
from itertools import product

import pytest
from manual import ROOT
from mistakes import CUT_OFF
from typed import first_look

pytestmark = pytest.mark.usefixtures("gl", "slang")


FORMS = ROOT / "tests" / "inputs" / "encoders"


# The begin of what is said, and what else stands in that line.
SAID = {
    "888.hlsl": (CUT_OFF, ""),
    "uint_only.hlsl": (CUT_OFF, ""),
    "float.hlsl": (CUT_OFF, ""),
    "uint.hlsl:PackDir32:UnpackDir32": (CUT_OFF, ""),
    "no_fold.hlsl": (
        "encode is octahedral, but its fold is missing: directions with z < 0 are lost",
        "(0, 0, -1) becomes (0, 0, 1)",
    ),
    "no_unfold.hlsl": ("decode is octahedral, but its unfold is missing: directions with z < 0 are lost", ""),
    "sign_unread.hlsl": (
        "decode does not read component 3 of the code, although encode writes it; decode loses directions with z < 0",
        "encode gives them codes of their own",
    ),
    "other_range.hlsl": ("encode and decode are not a pair", "c * 0.5 + 0.5 between the two makes them a pair"),
}


@pytest.mark.parametrize("name", SAID)
def test_error_in_a_pair_is_reported(name):
    begin, also = SAID[name]
    (line,) = first_look(FORMS / name)["wrong"]
    assert line.startswith(begin) and also in line, line


def test_doctor_exits_with_status_1_and_names_the_faulty_function(run):
    status, out, _ = run("doctor", str(FORMS / "no_unfold.hlsl"), "--format", "json")
    assert status == 1 and json.loads(out)[0]["finding"].startswith("decode is octahedral, but its unfold is missing")


def test_octahedral_in_three_bytes_is_measured_as_written(run):
    """A float64 reference of truncated 12:12 has mean 0.0418 and maximum 0.117 degrees; rounding halves both."""
    asked = ("--normals", "sphere", "--storage", "rgba8", "--backend", "glsl", "--count", "65536", "--format", "json")
    status, out, err = run("quality", "--encoding", str(FORMS / "888.hlsl"), *asked)
    (row,) = json.loads(out)
    assert status == 0 and CUT_OFF in err
    assert row["angle_mean_deg"] == pytest.approx(0.0418, rel=0.01)
    assert 0.1 < row["angle_max_deg"] < 0.1176


ALONE = {
    "decoder.hlsl": "UnpackDir has no encoder; .*; UnpackDir matches the decoder of xy",
    "enc.hlsl": "PackDir has no decoder; .*; PackDir matches the encoder of xy",
    "octahedral.glsl": "dir_decode has no encoder; .*; dir_decode matches the decoder of octahedral",
    "other.hlsl": "DecodeDir has no encoder; .*; DecodeDir matches the decoder of no encoding in the catalogue",
}


# In [0, 1], and with y up.
OCTAHEDRAL = """vec3 dir_decode(vec2 e) {
    e = e * 2.0 - 1.0;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -t : t;
    n.y += n.y >= 0.0 ? -t : t;
    return normalize(n.xzy);
}
"""


OTHER = "float3 DecodeDir(float2 e) { return normalize(float3(sin(3.0 * e.x), cos(5.0 * e.y), e.x * e.y)); }\n"


# Of a file that is no pair of normals doctor looks for one of each other kind, in a process each: one file by it, the
# others at night.
BY_DOCTOR = ("octahedral.glsl",)


@pytest.mark.parametrize("command, name", [*product(["quality"], ALONE), *product(["doctor"], BY_DOCTOR)])
def test_single_function_is_identified(run, tmp_path, command, name):
    (tmp_path / "octahedral.glsl").write_text(OCTAHEDRAL)
    (tmp_path / "other.hlsl").write_text(OTHER)
    path = (FORMS if name in ("decoder.hlsl", "enc.hlsl") else tmp_path) / name
    status, _, err = run(*((command, str(path)) if command == "doctor" else (command, "--encoding", str(path))))
    assert status == 2 and re.search(ALONE[name], err), err


@pytest.mark.parametrize(
    "name, said, table", [("frame.hlsl", "tangent frames", "frames"), ("motion.hlsl", "motion vectors", "vectors")]
)
def test_encodings_of_other_quantities_are_identified(name, said, table):
    path = FORMS / name
    assert (
        f"is of {said}, not of normals: `normalbench {table} --encoding {path}` measures it"
        in first_look(path)["error"]
    )
