"""What makes a pair of two functions is named; an encoder that rounds rightly by itself raises nothing."""

import json

import numpy as np
import pytest
from mistakes import program
from test_between import PAIRS, findings, mapped, with_code

from normalbench.bench.door import examine

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("what", PAIRS)
def test_what_makes_a_pair_is_named(tmp_path, what):
    text, said = PAIRS[what]
    found = findings(tmp_path, text)
    assert found and said in found[0], found


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


def test_the_same_map_of_the_catalogue_is_what_it_is_compared_with(run, tmp_path):
    """Codes scaled by 1023/1024 lose half a step of 10 bits where they are 1; of 8 bits it is nothing to speak of."""
    path = tmp_path / "mine.glsl"
    path.write_text(with_code("c * (1023.0 / 1024.0)"))
    worse = "in rgb10a2 this is octahedral, but 46% worse: mean 0.122 degrees"
    for storage, said in {"rgb10a2": worse, "rg8": ""}.items():
        status, out, _ = run("doctor", str(path), "--storage", storage, "--format", "json")
        first, *rest = [row["finding"] for row in json.loads(out)]
        assert status == 1 and "encode gives 1023/1024 times the code that decode expects" in first
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
    assert axis.get_title() == f"mine/rg16\n{len(x)} directions decode incorrectly (red)" and len(x) > 100
    # All have z < 0, and lie on the upright or on the level line through the middle of that disc.
    assert (x > 95).all() and (np.minimum(abs(x - 143.5), abs(y - 47.5)) < 0.5).all()
    assert [text.get_text() for text in axis.texts] == ["z >= 0, towards the viewer", "z < 0"]
    path.write_text(with_code("c"))
    assert run("doctor", str(path), "--plot", str(picture))[0] == 0
    assert made[1].axes[0].get_title() == "mine/rgba8"
