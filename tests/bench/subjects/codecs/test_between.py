"""What makes a pair of two functions is named; an encoder that rounds rightly by itself raises nothing."""

import json

import numpy as np
import pytest
from mistakes import PLAIN, program

from normalbench.bench.door import examine
from normalbench.bench.subjects.codecs.first_look import first_look
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
# A fold that reflects at the middle of each corner, in place of its edge: no octahedron's, but a pair of its own.
OTHER_FOLD = RIGHT.replace("abs(p.yx)", "abs(p)")


def decoder(name: str) -> str:
    """A decode of the catalogue."""
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
    "half of the range": (with_code("c * 0.5 + 0.5"), "c * 2 - 1 between the two makes one"),
    "twice the range": (
        RIGHT.replace("CODE", "c").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "c * 0.5 + 0.5",
    ),
    "swapped": (with_code("c.yx"), "as with its numbers swapped, c.yx between the two"),
    "negated": (with_code("-c"), "as with numbers 1 and 2 negated between the two"),
    "one negated": (with_code("vec2(c.x, -c.y)"), "as with number 2 negated between the two"),
    "turned by 45 degrees": (
        HEMI.replace("BEFORE", "").replace("vec2(c.x + c.y, c.x - c.y)", "c"),
        "a turn by 45 degrees, (c.x + c.y, c.x - c.y) between the two makes one of directions with z >= 0",
    ),
    "turned back": (
        HEMI.replace("BEFORE", "e = vec2(e.x + e.y, e.x - e.y);"),
        "a turn by 45 degrees, (c.x + c.y, c.x - c.y) / 2 between the two makes one of directions with z >= 0",
    ),
    "a range and swapped": (
        with_code("c.yx * 0.5 + 0.5"),
        "c * 2 - 1, then its numbers swapped, c.yx between the two makes one",
    ),
    "twice a half map": (
        HEMI.replace("BEFORE", "").replace(") * 0.5", ")"),
        "encode gives 2 times the code that decode takes: up to",
    ),
    "4 for 8 in a root": (
        mapped("n.z * 4.0 + 4.0"),
        "are not a pair: 46.7 degrees apart on average without any storage; "
        "encode gives 1.4142 times the code that decode takes, around 0.5: up to",
    ),
    "half of [0, 1]": (
        "vec3 mine_encode(vec3 n) { return n * 0.5; }\nvec3 mine_decode(vec3 e) { return normalize(e * 2.0 - 1.0); }\n",
        "c + 0.5 between the two makes one",
    ),
    "a scale and a shift": (
        RIGHT.replace("CODE", "(c * 127.0 + 128.0) / 255.0").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "encode gives 254/255 times the code that decode takes, plus 1/255: up to",
    ),
    "a scale alone": (
        RIGHT.replace("CODE", "(c * 0.5 + 0.5) * (254.0 / 255.0)").replace("vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"),
        "encode gives 254/255 times the code that decode takes: up to",
    ),
    "256 for 255": (
        RIGHT.replace("CODE", "floor((c * 0.5 + 0.5) * 255.0 + 0.5) / 256.0").replace(
            "vec2 e) {", "vec2 e) { e = e * 2.0 - 1.0;"
        ),
        "encode gives 255/256 times the code that decode takes: it rounds to 255 steps",
    ),
    "another decoder of the catalogue": (
        with_code("c").split("vec3 mine_decode")[0] + decoder("spheremap"),
        "encode is that of octahedral, decode that of spheremap",
    ),
    "no decoder that is known": (
        with_code("c").split("vec3 mine_decode")[0]
        + "vec3 mine_decode(vec2 e) { return normalize(vec3(e, 0.3 + e.x * e.y)); }",
        "encode is that of octahedral, whose decode makes a pair with it",
    ),
}


def findings(folder, text: str) -> list[str]:
    (folder / "mine.glsl").write_text(text)
    found = first_look(folder / "mine.glsl")
    assert "error" not in found, found
    return found["wrong"]


@pytest.mark.parametrize("what", PAIRS)
def test_what_makes_a_pair_is_named(tmp_path, what):
    text, said = PAIRS[what]
    found = findings(tmp_path, text)
    assert found and said in found[0], found


def test_a_step_between_the_two_is_all_that_is_said(tmp_path):
    """Half of the range is unused before it, and nothing after it."""
    assert len(findings(tmp_path, PAIRS["half of [0, 1]"][0])) == 1


@pytest.mark.parametrize("text", [mapped("n.z * 4.0 + 4.0"), mapped(side="(1.0 - f / 4.0)")])
def test_what_a_wrong_code_decodes_to_lacks_no_normalize(tmp_path, text):
    """Its length is wrong as well, but normalize() would leave its direction wrong."""
    (said,) = findings(tmp_path, text)
    assert "are not a pair" in said
    # The right one loses the pole where all directions meet, and nothing else.
    assert findings(tmp_path, mapped()) == ["a pole is lost: (0, 0, -1) becomes (0, 0, 1)"]


def test_the_other_ones_fold_is_named(tmp_path):
    """Of two folds that each make a pair, each with its own unfold."""
    text = program("by mix and step", "", 8)
    own = text.replace("abs(p.yx)", "abs(p)").replace("abs(e.yx)", "abs(e)")
    assert own != text and findings(tmp_path, own) == []
    (first, *_) = findings(tmp_path, text.replace("abs(p.yx)", "abs(p)"))
    assert "its fold has .xy where .yx belongs" in first


ROUNDED = ("floor(({}) * STEPS.0 + 0.5) / STEPS.0", "round(({}) * STEPS.0) / STEPS.0")


@pytest.mark.parametrize("bits", [8, 12])
@pytest.mark.parametrize("rounds", ROUNDED)
def test_an_encoder_that_rounds_rightly_raises_nothing(tmp_path, rounds, bits):
    unit = rounds.format("c * 0.5 + 0.5").replace("STEPS", str(2**bits - 1))
    signed = rounds.format("c").replace("STEPS", str(2 ** (bits - 1) - 1))
    assert findings(tmp_path, with_code(f"({unit}) * 2.0 - 1.0")) == []
    assert findings(tmp_path, with_code(signed)) == []


def test_signed_codes_cut_off_toward_0_are_named(tmp_path):
    (first, *_) = findings(tmp_path, with_code("trunc(c * 127.0) / 127.0"))
    assert "codes are cut off toward 0 to 8 bits, not rounded" in first


def test_a_shift_that_is_no_half_step_is_said_as_it_is(tmp_path):
    (first, *_) = findings(tmp_path, with_code("c * 0.9 + 0.03").replace("vec2 e) {", "vec2 e) { e = e / 0.9;"))
    assert "encode gives the code that decode takes, plus 0.03" in first


@pytest.mark.parametrize("scale, said", [(0.9, "0.9 times"), (0.99, "0.99 times"), (1 / 1.5, "0.66667 times")])
def test_a_scale_is_named(tmp_path, scale, said):
    found = findings(tmp_path, with_code(f"c * {scale}"))
    assert any(f"encode gives {said} the code that decode takes" in line for line in found), found


def test_the_same_map_of_the_catalogue_is_what_it_is_compared_with(run, tmp_path):
    """Codes scaled by 1023/1024 lose half a step of 10 bits where they are 1; of 8 bits it is nothing to speak of."""
    path = tmp_path / "mine.glsl"
    path.write_text(with_code("c * (1023.0 / 1024.0)"))
    for storage, said in {"rgb10a2": "in rgb10a2 this is octahedral, 46 % worse: 0.122 degrees", "rg8": ""}.items():
        status, out, _ = run("doctor", str(path), "--storage", storage, "--format", "json")
        first, *rest = [row["finding"] for row in json.loads(out)]
        assert status == 1 and "encode gives 1023/1024 times the code that decode takes" in first
        assert [line.startswith(said) for line in rest] == [True] * bool(said), rest
    path.write_text(with_code("c"))
    assert run("doctor", str(path), "--storage", "rgb10a2")[0] == 0


def test_the_picture_marks_each_direction_that_is_lost(run, tmp_path, monkeypatch):
    """sign(0) loses directions between those of any grid; each has a mark, and both halves have a name."""
    path, picture = tmp_path / "mine.glsl", tmp_path / "sphere.svg"
    path.write_text(program("octahedral", "sign(0)", 8))
    made, draw = [], examine.sphere_chart

    def drawn(*given):
        made.append(draw(*given))
        return made[-1]

    monkeypatch.setattr(examine, "sphere_chart", drawn)
    assert run("doctor", str(path), "--plot", str(picture), "--storage", "rg16")[0] == 1
    axis, *_ = made[0].axes
    (marks,) = axis.collections
    x, y = marks.get_offsets().T
    assert axis.get_title() == f"mine/rg16\n{len(x)} directions come back elsewhere (red)" and len(x) > 100
    # All have z < 0, and lie on the upright or on the level line through the middle of that disc.
    assert (x > 95).all() and (np.minimum(abs(x - 143.5), abs(y - 47.5)) < 0.5).all()
    assert [text.get_text() for text in axis.texts] == ["z >= 0, towards the viewer", "z < 0"]
    path.write_text(with_code("c"))
    assert run("doctor", str(path), "--plot", str(picture))[0] == 0
    assert made[1].axes[0].get_title() == "mine/rgba8"
