"""Depth packed into bytes, as in RGBA8: diagnoses and errors."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("gl", "slang")

# Digits in powers of 255, as a byte goes from 0 to 255 (A. Pranckevicius, Encoding floats to RGBA, 2009).
RIGHT = """
vec4 packDepth(float depth) {
    vec4 e = fract(depth * vec4(1.0, 255.0, 65025.0, 16581375.0));
    return e - e.yzww * vec4(vec3(1.0 / 255.0), 0.0);
}
float unpackDepth(vec4 e) { return dot(e, vec4(1.0, 1.0 / 255.0, 1.0 / 65025.0, 1.0 / 16581375.0)); }
"""
OF_256 = RIGHT.replace("255.0", "256.0").replace("65025.0", "65536.0").replace("16581375.0", "16777216.0")
THREE = """
vec3 PackDepth(float d) { vec3 e = fract(d * vec3(1.0, 255.0, 65025.0)); return e - vec3(e.yz / 255.0, 0.0); }
float UnpackDepth(vec3 e) { return dot(e, vec3(1.0, 1.0 / 255.0, 1.0 / 65025.0)); }
"""
LOST = """
vec2 packDepth(float d) { vec2 e = fract(d * vec2(256.0, 65536.0)); e.x -= e.y / 256.0; return e; }
float unpackDepth(vec2 e) { return dot(e, vec2(1.0 / 256.0, 1.0 / 65536.0)); }
"""


def doctor(run, tmp_path, text: str) -> list[str]:
    path = tmp_path / "depth.glsl"
    path.write_text(text)
    _, out, _ = run("doctor", str(path), "--format", "json")
    return [row["finding"] for row in json.loads(out) if row["kind"] == "finding"]


@pytest.mark.parametrize("text", [RIGHT, THREE])
def test_powers_of_255_have_no_findings(run, tmp_path, text):
    assert not doctor(run, tmp_path, text)


def test_component_that_is_not_a_whole_byte_is_reported(run, tmp_path):
    """A first digit in 256 steps is off by half of 1/255 in a byte with 255 steps: 32897 steps of 2^-24."""
    (finding,) = doctor(run, tmp_path, OF_256)
    assert "component 1 of the code alone by 32897, because it is not a multiple of 1/255" in finding


def test_a_missing_digit_is_reported(run, tmp_path):
    findings = doctor(run, tmp_path, LOST)
    message = "depths that differ by 1/256 share a code: the code's most significant byte is missing"
    assert any(message in finding for finding in findings)


def test_packed_bytes_are_measured_on_linear_window_and_reversed_depth(run, tmp_path):
    """Linear depth is off by half a step of the last digit, which is below the float32 step; the other depths match a
    depth buffer with the same number of bits."""
    path = tmp_path / "depth.glsl"
    path.write_text(THREE)
    words = ("--depth", f"{path},window", "--storage", "depth24", "--count", "4096", "--backend", "glsl")
    status, _, err = run("depth", *words)
    assert status == 2 and "it packs its own bytes; leave out --storage" in err
    words = ("--depth", str(path), "--distance", "10", "--count", "4096", "--backend", "glsl", "--format", "json")
    _, out, _ = run("depth", *words)
    rows = {(row["depth"], row["rebuilt"]): row for row in json.loads(out) if row["distance"] == 10}
    assert {depth for depth, _ in rows} == {"linear", "window", "reversed_window"}
    assert all(row["storage"] == "depth.glsl" and row["bits"] == 24 for row in rows.values())
    # Half of the last digit's step, 1 / (255 x 65025), of a far plane at 1000, and the rays' length of up to 1.55.
    assert 1000 / (2 * 255 * 65025) * 0.5 < rows["linear", "eye_ray"]["error_max"] < 1000 / (2 * 255 * 65025) * 4
