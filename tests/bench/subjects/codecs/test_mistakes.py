"""Mistakes in encoders, named correctly for every text and bit count, and correct files without findings.

Each program is a correct text with one edit; see `mistakes`. The round trip is measured without any storage, so an
edit that changes no result, such as `>` for `>=` in a fold, is not a mistake.
"""

import json
import re
from pathlib import Path

import pytest
from mistakes import MISTAKES, OCTAHEDRAL, TEXTS, program, said
from typed import first_look

pytestmark = pytest.mark.usefixtures("gl")


# Of one text and one number of bits in every run; all of them by night.
QUICK = [(text, mistake, 8) for text in list(TEXTS)[:1] for mistake in MISTAKES]


QUICK += [("divided in place", "abs missing in the sum", 8), ("divided in place", "normalise missing", 8)]


QUICK += [("by mix and step", "wrong range", 10), ("by mix and step", "cut off", 16)]


# What two mistakes share: a fold and an unfold, and two ways to the same error.
ALIKE = (
    {"254 for 255", "254 for 255, rounded"},
    {"half-step bias", "half-step bias, rounded"},
    {"sign(0)"},
)


def findings(folder: Path, text: str) -> list[str]:
    path = folder / "mine.glsl"
    path.write_text(text)
    look = first_look(path)
    assert "error" not in look and "missing" not in look, look
    return [*([look["broken"]] if "broken" in look else []), *look.get("wrong", [])]


def others(mistake: str, bits: int) -> list[str]:
    """Return the mistakes that have another message."""
    alike = next((group for group in ALIKE if mistake in group), {mistake})
    return [bug for bug in MISTAKES if bug not in alike and said(bug, bits) and said(bug, bits) != said(mistake, bits)]


def check(folder: Path, text: str, mistake: str, bits: int) -> None:
    shader = program(text, mistake, bits)
    if shader is None:
        assert text not in OCTAHEDRAL or "decode" in mistake, "every mistake is made in every text of the octahedron"
        return
    lines, expected = findings(folder, shader), said(mistake, bits)
    is_named = any(re.search(expected, line) for line in lines)
    # Of another map than the octahedron a mistake need not be known, but something must be said.
    assert is_named if text in OCTAHEDRAL and expected else bool(lines) == bool(expected), lines
    wrong = [other for other in others(mistake, bits) if any(re.search(said(other, bits), line) for line in lines)]
    assert wrong == [], (wrong, lines)


@pytest.mark.parametrize("text, mistake, bits", QUICK)
def test_a_mistake_is_identified(tmp_path, text, mistake, bits):
    check(tmp_path, text, mistake, bits)


@pytest.mark.parametrize("mistake", ["cut off", "half-step bias", "254 for 255"])
@pytest.mark.parametrize("storage, bits", [("rg8", 8), ("rgb10a2", 10), ("rg16", 16)])
def test_doctor_reports_a_mistake_and_its_cost_in_a_storage(run, tmp_path, storage, bits, mistake):
    (tmp_path / "mine.glsl").write_text(program("in [0, 1]", mistake, bits))
    status, out, _ = run("doctor", str(tmp_path / "mine.glsl"), "--storage", storage, "--format", "json")
    first, *rest = [row["finding"] for row in json.loads(out)]
    assert status == 1 and re.search(said(mistake, bits), first), first
    worse = [re.fullmatch(rf"in {storage} this is octahedral, but (\d+)% worse: .*", line) for line in rest]
    assert [40 < int(match[1]) < 150 for match in worse if match] == [True], rest


@pytest.mark.parametrize("text", TEXTS)
def test_a_text_without_a_mistake_has_no_findings(tmp_path, text):
    assert findings(tmp_path, program(text, "", 8)) == []


def test_each_mistake_changes_the_text():
    """Each mistake changes at least one octahedral text."""
    for mistake in MISTAKES:
        texts = [program(text, mistake, 8) for text in OCTAHEDRAL]
        assert any(new and new != program(text, "", 8) for text, new in zip(OCTAHEDRAL, texts, strict=True)), mistake
