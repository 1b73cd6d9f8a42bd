"""The solver for one word of normal and roughness, on problems whose answers are known."""

import numpy as np
import pytest

from tests.joint_word import FINE, Problem

ROUGHNESS = (0.0, 0.5, 1.0)


def problem(errors_at_one_level, slopes=(100.0, 100.0, 100.0)) -> Problem:
    """Return a problem whose error falls as 1 / levels, from these errors at one level, by roughness."""
    bits = (3, 16)
    errors = np.array(errors_at_one_level)[:, None] / 2.0 ** np.array(bits)
    return Problem(ROUGHNESS, bits, errors, slopes)


def test_levels_by_roughness_gain_nothing_where_roughness_changes_nothing():
    solved = problem((2e4, 2e4, 2e4)).solved(24)
    assert solved["joint"] == pytest.approx(solved["fixed"], rel=0.005)


def test_the_fixed_split_matches_its_closed_form():
    """L levels leave T - c / L for roughness, so S L^2 / (2 (T - c / L)) codes; the least at L = 3 c / (2 T)."""
    c, slope, bits = 2e4, 100.0, 24
    solved = problem((c, c, c)).solved(bits)["fixed"]
    levels = 1.5 * c / solved
    assert slope * levels**2 / (2 * (solved - c / levels)) == pytest.approx(2.0**bits, rel=0.02)


@pytest.mark.parametrize("power", [1, 2, 3])
def test_a_roughness_code_of_a_power_is_off_by_half_the_gap_at_most(power):
    grid = problem((2e5, 2e4, 2e3)).grid
    codes = (np.arange(64) / 63) ** power
    off = abs(grid[:, None] - codes).min(1)
    allowed = problem((2e5, 2e4, 2e3)).half_steps(6, power)
    assert (off <= allowed + 1e-9).all() and (off / allowed).max() > 0.9, (off / allowed).max()


def test_classes_reach_from_end_to_end_with_fewer_bits_for_rougher_surfaces():
    classes = problem((2e5, 2e4, 2e3), (3000.0, 300.0, 30.0)).classes(28, 4)
    ends, bits, _ = zip(*classes, strict=True)
    assert ends[-1] == 1 and list(ends) == sorted(ends) and list(bits) == sorted(bits, reverse=True), classes


def test_classes_are_better_than_a_split_and_worse_than_any_levels():
    solved = problem((2e5, 2e4, 2e3), (3000.0, 300.0, 30.0)).solved(28)
    assert solved["joint"] < solved["prefix 4"] <= solved["prefix 2"] < solved["fixed"], solved
    assert FINE[0] == 3
