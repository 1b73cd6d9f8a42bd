"""Findings that name the missing step between two functions, and no findings for encoders that round correctly."""

import json

import numpy as np
import pytest
from mistakes import program
from test_between import PAIRS, findings, mapped, with_code

from normalbench.bench.door import examine

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("what", PAIRS)
def test_step_that_completes_a_pair_is_reported(tmp_path, what):
    text, finding = PAIRS[what]
    lines = findings(tmp_path, text)
    assert lines and finding in lines[0], lines


@pytest.mark.parametrize("text", [mapped("n.z * 4.0 + 4.0"), mapped(side="(1.0 - f / 4.0)")])
def test_wrong_code_is_not_blamed_on_a_missing_normalize(tmp_path, text):
    """The decoded length is also wrong, but `normalize()` would not correct the direction."""
    (finding,) = findings(tmp_path, text)
    assert "are not a pair" in finding
    # The right one loses the pole where all directions meet, and nothing else.
    assert findings(tmp_path, mapped()) == ["a pole is lost: (0, 0, -1) becomes (0, 0, 1)"]


def test_fold_that_does_not_match_the_unfold_is_reported(tmp_path):
    """Two folds each make a pair with their own unfold."""
    text = program("by mix and step", "", 8)
    own = text.replace("abs(p.yx)", "abs(p)").replace("abs(e.yx)", "abs(e)")
    assert own != text and findings(tmp_path, own) == []
    (first, *_) = findings(tmp_path, text.replace("abs(p.yx)", "abs(p)"))
    assert "its fold uses .xy instead of .yx" in first


ROUNDED = ("floor(({}) * STEPS.0 + 0.5) / STEPS.0", "round(({}) * STEPS.0) / STEPS.0")


@pytest.mark.parametrize("bits", [8, 12])
@pytest.mark.parametrize("rounds", ROUNDED)
def test_an_encoder_that_rounds_correctly_has_no_findings(tmp_path, rounds, bits):
    unit = rounds.format("c * 0.5 + 0.5").replace("STEPS", str(2**bits - 1))
    signed = rounds.format("c").replace("STEPS", str(2 ** (bits - 1) - 1))
    assert findings(tmp_path, with_code(f"({unit}) * 2.0 - 1.0")) == []
    assert findings(tmp_path, with_code(signed)) == []


def test_encoder_is_compared_with_the_same_map_in_the_catalogue(run, tmp_path):
    """Scaling codes by 1023/1024 loses half a step of 10 bits near 1; in 8 bits the loss is negligible."""
    path = tmp_path / "mine.glsl"
    path.write_text(with_code("c * (1023.0 / 1024.0)"))
    worse = "in rgb10a2 this is octahedral, but 46% worse: mean 0.122 degrees"
    for storage, expected in {"rgb10a2": worse, "rg8": ""}.items():
        status, out, _ = run("doctor", str(path), "--storage", storage, "--format", "json")
        first, *rest = [row["finding"] for row in json.loads(out)]
        assert status == 1 and "encode gives 1023/1024 times the code that decode expects" in first
        assert [line.startswith(expected) for line in rest] == [True] * bool(expected), rest
    path.write_text(with_code("c"))
    assert run("doctor", str(path), "--storage", "rgb10a2")[0] == 0


def test_the_picture_marks_each_direction_that_is_lost(run, tmp_path, monkeypatch):
    """sign(0) loses directions between the points of any grid; each has a mark, and both halves are labelled."""
    path, picture = tmp_path / "mine.glsl", tmp_path / "sphere.svg"
    path.write_text(program("octahedral", "sign(0)", 8))
    charts, draw = [], examine.sphere_chart

    def drawn(*given):
        charts.append(draw(*given))
        return charts[-1]

    monkeypatch.setattr(examine, "sphere_chart", drawn)
    assert run("doctor", str(path), "--plot", str(picture), "--storage", "rg16")[0] == 1
    axis, *_ = charts[0].axes
    (marks,) = axis.collections
    x, y = marks.get_offsets().T
    assert axis.get_title() == f"mine/rg16\n{len(x)} directions decode incorrectly (red)" and len(x) > 100
    # All have z < 0, and lie on the upright or on the level line through the middle of that disc.
    assert (x > 95).all() and (np.minimum(abs(x - 143.5), abs(y - 47.5)) < 0.5).all()
    assert [text.get_text() for text in axis.texts] == ["z >= 0, towards the viewer", "z < 0"]
    path.write_text(with_code("c"))
    assert run("doctor", str(path), "--plot", str(picture))[0] == 0
    assert charts[1].axes[0].get_title() == "mine/rgba8"
