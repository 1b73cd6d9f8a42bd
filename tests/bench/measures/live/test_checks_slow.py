"""The normals that browsers encode, and the checksums of a codec's codes of them."""

import json

import pytest
from test_checks import OCTAHEDRAL

from normalbench.bench.measures.live import checks


def test_what_is_kept_of_a_codec_is_small_and_made_once(own_cache, monkeypatch):
    found = checks.checks(OCTAHEDRAL)
    assert len(json.dumps(found)) < 3500
    # JAX, step by step, 2026; 0.0833 degrees is what the quality table has on uniform directions.
    assert (found["mean_deg"], found["max_deg"]) == pytest.approx((0.0832865, 0.2376264), abs=1e-6)
    monkeypatch.setattr(checks, "reference_of", None)
    assert checks.checks(OCTAHEDRAL) == found
    assert any(own_cache.rglob("*.json"))
