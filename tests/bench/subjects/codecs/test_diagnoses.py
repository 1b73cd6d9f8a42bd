"""Diagnoses of users' encoders: the likely error in a wrong encoder, and only the domain of a correct encoder."""

import json
from pathlib import Path

import pytest
from typed import first_look

from normalbench.bench.subjects.codecs.doctor.diagnoses import diagnosed
from normalbench.bench.subjects.codecs.doctor.domains import Domain
from normalbench.bench.subjects.codecs.doctor.probe import probe_of
from normalbench.encodings.catalogue import ENCODINGS

ENCODE = """vec2 mine_encode(vec3 n, vec3 view) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 f = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    p = n.z < 0.0 ? f : p;
    return CODE;
}
"""


DECODE = """vec3 mine_decode(vec2 e, vec3 view) {
    BEFORE
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -t : t, n.y >= 0.0 ? -t : t);
    return RESULT;
}
"""


PI = "3.14159265358979"


BY_ANGLES = f"""vec3 mine_decode(vec2 e, vec3 view) {{
    BEFORE
    float a = e.x * {PI}, s = sqrt(max(0.0, 1.0 - e.y * e.y));
    return vec3(cos(a) * s, sin(a) * s, e.y);
}}
"""


ANGLES = f"vec2 mine_encode(vec3 n, vec3 view) {{ return vec2(atan(n.y, n.x) / {PI}, n.z); }}\n"


INCLINED = f"""vec2 mine_encode(vec3 n, vec3 view) {{
    return vec2(atan(n.y, n.x), 2.0 * acos(clamp(n.z, -LARGEST, LARGEST)) - {PI}) / {PI};
}}
vec3 mine_decode(vec2 e, vec3 view) {{
    float a = e.x * {PI}, t = (e.y + 1.0) * 0.5 * {PI};
    return vec3(cos(a) * sin(t), sin(a) * sin(t), cos(t));
}}
"""


ALL_THREE = """vec3 mine_encode(vec3 n, vec3 view) { return n; }
vec3 mine_decode(vec3 e, vec3 view) { return RESULT; }
"""


FLAT = """vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }
vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e)))); }
"""


HALF = """vec2 mine_encode(vec3 n, vec3 view) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return vec2(p.x + p.y, p.x - p.y);
}
vec3 mine_decode(vec2 e, vec3 view) {
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5;
    return normalize(vec3(p, 1.0 - abs(p.x) - abs(p.y)));
}
"""


DISC = """vec2 mine_encode(vec3 n, vec3 view) { return n.xy / sqrt(1.0 + max(n.z, 0.0)); }
vec3 mine_decode(vec2 e, vec3 view) { float f = dot(e, e); return vec3(e * sqrt(max(0.0, 2.0 - f)), 1.0 - f); }
"""


STEREO = """vec2 mine_encode(vec3 n, vec3 view) { return n.xy / (1.0 + max(n.z, 0.0)); }
vec3 mine_decode(vec2 e, vec3 view) { float d = 1.0 + dot(e, e); return vec3(2.0 * e, 2.0 - d) / d; }
"""


# What a code is, its encode of n, and its decode of e.
OF_THE_SPHERE = {
    "three in [0, 1]": ("vec3", "return n * 0.5 + 0.5;", "return e * 2.0 - 1.0;"),
    "three rounded to 5 bits": (
        "vec3",
        "return round((n * 0.5 + 0.5) * 31.0) / 31.0;",
        "return normalize(e * 2.0 - 1.0);",
    ),
    "two angles in [0, 1]": (
        "vec2",
        f"return vec2(atan(n.y, n.x) / (2.0 * {PI}) + 0.5, acos(clamp(n.z, -1.0, 1.0)) / {PI});",
        f"float a = (e.x - 0.5) * 2.0 * {PI}, t = e.y * {PI}; return vec3(cos(a) * sin(t), sin(a) * sin(t), cos(t));",
    ),
    # P. Lagarde's acos, a hundredth off.
    "an approximated acos": (
        "vec2",
        f"float x = abs(n.z), r = (-0.156583 * x + 1.570796) * sqrt(1.0 - x); r = n.z >= 0.0 ? r : {PI} - r; "
        f"return vec2(atan(n.y, n.x) / {PI}, r / {PI} * 2.0 - 1.0);",
        f"float a = e.x * {PI}, t = (e.y * 0.5 + 0.5) * {PI}; return vec3(cos(a) * sin(t), sin(a) * sin(t), cos(t));",
    ),
    "two paraboloids": (
        "vec3",
        "return vec3(n.xy / (1.0 + abs(n.z)), n.z < 0.0 ? -1.0 : 1.0);",
        "float d = dot(e.xy, e.xy); return vec3(2.0 * e.xy, (1.0 - d) * (e.z < 0.0 ? -1.0 : 1.0)) / (1.0 + d);",
    ),
    "two and a sign": (
        "vec3",
        "return vec3(n.xy, n.z < 0.0 ? -1.0 : 1.0);",
        "return vec3(e.xy, sqrt(max(0.0, 1.0 - dot(e.xy, e.xy))) * e.z);",
    ),
    "an octant and two": (
        "vec3",
        "vec3 a = abs(n) / (abs(n.x) + abs(n.y) + abs(n.z)); "
        "return vec3(a.xy, ((n.x < 0.0 ? 1.0 : 0.0) + (n.y < 0.0 ? 2.0 : 0.0) + (n.z < 0.0 ? 4.0 : 0.0)) / 7.0);",
        "float o = floor(e.z * 7.0 + 0.5); vec3 a = vec3(e.xy, 1.0 - e.x - e.y); "
        "return normalize(a * vec3(mod(o, 2.0) >= 1.0 ? -1 : 1, mod(o, 4.0) >= 2.0 ? -1 : 1, o >= 4.0 ? -1 : 1));",
    ),
    "cryengine": (
        "vec2",
        "return normalize(n.xy + vec2(1e-20)) * sqrt(n.z * 0.5 + 0.5);",
        "float z = dot(e, e) * 2.0 - 1.0; return vec3(normalize(e + vec2(1e-20)) * sqrt(max(0.0, 1.0 - z * z)), z);",
    ),
}


OF_A_HALF = {
    "two of three in [0, 1]": (
        "vec2",
        "return n.xy * 0.5 + 0.5;",
        "e = e * 2.0 - 1.0; return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e))));",
    ),
    # With room for more than a half: what the half is given lies around the middle of [0, 1].
    "stereographic in [0, 1]": (
        "vec2",
        "return n.xy / (n.z + 1.0 + 1e-6) / 1.7777 * 0.5 + 0.5;",
        "vec3 m = vec3((e * 2.0 - 1.0) * 1.7777, 1.0); float g = 2.0 / dot(m, m); return vec3(g * m.xy, g - 1.0);",
    ),
    "an equal-area disc of |z|": (
        "vec2",
        "return n.xy * inversesqrt(1.0 + abs(n.z));",
        "float f = dot(e, e); return vec3(e * sqrt(max(0.0, 2.0 - f)), 1.0 - f);",
    ),
}


def both(kind: str, encode: str, decode: str) -> str:
    """Return an encoder and a decoder with these bodies, for codes of this GLSL type."""
    return f"{kind} mine_encode(vec3 n) {{ {encode} }}\nvec3 mine_decode({kind} e) {{ {decode} }}\n"


def octahedral(code="p", before="", result="normalize(n)") -> str:
    return (ENCODE + DECODE).replace("CODE", code).replace("BEFORE", before).replace("RESULT", result)


def three(text: str) -> str:
    """Return an encoding of two numbers, given as text, with a third number that is always 0."""
    return (
        text.replace("vec2 mine", "vec3 mine")
        .replace("return p;", "return vec3(p, 0.0);")
        .replace("decode(vec2 e,", "decode(vec3 e,")
        .replace("vec3(e, 1.0", "vec3(e.xy, 1.0")
    )


WRONG = {
    "a share of it": (
        octahedral("p * 0.7", "e /= 0.7;"),
        "component 1 of the code ranges from -0.7 to 0.7: 30% of its range is unused",
    ),
    "more than it": (octahedral("p * 1.4", "e /= 1.4;"), "component 1 of the code is 1.4 for (1, 0, 0)"),
    "a mirrored half": (
        octahedral(result="normalize(vec3(abs(n.x), n.yz))"),
        "decode loses directions with x < 0, which come back with x reversed: encode gives them codes of their own",
    ),
    "a fold without .yx": (
        octahedral().replace("abs(p.yx)", "abs(p)"),
        "encode is octahedral, but its fold uses .xy instead of .yx: directions with z < 0 are lost",
    ),
    "a scale on one side": (
        HALF.replace("p.x - p.y);", "0.98 * (p.x - p.y));", 1),
        "encode gives 0.98 times component 2 of the code",
    ),
    "swapped axes": (octahedral(result="normalize(n.yxz)"), "every direction comes back with x and y swapped"),
    "a flipped y": (octahedral(result="normalize(n * vec3(1, -1, 1))"), "every direction comes back with y reversed"),
    "swapped axes of a half": (
        FLAT.replace("return n.xy", "return n.yx"),
        "directions with z >= 0 come back with x and y swapped",
    ),
    "a flipped axis of a half": (
        STEREO.replace("vec3(2.0 * e,", "vec3(2.0 * e * vec2(-1, 1),"),
        "directions with z >= 0 come back with x reversed",
    ),
    "a wrong scale of a half": (
        STEREO.replace("return n.xy", "return 0.5 * n.xy"),
        "for directions with z >= 0 without any storage; encode gives 0.5 times the code that decode expects",
    ),
    "no pair": (octahedral().split("vec3 mine_decode")[0] + BY_ANGLES.replace("BEFORE", ""), "are not a pair: 88.9"),
    "no unit length": (octahedral(result="n"), "decoded lengths range from 0.577 to 1; normalize() is missing"),
    "NaN": (
        ANGLES.replace("n.z)", "n.z + 1e-9 * acos(n.z * 1.001))") + BY_ANGLES.replace("BEFORE", ""),
        "not finite",
    ),
    "a seam": (
        ANGLES + BY_ANGLES.replace("BEFORE", "if (e.x > 0.97) e.x = -0.9;"),
        " of 4338 tested directions are off by more than 1 degree",
    ),
    "a number of nothing": (three(octahedral()), "component 3 of the code is unused: it is always 0"),
    "an angle of half a turn": (
        both(
            "vec2",
            f"return vec2(atan(n.y, n.x) / {PI}, acos(clamp(n.z, -1.0, 1.0)) / {PI} * 2.0 - 1.0);",
            f"float a = e.x * {PI}, t = (e.y + 1.0) * {PI} / 4.0; "
            "return vec3(cos(a) * sin(t), sin(a) * sin(t), cos(t));",
        ),
        "encode gives 0.5 times component 2 of the code that decode expects",
    ),
    "atan of one argument": (
        both(
            "vec2",
            f"return vec2(atan(n.y / n.x) / {PI}, n.z);",
            f"float a = e.x * {PI}, s = sqrt(max(0.0, 1.0 - e.y * e.y)); return vec3(cos(a) * s, sin(a) * s, e.y);",
        ),
        "encode loses directions with x < 0, which come back with x and y reversed",
    ),
    "a range of one number": (
        octahedral("vec2(p.x * 0.5 + 0.5, p.y)"),
        "encode gives 0.5 times component 1 plus 0.5 of the code that decode expects",
    ),
    "half of [0, 1]": (
        both("vec3", "return n * 0.5 + 0.5;", "return normalize(e);"),
        "c * 2 - 1 between the two makes them a pair",
    ),
    "a step too many": (
        octahedral("floor((p * 0.5 + 0.5) * 256.0) / 255.0 * 2.0 - 1.0"),
        "encode gives 256/255 times the code that decode expects: it rounds to 256 steps",
    ),
    "a lost pole": (INCLINED.replace("LARGEST", "0.9999"), "large errors around the pole +z: directions 0.057"),
}


RIGHT = {
    "octahedral": (octahedral(), "sphere"),
    "angle and z": (ANGLES + BY_ANGLES.replace("BEFORE", ""), "sphere"),
    "two angles": (INCLINED.replace("LARGEST", "1.0"), "sphere"),
    "three numbers": (ALL_THREE.replace("RESULT", "e"), "sphere"),
    "three, normalised": (ALL_THREE.replace("RESULT", "normalize(e)"), "sphere"),
    "turned on its side": (octahedral().replace("n.xy / (", "n.yx / (").replace("vec3(e, 1", "vec3(e.yx, 1"), "sphere"),
    "two of three": (FLAT, "hemisphere"),
    "half an octahedron": (HALF, "hemisphere"),
    "an equal-area disc": (DISC, "hemisphere"),
    "stereographic": (STEREO, "hemisphere"),
    **{name: (both(*parts), "sphere") for name, parts in OF_THE_SPHERE.items()},
    **{name: (both(*parts), "hemisphere") for name, parts in OF_A_HALF.items()},
}


def looked_at(folder: Path, text: str) -> dict:
    path = folder / "mine.glsl"
    path.write_text(text)
    return first_look(path)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("what", WRONG)
def test_error_in_an_encoder_is_reported_first(tmp_path, what):
    text, finding = WRONG[what]
    look = looked_at(tmp_path, text)
    first, *_ = [look["broken"]] if "broken" in look else look["wrong"]
    assert finding in first, look


@pytest.mark.parametrize("what", RIGHT)
def test_correct_encoder_has_no_findings(gl, tmp_path, what):
    """A GPU may return NaN for a direction that the encoder does not define; that finding is allowed."""
    text, domain = RIGHT[what]
    look = looked_at(tmp_path, text)
    wrong = [line for line in look["wrong"] if gl.is_software or "all other directions round-trip" not in line]
    assert (look["domain"], wrong) == (domain, []) and "half" not in look


@pytest.mark.parametrize("name", ENCODINGS)
def test_encodings_in_the_catalogue_have_no_findings(gl, name):
    """The domain of each encoding is also found."""
    encoding = ENCODINGS[name]
    diagnosis = diagnosed(probe_of(gl, encoding), gl)
    assert (diagnosis.domain, diagnosis.wrong) == (Domain(encoding.domain), [])


# A number for the face of a cube, which needs few values: its encode of face f, and its decode of number e.z.
FACES = """vec3 mine_encode(vec3 n) {
    vec3 a = abs(n);
    bool is_z = a.z >= a.x && a.z >= a.y, is_y = a.y >= a.x;
    vec3 t = is_z ? n : is_y ? n.zxy : n.yzx;
    float f = 2.0 * (is_z ? 2.0 : is_y ? 1.0 : 0.0) + (t.z < 0.0 ? 1.0 : 0.0);
    return vec3(t.xy / abs(t.z) * 0.5 + 0.5, ENCODE);
}
vec3 mine_decode(vec3 e) {
    float f = floor(DECODE + 0.5), axis = floor(0.5 * f);
    vec3 n = normalize(vec3(e.xy * 2.0 - 1.0, 1.0 - 2.0 * (f - 2.0 * axis)));
    return axis == 2.0 ? n : axis == 1.0 ? n.yzx : n.zxy;
}
"""


def faces(encode: str, decode: str) -> str:
    return FACES.replace("ENCODE", encode).replace("DECODE", decode)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("steps, reach", [(8.0, 0.625), (16.0, 0.312)])
def test_a_component_with_few_values_need_not_fill_its_range(run, tmp_path, steps, reach):
    """A note states the unused range in the user's own units."""
    path = tmp_path / "mine.glsl"
    path.write_text(faces(f"f / {steps}", f"e.z * {steps}"))
    assert looked_at(tmp_path, path.read_text())["wrong"] == []
    status, out, _ = run("doctor", str(path), "--format", "json")
    notes = [row["finding"] for row in json.loads(out) if row["kind"] == "note"]
    note = f"component 3 of the code takes 6 values from 0 to {reach}; the rest of [0, 1] is unused"
    assert status == 0 and notes[1] == note


@pytest.mark.usefixtures("gl")
def test_an_encoder_that_rounds_for_another_storage_is_not_wrong(run, tmp_path):
    """The loss in a storage with other steps is a note that suggests the matching storage."""
    path = tmp_path / "mine.glsl"
    path.write_text(octahedral("floor(p * 127.0 + 0.5) / 127.0"))
    status, out, _ = run("doctor", str(path), "--format", "json")
    verdict, note = json.loads(out)
    assert status == 0 and (verdict["kind"], note["kind"]) == ("verdict", "note")
    assert note["finding"].startswith("in rgba8 this is octahedral, but 46% worse: ")
    assert note["finding"].endswith("; encode itself rounds to steps of 1/127; try --storage rg8_snorm")
    status, out, _ = run("doctor", str(path), "--storage", "rg8_snorm", "--format", "json")
    assert status == 0 and len(json.loads(out)) == 1


@pytest.mark.usefixtures("gl")
def test_findings_also_appear_in_a_table_command(run, tmp_path):
    path = tmp_path / "mine.glsl"
    path.write_text(octahedral("p * 0.7", "e /= 0.7;"))
    status, _, err = run("quality", "--encoding", str(path), "--storage", "rg8", "--backend", "glsl", "--count", "64")
    assert status == 0 and f"{path}: component 1 of the code ranges from -0.7 to 0.7: 30% of its range is unused" in err


@pytest.mark.parametrize(
    "words, said",
    [
        (("--plot", "a.png"), "require a file or a folder; name one"),
        (("--domain", "sphere"), "require a file or a folder; name one"),
        (("a.glsl", "--domain", "z"), "unknown domain 'z'"),
        (("a.glsl", "--storage", "all"), "doctor measures in one storage"),
        (("nothing.glsl",), "there is no such file"),
        (("a.glsl", "--plot", "a.txt"), "a.txt"),
    ],
)
def test_unsupported_doctor_request_is_a_one_line_error(run, words, said):
    status, out, err = run("doctor", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
