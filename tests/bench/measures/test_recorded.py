"""Figures that come with the package: those that are computed now, and of the codecs as they are now."""

import json
from dataclasses import replace

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
def test_every_codec_is_recorded_as_it_is_now(where, name):
    kept = json.loads(where.file.read_text())
    keys = {codec.name if name is str else name(codec): where.key(codec) for codec in codecs()}
    assert {name: row["key"] for name, row in kept.items()} == keys, STALE


def test_a_recorded_supremum_is_that_of_the_search():
    found, expected = suprema.supremum(OCTAHEDRAL, False), worst_case(OCTAHEDRAL)
    assert found.angle_deg == pytest.approx(expected.angle_deg, rel=1e-9) and found.found_by == expected.found_by


def test_a_codec_of_other_sources_is_searched(monkeypatch):
    """One whose sources changed, and one that has a name of the catalogue and is another."""
    monkeypatch.setattr(suprema, "worst_case", lambda codec, is_half: (codec, is_half))
    mine = replace(OCTAHEDRAL, encoding=replace(OCTAHEDRAL.encoding, decode=ENCODINGS["equal_area_octahedral"].decode))
    assert suprema.supremum(mine, False) == (mine, False)
    monkeypatch.setattr(recorded.Recorded, "key", lambda *_: "other")
    assert suprema.supremum(OCTAHEDRAL, False) == (OCTAHEDRAL, False)


def test_what_uses_do_is_recorded_for_the_usual_mixes_alone(monkeypatch):
    """What was recorded is what is measured; other seeds and other normals are measured."""
    monkeypatch.setattr(judge, "judged_now", lambda *_: "measured")
    uses = ["resolve", "upsample"]
    kept = judge.judgements(OCTAHEDRAL, uses, SPHERE, "sphere")
    monkeypatch.undo()
    assert kept == judge.judged_now(OCTAHEDRAL, uses, SPHERE, "sphere")
    monkeypatch.setattr(judge, "judged_now", lambda *_: "measured")
    others = [
        (NORMAL_SETS["sphere"](64, 1), "sphere"),
        (SPHERE, "hemisphere"),
        (NORMAL_SETS["playground"](0, 0), "sphere"),
    ]
    assert [judge.judgements(OCTAHEDRAL, uses, *other) for other in others] == ["measured"] * 3


def test_comments_and_docstrings_decide_nothing(tmp_path):
    plain, told, other = (tmp_path / f"{name}.py" for name in ("plain", "told", "other"))
    plain.write_text("def f(x):\n    return x + 1\n")
    told.write_text('"""What it is."""\n\n\ndef f(x):\n    """Add 1."""\n    # why\n    return x + 1\n')
    other.write_text("def f(x):\n    return x + 2\n")
    codes = [recorded.code_of(path) for path in (plain, told, other)]
    assert codes[0] == codes[1] != codes[2]
