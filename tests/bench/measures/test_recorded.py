"""Figures that ship with the package: they match new measurements and the current codecs."""

import json
from dataclasses import asdict, replace

import pytest

from normalbench.bench.measures import recorded
from normalbench.bench.measures.worst_case import recorded as suprema
from normalbench.bench.measures.worst_case.search import worst_case
from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.mix import judge
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from tests.recorded import codecs, is_half

STALE = "its sources are not those that it was computed from; run python -m tests.recorded"
OCTAHEDRAL = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])
SPHERE = NORMAL_SETS["sphere"](64, 0)


@pytest.mark.parametrize(
    "where, name", [(suprema.SUPREMA, lambda codec: suprema.name_of(codec, is_half(codec))), (judge.RECORDED, str)]
)
def test_every_codec_is_recorded_in_its_current_form(where, name):
    kept = json.loads(where.file.read_text())
    keys = {codec.name if name is str else name(codec): where.key(codec) for codec in codecs()}
    assert {name: row["key"] for name, row in kept.items()} == keys, STALE


def test_a_recorded_supremum_matches_the_search():
    worst, expected = suprema.supremum(OCTAHEDRAL, False), worst_case(OCTAHEDRAL)
    assert worst.angle_deg == pytest.approx(expected.angle_deg, rel=1e-9) and worst.found_by == expected.found_by


def test_the_supremum_of_a_changed_codec_is_searched_again(monkeypatch):
    """The codec has changed sources, or the name of a catalogue codec but another decoder."""
    monkeypatch.setattr(suprema, "worst_case", lambda codec, is_half: (codec, is_half))
    mine = replace(OCTAHEDRAL, encoding=replace(OCTAHEDRAL.encoding, decode=ENCODINGS["equal_area_octahedral"].decode))
    assert suprema.supremum(mine, False) == (mine, False)
    monkeypatch.setattr(recorded.Recorded, "key", lambda *_: "other")
    assert suprema.supremum(OCTAHEDRAL, False) == (OCTAHEDRAL, False)


def assert_same_judgements(kept: dict[str, judge.Judgement], expected: dict[str, judge.Judgement]) -> None:
    """Processors round float32 differently in the last place, which is 3.4e-6 degrees of a direction."""
    for use, judgement in expected.items():
        angles = {name: pytest.approx(getattr(judgement, name), rel=0, abs=1e-5) for name in ("mean_deg", "max_deg")}
        assert asdict(kept[use]) == asdict(judgement) | angles, use


def test_mixes_are_recorded_only_for_the_usual_settings(monkeypatch):
    """Recorded figures match a measurement; other seeds, domains and normals are measured."""
    monkeypatch.setattr(judge, "judged_now", lambda *_: "measured")
    uses = ["resolve", "upsample"]
    kept = judge.judgements(OCTAHEDRAL, uses, SPHERE, "sphere")
    monkeypatch.undo()
    assert_same_judgements(kept, judge.judged_now(OCTAHEDRAL, uses, SPHERE, "sphere"))
    monkeypatch.setattr(judge, "judged_now", lambda *_: "measured")
    others = [
        (NORMAL_SETS["sphere"](64, 1), "sphere"),
        (SPHERE, "hemisphere"),
        (NORMAL_SETS["playground"](0, 0), "sphere"),
    ]
    assert [judge.judgements(OCTAHEDRAL, uses, *other) for other in others] == ["measured"] * 3


def test_comments_and_docstrings_do_not_change_the_key(tmp_path):
    plain, told, other = (tmp_path / f"{name}.py" for name in ("plain", "told", "other"))
    plain.write_text("def f(x):\n    return x + 1\n")
    told.write_text('"""What it is."""\n\n\ndef f(x):\n    """Add 1."""\n    # why\n    return x + 1\n')
    other.write_text("def f(x):\n    return x + 2\n")
    codes = [recorded.code_of(path) for path in (plain, told, other)]
    assert codes[0] == codes[1] != codes[2]
