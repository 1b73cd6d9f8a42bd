"""Findings that name the missing step between two functions, and no findings for encoders that round correctly."""

import pytest
from mistakes import PLAIN
from typed import first_look

from normalbench.encodings.catalogue import ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")


RIGHT = PLAIN.replace("BEFORE", "")


HEMI = """vec2 mine_encode(vec3 n) {
    vec2 c = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return vec2(c.x + c.y, c.x - c.y);
}
vec3 mine_decode(vec2 e) {
    BEFORE
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5;
    return normalize(vec3(p, 1.0 - abs(p.x) - abs(p.y)));
}
"""


def decoder(name: str) -> str:
    """Return a decode function of the catalogue."""
    text = ENCODINGS[name].glsl.read_text()
    start = text.index(f"vec3 {name}_decode")
    return text[start : text.index("\n}\n", start) + 3].replace(f"{name}_", "mine_")


def with_code(code: str, text: str = RIGHT) -> str:
    return text.replace("return CODE;", f"return {code};").replace("CODE", "c")


# J. Mittring's spheremap in [0, 1]: what the encoder's square root is of, and a third of the direction that comes back.
MAPPED = """vec2 mine_encode(vec3 n) { return n.xy / sqrt(max(ROOT, 1e-6)) + 0.5; }
vec3 mine_decode(vec2 e) {
    vec2 g = e * 4.0 - 2.0;
    float f = dot(g, g);
    return vec3(g * SIDE, 1.0 - f / 2.0);
}
"""


def mapped(root: str = "n.z * 8.0 + 8.0", side: str = "sqrt(max(1.0 - f / 4.0, 0.0))") -> str:
    return MAPPED.replace("ROOT", root).replace("SIDE", side)


# What stands between the encoder and the decoder, and what is said of it.
PAIRS = {
    "half of the range": (with_code("c * 0.5 + 0.5"), "c * 2 - 1 between the two makes them a pair"),
    "twice the range": (
        RIGHT.replace("CODE", "c").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "c * 0.5 + 0.5",
    ),
    "swapped": (with_code("c.yx"), "as with its components swapped, c.yx between the two"),
    "negated": (with_code("-c"), "as with components 1 and 2 negated between the two"),
    "one negated": (with_code("vec2(c.x, -c.y)"), "as with component 2 negated between the two"),
    "turned by 45 degrees": (
        HEMI.replace("BEFORE", "").replace("vec2(c.x + c.y, c.x - c.y)", "c"),
        "a rotation by 45 degrees, (c.x + c.y, c.x - c.y) between the two makes them a pair for directions with z >= 0",
    ),
    "turned back": (
        HEMI.replace("BEFORE", "e = vec2(e.x + e.y, e.x - e.y);"),
        "a rotation by 45 degrees, (c.x + c.y, c.x - c.y) / 2 between the two makes them a pair for directions with "
        "z >= 0",
    ),
    "a range and swapped": (
        with_code("c.yx * 0.5 + 0.5"),
        "c * 2 - 1, then its components swapped, c.yx between the two makes them a pair",
    ),
    "twice a half map": (
        HEMI.replace("BEFORE", "").replace(") * 0.5", ")"),
        "encode gives 2 times the code that decode expects: up to",
    ),
    "4 for 8 in a root": (
        mapped("n.z * 4.0 + 4.0"),
        "are not a pair: 46.7 degrees apart on average without any storage; "
        "encode gives 1.4142 times the code that decode expects, around 0.5: up to",
    ),
    "half of [0, 1]": (
        "vec3 mine_encode(vec3 n) { return n * 0.5; }\nvec3 mine_decode(vec3 e) { return normalize(e * 2.0 - 1.0); }\n",
        "c + 0.5 between the two makes them a pair",
    ),
    "a scale and a shift": (
        RIGHT.replace("CODE", "(c * 127.0 + 128.0) / 255.0").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "encode gives 254/255 times the code that decode expects, plus 1/255: up to",
    ),
    "a scale alone": (
        RIGHT.replace("CODE", "(c * 0.5 + 0.5) * (254.0 / 255.0)").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "encode gives 254/255 times the code that decode expects: up to",
    ),
    "256 for 255": (
        RIGHT.replace("CODE", "floor((c * 0.5 + 0.5) * 255.0 + 0.5) / 256.0").replace(
            "vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"
        ),
        "encode gives 255/256 times the code that decode expects: it rounds to 255 steps",
    ),
    "another decoder of the catalogue": (
        with_code("c").split("vec3 mine_decode")[0] + decoder("spheremap"),
        "encode matches octahedral, decode matches spheremap",
    ),
    "no decoder that is known": (
        with_code("c").split("vec3 mine_decode")[0]
        + "vec3 mine_decode(vec2 e) { return normalize(vec3(e, 0.3 + e.x * e.y)); }",
        "encode matches octahedral, whose decode makes a pair with it",
    ),
}


def findings(folder, text: str) -> list[str]:
    (folder / "mine.glsl").write_text(text)
    look = first_look(folder / "mine.glsl")
    assert "error" not in look, look
    return look["wrong"]


def test_missing_step_is_the_only_finding(tmp_path):
    """Half of the range is unused before the step, and none after it."""
    assert len(findings(tmp_path, PAIRS["half of [0, 1]"][0])) == 1


def test_signed_codes_truncated_toward_0_are_reported(tmp_path):
    (first, *_) = findings(tmp_path, with_code("trunc(c * 127.0) / 127.0"))
    assert "codes are truncated to 8 bits, and all are off by half a step" in first


def test_shift_other_than_half_a_step_is_reported_as_a_number(tmp_path):
    (first, *_) = findings(tmp_path, with_code("c * 0.9 + 0.03").replace("vec2 e) {", "vec2 e) { e = e / 0.9;"))
    assert "encode gives the code that decode expects, plus 0.03" in first


@pytest.mark.parametrize("scale, said", [(0.9, "0.9 times"), (0.99, "0.99 times"), (1 / 1.5, "0.66667 times")])
def test_a_scale_is_reported(tmp_path, scale, said):
    lines = findings(tmp_path, with_code(f"c * {scale}"))
    assert any(f"encode gives {said} the code that decode expects" in line for line in lines), lines
