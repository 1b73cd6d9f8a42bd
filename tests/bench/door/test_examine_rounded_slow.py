"""`doctor` on rounded codes: results that are not numbers, unused signs and mismatched steps."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("gl")

# z by a root: exact codes are fine, and rounded ones of the rim are not (github.com/godotengine/godot/issues/19994).
ROOT = """
vec2 rim_encode(vec3 n, vec3 view) { return n.xy; }
vec3 rim_decode(vec2 p, vec3 view) { return vec3(p, sqrt(1.0 - dot(p, p))); }
"""
UNIT = """
vec2 mine_encode(vec3 n, vec3 view) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return 0.5 + 0.5 * p;
}
vec3 mine_decode(vec2 c, vec3 view) {
    vec2 e = c * 2.0 - 1.0;
    float z = 1.0 - abs(e.x) - abs(e.y), t = max(-z, 0.0);
    return normalize(vec3(e.x + (e.x < 0.0 ? t : -t), e.y + (e.y < 0.0 ? t : -t), z));
}
"""
# One angle in ENCODE steps a turn and out by DECODE, the other in 255 both ways (the form of Daemon's bug 291).
ANGLES = """
const float TURN = 6.28318530718;
uint packed(vec3 n) {
    float around = atan(n.y, n.x), down = acos(clamp(n.z, -1.0, 1.0));
    around = around < 0.0 ? around + TURN : around;
    return (uint(down * 255.0 / TURN + 0.5) & 255u) | ((uint(around * ENCODE / TURN + 0.5) & 255u) << 8);
}
vec3 unpacked(uint c) {
    float down = float(c & 255u) * TURN / 255.0, around = float(c >> 8 & 255u) * TURN / DECODE;
    return vec3(vec2(cos(around), sin(around)) * sin(down), cos(down));
}
"""


def findings(run, tmp_path, text: str, *words: str) -> list[str]:
    (tmp_path / "mine.glsl").write_text(text)
    _, out, err = run("doctor", str(tmp_path / "mine.glsl"), *words, "--format", "json")
    assert out, err
    return [row["finding"] for row in json.loads(out) if row["kind"] == "finding"]


def test_rounded_codes_that_decode_to_nan_are_counted(run, tmp_path):
    (finding,) = findings(run, tmp_path, ROOT, "--storage", "rg8")
    assert "of 65536 rounded codes (3.3%) decode to NaN or infinity" in finding, finding
    assert findings(run, tmp_path, ROOT.replace("sqrt(1.0 - dot(p, p))", "sqrt(max(0.0, 1.0 - dot(p, p)))")) == []


def test_an_unused_sign_of_a_signed_storage_is_reported(run, tmp_path):
    (finding,) = findings(run, tmp_path, UNIT, "--storage", "rg8_snorm")
    assert "this is octahedral, but 100% worse" in finding and "use only half of the range" in finding, finding
    assert findings(run, tmp_path, UNIT, "--storage", "rg8") == []


@pytest.mark.parametrize(("encode", "decode"), [(256, 255), (255, 256), (255, 255)])
def test_mismatched_steps_of_an_angle_are_reported(run, tmp_path, encode, decode):
    lines = findings(run, tmp_path, ANGLES.replace("ENCODE", f"{encode}.0").replace("DECODE", f"{decode}.0"))
    expected = f"the angle about z decodes to {encode}/{decode} of its value"
    assert [line[: len(expected)] for line in lines] == ([expected] if encode != decode else []), lines
