"""Executed issue slots: loop iterations and the totals that follow from a listing."""

import numpy as np
import pytest

from normalbench.bench.tables.cost import executed
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.codecs.loops import turns_made


def normals(count: int = 512) -> np.ndarray:
    n = np.zeros((count, 4), np.float32)
    n[:, :3] = np.random.default_rng(3).normal(size=(count, 3))
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def test_the_bisection_of_optimised_rings_takes_eight_turns(gl):
    """For 180 rings, most codes take log2(180) turns, rounded up."""
    n = normals()
    _, decoded = turns_made(gl, ENCODINGS["optimised_rings"], n, np.zeros_like(n))
    bisected = decoded[:, -1]
    assert set(np.unique(bisected)) == {7.0, 8.0} and bisected.mean() == pytest.approx(7.9, abs=0.1)


def test_slots_in_a_loop_are_counted_once_per_turn():
    """By hand: 1 + 2 slots outside, 2 in an outer loop that runs 4 times, 2 in an inner loop that runs 12 times."""
    kinds, rates = ["a", "b", "a", "c", "a", "b"], {"a": 1, "b": 2}
    loops = [range(1, 5), range(2, 5)]
    assert executed.executed_slots(kinds, rates, [], []) == 7
    assert executed.executed_slots(kinds, rates, loops, [[4.0, 0.5], [12.0, 0.5]]) == 1 + 4 * 2 + 12 * 2 + 2
    # What the text has more was unrolled: what runs longest and varies stays.
    turns = [[3.0, 0.0], [4.0, 0.5], [12.0, 0.5]]
    assert executed.executed_slots(kinds, rates, loops, turns) == 35
    assert executed.executed_slots(kinds, rates, loops, turns[:1]) is None
