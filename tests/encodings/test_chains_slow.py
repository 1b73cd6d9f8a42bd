"""Chains: an encoding of the decoded result of another codec."""

import numpy as np
from test_chains import CHAIN, codec, directions

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.tables.quality.measure import round_trip


def test_a_chain_applies_one_codec_after_the_other():
    """The results agree to a unit in the last place of the normals that are renormalised in between."""
    n = directions(4096)
    first = round_trip(codec("octahedral", "rgb8_12_12"), n, n)
    first = first / np.linalg.norm(first, axis=1, keepdims=True)
    expected = round_trip(codec("xyz_renormalised"), first, n)
    apart = angles_deg(expected, round_trip(codec(CHAIN), n, n))
    assert np.quantile(apart, 0.99) < 1e-4, f"{np.quantile(apart, 0.99):.2g} degrees"
