"""Mistakes of encoders are named rightly, whatever the text and the bits; right files raise nothing.

Each program is a right text with one edit; see `mistakes`. What is measured is a round trip without any storage, so
that a mistake which changes no result, as `>` for `>=` in a fold, is none.
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
    found = first_look(path)
    assert "error" not in found and "missing" not in found, found
    return [*([found["broken"]] if "broken" in found else []), *found.get("wrong", [])]


def others(mistake: str, bits: int) -> list[str]:
    """Mistakes of other names."""
    alike = next((one for one in ALIKE if mistake in one), {mistake})
    return [one for one in MISTAKES if one not in alike and said(one, bits) and said(one, bits) != said(mistake, bits)]


def check(folder: Path, text: str, mistake: str, bits: int) -> None:
    made = program(text, mistake, bits)
    if made is None:
        assert text not in OCTAHEDRAL or "decode" in mistake, "every mistake is made in every text of the octahedron"
        return
    found, expected = findings(folder, made), said(mistake, bits)
    is_named = any(re.search(expected, line) for line in found)
    # Of another map than the octahedron a mistake need not be known, but something must be said.
    assert is_named if text in OCTAHEDRAL and expected else bool(found) == bool(expected), found
    wrong = [one for one in others(mistake, bits) if any(re.search(said(one, bits), line) for line in found)]
    assert wrong == [], (wrong, found)


@pytest.mark.parametrize("text, mistake, bits", QUICK)
def test_a_mistake_is_named(tmp_path, text, mistake, bits):
    check(tmp_path, text, mistake, bits)


@pytest.mark.parametrize("mistake", ["cut off", "half-step bias", "254 for 255"])
@pytest.mark.parametrize("storage, bits", [("rg8", 8), ("rgb10a2", 10), ("rg16", 16)])
def test_doctor_names_it_and_says_what_it_costs_in_a_storage(run, tmp_path, storage, bits, mistake):
    (tmp_path / "mine.glsl").write_text(program("in [0, 1]", mistake, bits))
    status, out, _ = run("doctor", str(tmp_path / "mine.glsl"), "--storage", storage, "--format", "json")
    first, *rest = [row["finding"] for row in json.loads(out)]
    assert status == 1 and re.search(said(mistake, bits), first), first
    worse = [re.fullmatch(rf"in {storage} this is octahedral, but (\d+)% worse: .*", line) for line in rest]
    assert [40 < int(found[1]) < 150 for found in worse if found] == [True], rest


@pytest.mark.parametrize("text", TEXTS)
def test_a_text_without_a_mistake_raises_nothing(tmp_path, text):
    assert findings(tmp_path, program(text, "", 8)) == []


def test_each_mistake_changes_the_text():
    """Of an octahedral map each, in one text at least."""
    for mistake in MISTAKES:
        made = [program(text, mistake, 8) for text in OCTAHEDRAL]
        assert any(one and one != program(text, "", 8) for text, one in zip(OCTAHEDRAL, made, strict=True)), mistake
