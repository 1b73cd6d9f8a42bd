"""The encoder and the decoder in a file, found by their types and their names."""

import time

import pytest
from test_pairs import many

from normalbench.bench.shaders.languages.pairs import (
    SeveralPairsError,
    pair_of,
)
from normalbench.bench.shaders.languages.wiring import candidates

pytestmark = pytest.mark.usefixtures("slang")


def test_hundreds_of_pairs_are_found_in_seconds():
    """The time grows with the number of pairs if names match; it was once 60 s for 300 pairs."""
    began = time.process_time()
    with pytest.raises(SeveralPairsError) as several:
        pair_of(many(1000, "Decode{}"), None, "mine.hlsl")
    assert len(several.value.named) == 1000
    pair = pair_of(many(1000, "Unpack{}"), ("Encode3", "Unpack997"), "mine.hlsl")
    assert pair.named == "Encode3:Unpack997"
    assert (taken := time.process_time() - began) < 5, f"{taken:.1f} s"


def test_candidates_among_hundreds_of_pairs_are_found_in_seconds():
    """The candidates are searched again for each pair that is tried."""
    began = time.process_time()
    assert len(candidates(many(1000, "Decode{}"))) == 1000
    assert candidates(many(1000, "UnpackOf{}")) == []
    assert (taken := time.process_time() - began) < 5, f"{taken:.1f} s"
