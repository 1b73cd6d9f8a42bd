"""Measured time as a cost: arithmetic on simulated clocks, and rows for a device and for JAX."""

import math
from contextlib import ExitStack

import numpy as np
import pytest

from normalbench.bench.tables.cost import clocks as cost_clocks
from normalbench.bench.tables.cost.clocks import LEAST_TURNS, MOST_TURNS, Field, Pair, Passes, median_interval, summary
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines import kernels
from normalbench.gbuffer.gl.device import read_pixels

PIXELS = 4096


def clock_of(operation_ns: float, empty_ns: float, start_ms: float = 0.7):
    """Return a clock whose passes take `start_ms` milliseconds, plus some nanoseconds per pixel and turn."""
    return lambda which, turns: start_ms + turns * PIXELS * (empty_ns if which else operation_ns) * 1e-6


@pytest.mark.parametrize("operation, empty", [(3.0, 0.5), (40.0, 2.0), (0.25, 0.25), (1.0, 1.5)])
def test_difference_is_the_extra_time_of_the_operation(operation, empty):
    """A nanosecond per pixel is a million nanoseconds per megapixel, however long the start of a pass takes."""
    assert Pair(clock_of(operation, empty), PIXELS).difference() == pytest.approx((operation - empty) * 1e6)


def test_a_pass_that_is_disturbed_does_not_count():
    """One undisturbed pass of each kind is enough."""
    quiet, calls = clock_of(3.0, 0.5), []

    def disturbed(which: int, turns: int) -> float:
        calls.append(which)
        return quiet(which, turns) + (5.0 if calls.count(which) % cost_clocks.PASSES else 0.0)

    pair = Pair(quiet, PIXELS)
    pair._milliseconds = disturbed
    assert pair.difference() == pytest.approx(2.5e6)


def test_a_pass_has_enough_turns_within_the_limits():
    long, endless = Pair(clock_of(3.0, 0.5), PIXELS), Pair(clock_of(1e-9, 1e-9, 0.0), PIXELS)
    assert clock_of(3.0, 0.5)(0, long.turns) >= cost_clocks.PASS_MS / 2 and long.turns > LEAST_TURNS
    assert endless.turns == MOST_TURNS
    assert Pair(clock_of(1e6, 0.5), PIXELS).turns == LEAST_TURNS


def test_a_summary_is_the_median_and_its_interval():
    taken = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 80.0, 900.0]
    assert summary("ns_per_megapixel", taken[::-1]) == {"ns_per_megapixel": 5.0, "spread": 78.0}


@pytest.mark.parametrize("count, low, high", [(2, 1, 2), (5, 1, 5), (6, 1, 6), (9, 2, 8), (15, 4, 12), (21, 6, 16)])
def test_median_interval_has_the_stated_confidence(count, low, high):
    """The limits follow tables of the sign test; the next narrower interval would not be confident enough."""
    assert median_interval(list(range(1, count + 1))) == (low, high)

    def chance(cut: int) -> float:
        return 1 - 2 * sum(math.comb(count, k) for k in range(cut)) / 2**count

    assert count < 6 or chance(low) >= cost_clocks.SURE > chance(low + 1)


def test_each_turn_repeats_the_computation(gl):
    """The value added after each turn reaches the next, so that no compiler can compute a turn only once."""
    turns, nothing = 5, 0.25
    for numbers, operation in ((3, kernels.encode(ENCODINGS["xyz"])), (2, kernels.decode(ENCODINGS["xy"]).empty)):
        with ExitStack() as stack:
            field = Field(gl, stack, (8, 4))
            Passes(field, operation).render(0, turns, nothing)
            given = read_pixels(field.points(numbers))
            drawn = read_pixels(field.targets[0])
        expected = turns * given[..., :numbers] + nothing * sum(range(turns))
        assert np.allclose(drawn[..., :numbers], expected, atol=1e-5)
