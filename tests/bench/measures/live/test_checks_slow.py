"""The normals that browsers encode, and the checksums of a codec's codes for these normals."""

import json

import pytest
from test_checks import OCTAHEDRAL

from normalbench.bench.measures.live import checks


def test_checks_of_a_codec_are_small_and_computed_once(own_cache, monkeypatch):
    figures = checks.checks(OCTAHEDRAL)
    assert len(json.dumps(figures)) < 3500
    # JAX, step by step, 2026; 0.0833 degrees is what the quality table has on uniform directions.
    assert (figures["mean_deg"], figures["max_deg"]) == pytest.approx((0.0832865, 0.2376264), abs=1e-6)
    monkeypatch.setattr(checks, "reference_of", None)
    assert checks.checks(OCTAHEDRAL) == figures
    assert any(own_cache.rglob("*.json"))
