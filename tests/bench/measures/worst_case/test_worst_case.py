"""Suprema by search: compared with geometry and with samples, and found within a time limit."""

import jax
import numpy as np
import pytest
from exact_codes import fibonacci

from normalbench.bench.measures.worst_case import cells, climb
from normalbench.bench.measures.worst_case.climb import KEPT, WAYS, Ground, Starts, highest
from normalbench.bench.measures.worst_case.exact_codec import ExactCodec, unit
from normalbench.bench.measures.worst_case.search import spread
from normalbench.bench.subjects.normals.normal_sets import axes, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec3


def codec_of(encoding: str, where: str, rounding: str = "nearest") -> Codec:
    return Codec(ENCODINGS[encoding], STORAGES[where], rounding)


@pytest.mark.parametrize("axis", range(3))
def test_near_an_axis_the_small_components_follow_from_the_largest(axis):
    """a^2 + b^2 = (1 - c)(1 + c), where 1 - c is an integer multiple of 2^-53."""
    turn = np.linspace(0, 2 * np.pi, 100)
    off = np.geomspace(1e-8, 0.3, 100)
    n = np.roll([np.sin(off) * np.cos(turn), np.sin(off) * np.sin(turn), -np.cos(off)], axis, axis=0)
    with jax.enable_x64(True):
        units = np.roll(np.stack([np.asarray(c) for c in unit(Vec3(*n))]), -axis, axis=0)
    np.testing.assert_array_equal(units[2], -np.cos(off))
    squared = units[0] ** 2 + units[1] ** 2
    np.testing.assert_allclose(squared, (1 + units[2]) * (1 - units[2]), rtol=1e-15)
    assert np.abs(units - np.roll(n, -axis, axis=0)).max() < 2e-8


def test_away_from_the_axes_a_normal_is_unchanged():
    """Equal components stay equal."""
    n = np.array([[0.6, -0.8, 0.0], [1.0, 1.0, 1.0], [0.5**0.5, 0.0, -(0.5**0.5)]]).T
    with jax.enable_x64(True):
        np.testing.assert_array_equal(np.stack([np.asarray(c) for c in unit(Vec3(*n))]), n)


def test_duplicate_directions_are_removed():
    random = np.random.default_rng(2)
    directions = random.integers(-2, 3, (3, 500)).astype(float)
    distinct, expected = cells._distinct(directions), np.unique(directions, axis=1)
    assert distinct.shape == expected.shape and {*map(tuple, distinct.T)} == {*map(tuple, expected.T)}


def uneven(count: int) -> np.ndarray:
    """Return directions at all heights z, within a sector of 20 degrees."""
    z, turn = np.random.default_rng(4).uniform([[-1], [0]], [[1], [np.pi / 9]], (2, count))
    r = np.sqrt(1 - z * z)
    return np.stack([*(r * [np.cos(turn), np.sin(turn)]), z])[:, np.argsort(z)]


def three_rings(count: int) -> np.ndarray:
    """Return directions on three circles around z, with empty bands between the circles."""
    z = np.repeat([-0.97, 0.0, 0.97], count)
    turn = np.random.default_rng(5).uniform(0, 2 * np.pi, 3 * count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z])


GIVEN = {"even": fibonacci(2000).T, "uneven": uneven(2000), "rings": three_rings(500)}


@pytest.mark.parametrize("directions", GIVEN.values(), ids=GIVEN)
def test_a_hull_computed_in_bands_has_every_face(directions):
    """If directions are far apart, no band contains all corners of a face; then a single hull is used."""
    banded, whole = cells.across_faces(directions), cells._hull(directions)[:3]
    assert banded.shape == whole.shape
    banded, whole = (side[:, np.lexsort(side.round(9))] for side in (banded, whole))
    assert banded == pytest.approx(whole, abs=1e-9)


def test_faces_of_evenly_spread_directions_are_found_in_bands(monkeypatch):
    """One hull is computed for each band, and none for the whole set."""
    seen, hull = [], cells._hull
    monkeypatch.setattr(cells, "_hull", lambda directions: seen.append(directions.shape[1]) or hull(directions))
    cells.across_faces(fibonacci(20000).T)
    assert len(seen) == cells.BANDS and max(seen) < 20000 / 8


def test_a_second_round_climbs_from_each_starting_point_once(monkeypatch):
    """A second block of the same starting points would climb like the first."""
    counts, climb_from = [], climb._climb_from
    monkeypatch.setattr(climb, "_climb_from", lambda *args: counts.append(len(args[1].chords)) or climb_from(*args))
    ways = np.geomspace(1e-3, 1.0, WAYS)[:, None] * (-1.0) ** np.arange(WAYS)[:, None]
    ground = Ground(
        chords=lambda places: -((places[0] - 1.0) ** 2),
        around=lambda places, sizes, _: (places[0] + ways * sizes)[None],
        errors=np.ones_like,
        degrees=float,
        lanes=KEPT,
    )
    peaks, _ = highest(ground, Starts(np.full(4 * KEPT, -1.0), np.zeros((1, 4 * KEPT))), 4 * KEPT, (1.0, 0.1))
    assert peaks.places[0] == pytest.approx(1.0) and set(counts) == {KEPT}
    assert len(counts) < 4 + 4, f"{len(counts)} blocks were climbed over"


@pytest.mark.parametrize("is_half", [False, True])
def test_candidates_around_a_normal_are_at_four_distances(is_half):
    """Candidates are unit normals at the tangents of the sizes, in sixteen directions around the normal."""
    random = np.random.default_rng(3)
    n = random.normal(size=(3, 64))
    n /= np.linalg.norm(n, axis=0)
    n[2] = np.abs(n[2]) + 0.1 if is_half else n[2]
    n /= np.linalg.norm(n, axis=0)
    around = ExactCodec(codec_of("octahedral", "rg8"), is_half).around(n, np.full(64, 1e-2), 5)
    assert np.linalg.norm(around, axis=0) == pytest.approx(1, abs=1e-14)
    tangents = np.linalg.norm(np.cross(around, n[:, None], axis=0), axis=0) / (around * n[:, None]).sum(axis=0)
    assert tangents == pytest.approx(np.tile([[1e-2], [4e-3], [1.6e-3], [6.4e-4]], (4, 64)), rel=1e-9)
    # All around: each set of four sums to nothing.
    assert (around - n[:, None])[:, ::4].mean(axis=1) == pytest.approx(0, abs=1e-4)


def test_starting_directions_are_evenly_spread_and_in_the_domain():
    n = np.concatenate([make() for make in spread(2**18, False)], axis=1)
    assert n.mean(axis=1) == pytest.approx([0, 0, 0], abs=1e-4)
    assert (n * n).mean(axis=1) == pytest.approx([1 / 3] * 3, abs=1e-4)
    assert min(make()[2].min() for make in spread(2**18, True)) >= 0


def test_the_supremum_of_a_finite_set_is_its_maximum():
    row = quality.measure(quality.QualityCase(codec_of("octahedral", "rg8"), axes(), "jax", True))
    assert row["angle_sup_deg"] == row["angle_max_deg"] and row["sup_found_by"] == "every normal"
    assert row["sup_x"] is None and row["domain"] is None


def test_ordinary_rows_do_not_search():
    row = quality.measure(quality.QualityCase(codec_of("octahedral", "rg8"), sphere(1000), "jax"))
    assert row["angle_sup_deg"] is None and row["codes_unused"] is None
