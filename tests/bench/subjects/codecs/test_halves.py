"""Pairs that return half of the sphere: one function loses the other half, or the pair is designed for one half."""

import json
import re
from dataclasses import replace

import pytest
from typed import encodings_named, first_look

from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.layouts.presets import LAYOUTS

pytestmark = pytest.mark.usefixtures("gl")


FOLD = "vec2 fold(vec2 p) { return (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0); }\n"


NO_FOLD = f"""{FOLD}vec2 dir_encode(vec3 n) {{ n /= abs(n.x) + abs(n.y) + abs(n.z); return n.xy; }}
vec3 dir_decode(vec2 e) {{
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0) n.xy = fold(n.xy);
    return normalize(n);
}}
"""


NO_UNFOLD = f"""{FOLD}vec2 dir_encode(vec3 n) {{
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    return n.z >= 0.0 ? n.xy : fold(n.xy);
}}
vec3 dir_decode(vec2 e) {{ return normalize(vec3(e, 1.0 - abs(e.x) - abs(e.y))); }}
"""


# The third number says the side, and is never read.
SIGN_UNREAD = """vec3 dir_encode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    float y = n.y * 0.5 + 0.5;
    return vec3(n.x * 0.5 + y, y - n.x * 0.5, n.z < 0.0 ? 0.0 : 1.0);
}
vec3 dir_decode(vec3 p) {
    vec3 n = vec3(p.x - p.y, p.x + p.y - 1.0, 0.0);
    n.z = 1.0 - abs(n.x) - abs(n.y);
    return normalize(n);
}
"""


# A decoder of the whole spheremap, whose encoder mirrors: no octahedron, so that the sides alone say who loses it.
MIRRORED = """vec2 dir_encode(vec3 n) { n.z = abs(n.z); return n.xy / sqrt(2.0 * n.z + 2.0); }
vec3 dir_decode(vec2 e) { float f = min(dot(e, e), 1.0); return vec3(2.0 * e * sqrt(1.0 - f), 1.0 - 2.0 * f); }
"""


LOST = {
    "no fold": (NO_FOLD, "encode is octahedral, but its fold is missing: directions with z < 0 are lost"),
    "no unfold": (NO_UNFOLD, "decode is octahedral, but its unfold is missing: directions with z < 0 are lost"),
    "a sign that is not read": (
        SIGN_UNREAD,
        "decode does not read component 3 of the code, although encode writes it",
    ),
    "a mirror": (
        MIRRORED,
        "encode loses directions with z < 0, which come back with z reversed: it gives them",
    ),
}


# Designs for z >= 0, as functions of m, which is n in other axes.
DESIGNS = {
    "xy": ("m.xy", "vec3(e, sqrt(max(0.0, 1.0 - dot(e, e))))"),
    "hemi-octahedral": (
        "vec2(m.x + m.y, m.x - m.y) / (abs(m.x) + abs(m.y) + abs(m.z))",
        "normalize(vec3(e.x + e.y, e.x - e.y, 2.0 - abs(e.x + e.y) - abs(e.x - e.y)))",
    ),
    "a disc of equal areas": (
        "m.xy / sqrt(1.0 + max(m.z, 0.0))",
        "vec3(e * sqrt(max(0.0, 2.0 - dot(e, e))), 1.0 - dot(e, e))",
    ),
    "stereographic": ("m.xy / (1.0 + max(m.z, 0.0))", "vec3(2.0 * e, 1.0 - dot(e, e)) / (1.0 + dot(e, e))"),
    "paraboloid in [0, 1]": (
        "m.xy / (1.0 + abs(m.z)) * 0.5 + 0.5",
        "normalize(vec3(e * 4.0 - 2.0, 4.0 * dot(e, 1.0 - e) - 1.0))",
    ),
}


# The half of each pair of axes and sign, m of n, and n of m.
HALVES = {
    "z >= 0": ("n", "m"),
    "z <= 0": ("vec3(n.xy, -n.z)", "vec3(m.xy, -m.z)"),
    "y >= 0": ("n.zxy", "m.yzx"),
    "y <= 0": ("-n.zxy", "-m.yzx"),
    "x >= 0": ("n.yzx", "m.zxy"),
    "x <= 0": ("-n.yzx", "-m.zxy"),
}


def design(name: str, half: str) -> str:
    encode, decode = DESIGNS[name]
    to, back = HALVES[half]
    return (
        f"vec2 dir_encode(vec3 n) {{ vec3 m = {to}; return {encode}; }}\n"
        f"vec3 dir_decode(vec2 e) {{ vec3 m = {decode}; return {back}; }}\n"
    )


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("what", LOST)
def test_a_lost_half_is_a_finding_that_names_the_faulty_function(run, tmp_path, what):
    text, finding = LOST[what]
    (tmp_path / "dir.glsl").write_text(text)
    status, out, _ = run("doctor", "dir.glsl", "--format", "json")
    rows = json.loads(out)
    assert status == 1 and finding in rows[0]["finding"] and rows[0]["domain"] == "sphere", rows
    status, out, _ = run("doctor", "dir.glsl", "--domain", "hemisphere", "--format", "json")
    assert json.loads(out)[0]["domain"] == "hemisphere" and "directions with" not in out, out
    # The mirrored spheremap leaves the rim of its square unused, whatever it is meant for.
    assert status == (what == "a mirror")


@pytest.mark.parametrize("half", HALVES)
@pytest.mark.parametrize("what", ["no fold", "no unfold"])
def test_a_lost_half_is_found_along_any_axis(tmp_path, what, half):
    """Examples are octahedral maps with y up, in left-handed view space and of -n."""
    to, back = HALVES[half]
    text = LOST[what][0].replace("dir_encode", "own_in").replace("dir_decode", "own_out")
    text += f"vec2 dir_encode(vec3 n) {{ return own_in({to}); }}\n"
    text += f"vec3 dir_decode(vec2 e) {{ vec3 m = own_out(e); return {back}; }}\n"
    (tmp_path / "dir.glsl").write_text(text)
    (finding,) = first_look(tmp_path / "dir.glsl")["wrong"]
    lost = half.replace(">=", "<") if ">=" in half else half.replace("<=", ">")
    side = "encode is octahedral, but its fold" if what == "no fold" else "decode is octahedral, but its unfold"
    assert f"{side} is missing: directions with {lost} are lost" in finding


@pytest.mark.parametrize("half", HALVES)
@pytest.mark.parametrize("what", DESIGNS)
def test_encoding_designed_for_a_hemisphere_is_not_a_finding(tmp_path, what, half):
    (tmp_path / "dir.glsl").write_text(design(what, half))
    look = first_look(tmp_path / "dir.glsl")
    axis, side = look.get("half", (2, 1))
    assert look["wrong"] == [] and look["domain"] == "hemisphere", look
    assert f"{'xyz'[axis]} {'>=' if side > 0 else '<='} 0" == half


def test_a_world_space_layout_keeps_the_axes_of_a_hemisphere_encoding(tmp_path):
    """An encoding for y >= 0 stores normals that face up in world space, or face the viewer in view space."""
    (tmp_path / "dir.glsl").write_text(design("xy", "y >= 0"))
    (encoding,) = encodings_named("dir.glsl")
    layout = replace(LAYOUTS["fp32"].with_codec(Codec(encoding, STORAGES["rg8"])), space="view")
    assert (layout.encoding.axis, layout.encoding.is_turned) == ("x", True)
    assert not replace(layout, space="world").encoding.is_turned


def test_a_domain_that_does_not_round_trip_is_a_finding(run, tmp_path):
    (tmp_path / "dir.glsl").write_text(design("xy", "z >= 0"))
    assert run("doctor", "dir.glsl")[0] == run("doctor", "dir.glsl", "--domain", "hemisphere")[0] == 0
    status, out, _ = run("doctor", "dir.glsl", "--domain", "sphere", "--format", "json")
    assert status == 1 and "directions with z <= 0 come back with z reversed" in out


# Published codes for a half that are not finite at some direction of the other one: encode and decode, as `DESIGNS`.
OPEN = {
    "hemi-octahedral": (
        "vec2(m.x + m.y, m.x - m.y) / (abs(m.x) + abs(m.y) + m.z)",
        "normalize(vec3(e.x + e.y, e.x - e.y, 2.0 - abs(e.x + e.y) - abs(e.x - e.y)))",
    ),
    "hemi-octahedral, guarded by max()": (
        "vec2(m.x + m.y, m.x - m.y) / (abs(m.x) + abs(m.y) + max(m.z, 0.0)) * 0.5 + 0.5",
        "normalize(vec3(e.x + e.y - 1.0, e.x - e.y, 1.0 - abs(e.x + e.y - 1.0) - abs(e.x - e.y)))",
    ),
    "stereographic": (
        "m.xy / (m.z + 1.0) / 1.7777 * 0.5 + 0.5",
        "vec3(2.0 * (e * 2.0 - 1.0) * 1.7777, 2.0) / (1.0 + dot(e * 2.0 - 1.0, e * 2.0 - 1.0) * 3.16020729) "
        "- vec3(0.0, 0.0, 1.0)",
    ),
    "undefined below": ("m.xy * (m.z < 0.0 ? sqrt(m.z) : 1.0)", "vec3(e, sqrt(max(0.0, 1.0 - dot(e, e))))"),
}


def test_encoding_finite_only_on_its_hemisphere_is_measured_there(run, tmp_path, monkeypatch):
    monkeypatch.setitem(DESIGNS, "open", OPEN["hemi-octahedral"])
    (tmp_path / "dir.glsl").write_text(design("open", "z >= 0"))
    words = ("--storage", "rg8", "--normals", "hemisphere", "--count", "4096", "--backend", "glsl")
    status, out, err = run("quality", "--encoding", "dir.glsl,hemi_octahedral", *words, "--format", "json")
    means = [row["angle_mean_deg"] for row in json.loads(out)]
    assert status == 0 and means == pytest.approx([0.239, 0.239], abs=0.005)
    assert "dir.glsl: assumed to be made only for normals with z >= 0: encode of (-0.707, 0, -0.707) is (" in err
    status, out, _ = run("doctor", "dir.glsl", "--domain", "hemisphere", "--format", "json")
    assert status == 0 and "it is meant for normals with z >= 0; elsewhere encode of (-0.707, 0, -0.707)" in out


SPHEREMAP = """vec2 dir_encode(vec3 n) { return n.xy / sqrt(8.0 * n.z + 8.0) + 0.5; }
vec3 dir_decode(vec2 e) {
    vec2 g = e * 4.0 - 2.0;
    float f = dot(g, g);
    return vec3(g * sqrt(max(0.0, 1.0 - f / 4.0)), 1.0 - f / 2.0);
}
"""


def test_a_hole_in_an_encoding_is_a_finding_unless_the_domain_excludes_it(run, tmp_path):
    """The other directions are measured."""
    (tmp_path / "dir.glsl").write_text(SPHEREMAP)
    status, out, _ = run("doctor", "dir.glsl", "--format", "json")
    first = json.loads(out)[0]
    assert status == 1 and first["domain"] == "sphere"
    assert first["finding"] == "encode of (0, 0, -1) is (nan, nan), not finite; all other directions round-trip"
    for domain in ("hemisphere", "view"):
        status, out, _ = run("doctor", "dir.glsl", "--domain", domain, "--format", "json")
        assert status == 0 and {row["domain"] for row in json.loads(out)} == {domain}, out
    status, out, _ = run("doctor", "dir.glsl", "--domain", "sphere", "--format", "json")
    assert status == 1 and "not finite" in json.loads(out)[0]["finding"]
    words = ("--storage", "rgba32f", "--normals", "sphere", "--count", "4096", "--backend", "glsl", "--format", "json")
    status, out, _ = run("quality", "--encoding", "dir.glsl", *words)
    assert status == 0 and json.loads(out)[0]["angle_mean_deg"] < 0.05


def test_lost_directions_are_counted(run, tmp_path):
    """Most of a half round-trips; the finding gives the number of other directions and their largest error."""
    text = NO_FOLD.replace("return n.xy; }", "return n.z >= 0.0 ? n.xy : fold(n.xy); }")
    wrong = text.replace("return normalize(n);", "if (n.z < -0.6) n.x += 0.3 * sign(n.x); return normalize(n);")
    assert wrong != text
    (tmp_path / "dir.glsl").write_text(wrong)
    status, out, _ = run("doctor", "dir.glsl", "--format", "json")
    (finding, *_) = [row["finding"] for row in json.loads(out)]
    match = re.fullmatch(
        r"directions with z < 0: (\d+) of (\d+) are off by more than 1 degree, up to ([\d.]+) degrees; .*", finding
    )
    assert status == 1 and match, finding
    count, among, largest = map(float, match.groups())
    assert 0.1 < count / among < 0.9 and 15 < largest < 40


def test_a_square_that_is_half_used_is_a_finding(run, tmp_path):
    """Neither function folds: each number covers -1 to 1, but half of the square is unused."""
    text = NO_FOLD.split("vec3 dir_decode")[0] + NO_UNFOLD[NO_UNFOLD.index("vec3 dir_decode") :]
    (tmp_path / "dir.glsl").write_text(text)
    status, out, _ = run("doctor", "dir.glsl", "--format", "json")
    assert status == 1 and "% of the square that the storage's bits cover" in out, out
