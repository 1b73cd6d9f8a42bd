"""Suprema that come with the package: those that the search finds, and of the codecs as they are now."""

import json
from dataclasses import replace

import pytest

from normalbench.bench.measures.worst_case import recorded
from normalbench.bench.measures.worst_case.search import worst_case
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from tests.recorded_suprema import codecs

STALE = "its sources are not those that it was computed from; run python -m tests.recorded_suprema"
OCTAHEDRAL = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])


def test_every_codec_is_recorded_as_it_is_now():
    kept = json.loads(recorded.FILE.read_text())
    keys = {recorded.name_of(codec, is_half): recorded.source_key(codec) for codec, is_half in codecs()}
    assert {name: row["key"] for name, row in kept.items()} == keys, STALE


def test_a_recorded_supremum_is_that_of_the_search():
    found, expected = recorded.supremum(OCTAHEDRAL, False), worst_case(OCTAHEDRAL)
    assert found.angle_deg == pytest.approx(expected.angle_deg, rel=1e-9) and found.found_by == expected.found_by


def test_a_codec_of_other_sources_is_searched(monkeypatch):
    """One whose sources changed, and one that has a name of the catalogue and is another."""
    monkeypatch.setattr(recorded, "worst_case", lambda codec, is_half: (codec, is_half))
    mine = replace(OCTAHEDRAL, encoding=replace(OCTAHEDRAL.encoding, decode=ENCODINGS["equal_area_octahedral"].decode))
    assert recorded.supremum(mine, False) == (mine, False)
    monkeypatch.setattr(recorded, "source_key", lambda _: "other")
    assert recorded.supremum(OCTAHEDRAL, False) == (OCTAHEDRAL, False)


def test_comments_and_docstrings_decide_nothing(tmp_path):
    plain, told, other = (tmp_path / f"{name}.py" for name in ("plain", "told", "other"))
    plain.write_text("def f(x):\n    return x + 1\n")
    told.write_text('"""What it is."""\n\n\ndef f(x):\n    """Add 1."""\n    # why\n    return x + 1\n')
    other.write_text("def f(x):\n    return x + 2\n")
    codes = [recorded._code(path) for path in (plain, told, other)]
    assert codes[0] == codes[1] != codes[2]
