"""The playground's four lamp arms: the statistics of the original arms, and the shapes of the parts."""

from functools import cache

import numpy as np
import pytest

from normalbench.gbuffer.scenes.built_in.playground import ARMS, CAMERA, in_view_space, playground
from normalbench.gbuffer.scenes.mesh import facing, joined
from normalbench.gbuffer.scenes.models.lamp_arm import disc, faceted, lamp_arm, plate, swept, turned
from normalbench.gbuffer.scenes.rasterise import rasterise

NEGATIVE, AWAY = 8.3, 0.74


BY_Z = (0.01, 0.06, 0.08, 0.11, 0.27, 0.54, 1.27, 1.93, 4.06, 3.03, 3.16, 5.06, 4.91, 6.59, 9.86, 7.56, 11.5, 28.8)


BY_Z += (11.2,)


BY_FACING = (0.01, 0.05, 0.09, 0.18, 0.42, 1.09, 2.32, 4.52, 8.10, 10.6, 11.8, 16.3, 11.4, 13.7, 19.4)


@cache
def seen() -> tuple[np.ndarray, np.ndarray]:
    """Return the visible normals of the arms and the directions to the eye: (pixels, 3) each."""
    whole, rest = playground(), rasterise(facing(joined(in_view_space()[: -len(ARMS)])), CAMERA)
    of_arms = whole.covered & np.any(whole.positions != rest.positions, axis=-1)
    normals, positions = (a[of_arms].astype(np.float64) for a in (whole.normals, whole.positions))
    return normals, -positions / np.linalg.norm(positions, axis=1, keepdims=True)


def percent(values: np.ndarray, steps: int) -> np.ndarray:
    """Return the percentages of values up to 1 in steps of 0.1; lower values count in the first step."""
    edges = np.linspace(1 - 0.1 * steps, 1, steps + 1)
    return 100 * np.histogram(np.clip(values, edges[0], 1), edges)[0] / len(values)


def test_the_shares_with_negative_z_and_facing_away_match_the_original():
    normals, to_eye = seen()
    assert 100 * np.mean(normals[:, 2] < 0) == pytest.approx(NEGATIVE, abs=0.5)
    assert 100 * np.mean(np.sum(normals * to_eye, axis=1) < 0) == pytest.approx(AWAY, abs=0.06)


def test_the_normals_of_the_arms_are_distributed_like_the_original():
    """A bin differs by at most about half of its share, and by at most 5 percentage points."""
    normals, to_eye = seen()
    for values, expected in ((normals[:, 2], BY_Z), (np.sum(normals * to_eye, axis=1), BY_FACING)):
        shares, known = percent(values, len(expected)), np.array(expected)
        assert np.all(abs(shares - known) <= np.minimum(0.55 * known + 0.02, 5.0)), f"{shares.round(2)}, not {known}"


def test_every_normal_has_length_1_and_every_part_is_in_the_arm():
    arm = lamp_arm()
    assert np.allclose(np.linalg.norm(arm.normals, axis=1), 1, atol=1e-9)
    assert len(arm.triangles) < 1500, "it is coarse"
    # Flat parts lie in the arm's plane; its round parts have normals of all directions.
    assert np.mean(abs(arm.normals[:, 1]) > 1 - 1e-9) > 0.1


def test_a_ring_has_flat_ends_and_a_hole():
    ring = disc(1.0, 0.2, 16, hole=0.5, bulge=0.1)
    out = np.hypot(ring.positions[:, 0], ring.positions[:, 2])
    assert out.min() == pytest.approx(0.5) and out.max() == pytest.approx(1.1)
    inner, flat = np.isclose(out, 0.5), abs(ring.normals[:, 1]) > 1 - 1e-9
    towards = np.sum(ring.positions[:, (0, 2)] * ring.normals[:, (0, 2)], axis=1)
    assert np.all(towards[inner & ~flat] < 0) and np.all(towards[~inner & ~flat] > 0)
    assert np.allclose(abs(ring.positions[flat, 1]), 0.2)
    assert np.all(ring.positions[flat, 1] * ring.normals[flat, 1] > 0)


def test_a_tubes_normals_point_away_from_its_path():
    path = np.array([(0.0, 0.0, 0.0), (1.0, 0.2, 0.0), (2.0, 0.0, 1.0)])
    tube = swept(path, (0.2, 0.2, 0.1), 8)
    around, side = np.repeat(path, 9, axis=0), slice(27)
    assert np.allclose(np.linalg.norm(tube.positions[side] - around, axis=1), np.repeat([0.2, 0.2, 0.1], 9))
    assert np.all(np.sum((tube.positions[side] - around) * tube.normals[side], axis=1) > 0.08)
    # Two flat ends, which face away from each other.
    ends = tube.normals[27:].reshape(2, 18, 3)
    assert np.allclose(ends, ends[:, :1]) and np.all(ends[:, 0] @ (path[1] - path[0]) * (-1, 1) > 0)


def test_a_plate_is_flat_and_its_rim_faces_outwards():
    mesh = plate(np.array([0.0, 0.0]), np.array([2.0, 1.0]), 0.4, 0.3, 0.1)
    flat = abs(mesh.normals[:, 1]) > 1 - 1e-9
    assert np.all(mesh.positions[flat, 1] * mesh.normals[flat, 1] > 0)
    assert np.allclose(mesh.normals[~flat, 1], 0, atol=1e-9)


def test_the_corners_of_a_facet_share_the_normal_of_the_triangle():
    shade = faceted(turned([(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)], 6))
    a, b, c = np.moveaxis(shade.positions[shade.triangles], 1, 0)
    across = np.cross(b - a, c - a)
    across = across / np.linalg.norm(across, axis=1, keepdims=True)
    assert np.allclose(shade.normals[shade.triangles], across[:, None], atol=1e-9)
