"""The reference rays for ambient occlusion, compared with closed forms."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from drawing import scene_of
from occluded import CLOSED, scene_of_meshes

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.measures.metrics.occlusion_error import compared, method_error
from normalbench.bench.measures.metrics.visibility import RayCaster, cosine_directions, triangles_of
from normalbench.gbuffer.effects.effect import ChosenEffect, Effect, EffectError
from normalbench.gbuffer.frame.resource import Resource

UP = np.array([[0.0, 1.0, 0.0]])


RAYS = 200_000


def anything(distance: np.ndarray) -> np.ndarray:
    return (distance < 1e30).astype(float)


def seen(meshes, lost=anything, rays=RAYS):
    """Return the visibility from just above the middle of the floor."""
    return RayCaster(triangles_of(scene_of_meshes(*meshes))).visible(1e-4 * UP, UP, rays, lost)


@pytest.mark.parametrize("name", CLOSED)
def test_rays_match_the_closed_form(name):
    """The standard error is below 0.002, and the difference may be three standard errors. A 128-sided polygon lacks
    0.0004 of the area of a circle."""
    meshes, expected = CLOSED[name]
    visible = seen(meshes)
    off, error = abs(visible.visibility[0] - expected), visible.error[0]
    assert error < 0.002
    assert off <= 3 * error + 5e-4 * (1 - expected), (
        f"{name}: {visible.visibility[0]:.5f}, not {expected:.5f}; {error:.1g}"
    )


def test_the_standard_error_matches_the_scatter_over_seeds():
    """200 seeds agree within 20%, which is four standard deviations of such an estimate."""
    caster = RayCaster(triangles_of(scene_of_meshes(*CLOSED["deep pit"][0])))
    each = [caster.visible(1e-4 * UP, UP, 256, anything, seed) for seed in range(200)]
    scatter = np.std([estimate.visibility[0] for estimate in each])
    error = np.mean([estimate.error[0] for estimate in each])
    assert scatter == pytest.approx(error, rel=0.2)


def test_occlusion_is_weighted_by_distance():
    """From the bottom of a pit all occluders are far: a limit of 0.3 m removes the occlusion, and a weight of 0.25
    leaves a quarter of it."""
    meshes, expected = CLOSED["deep pit"]
    near = seen(meshes, lambda t: (t < 0.3).astype(float)).visibility[0]
    quarter = seen(meshes, lambda t: 0.25 * anything(t))
    assert near == 1.0
    assert abs(quarter.visibility[0] - (1 - 0.25 * (1 - expected))) <= 3 * quarter.error[0]


def test_the_bent_normal_points_to_the_open_side():
    """Next to a ball the bent normal points away from the ball; in the open it is 2/3 of the normal, the mean
    cosine."""
    open_floor, beside = seen(CLOSED["dome"][0][:1]), seen(CLOSED["near dome"][0])
    assert np.abs(open_floor.bent[0] - [0, 2 / 3, 0]).max() < 0.005
    assert beside.bent[0, 0] < -0.05


def test_directions_are_cosine_distributed():
    """Over tilted normals the means of cos and cos squared are 2/3 and 1/2, to 0.005."""
    normals = np.array([(1.0, 0, 0), (0, 0, -1.0), (0.6, 0.0, 0.8)])
    cosine = np.einsum("nri,ni->nr", cosine_directions(normals, 20000, np.random.default_rng(1)), normals)
    assert cosine.min() >= 0
    assert np.abs(cosine.mean(axis=1) - 2 / 3).max() < 0.005 and np.abs((cosine**2).mean(axis=1) - 1 / 2).max() < 0.005


def test_glass_does_not_block_rays():
    """Rays use all triangles of the room except the 36 of its three panes."""
    room = scene_of("room")
    total = sum(len(part.mesh.triangles) * len(part.models) for part in room.parts)
    assert len(triangles_of(room)) == total - 3 * 12


def test_noise_in_the_rays_is_not_counted_as_the_methods_error():
    """With noisy rays, an exact method has an RMS near 0 and a method off by 0.1 has 0.1, to four standard errors."""
    rng = np.random.default_rng(0)
    noise = np.full(4000, 0.02)
    exact = 0.5 + rng.normal(0, 0.02, 4000)
    none, some = (compared(np.full(4000, v), exact, noise) for v in (0.5, 0.6))
    assert none.rms**2 <= 4 * 0.02**2 * np.sqrt(2 / 4000)
    assert abs(some.rms - 0.1) <= 4 * some.standard_error and abs(some.mean - 0.1) < 0.002


def test_missing_embree_is_a_one_line_error_that_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "embreex", None)
    monkeypatch.setitem(sys.modules, "embreex.mesh_construction", None)
    with pytest.raises(MissingError, match=r"^rays need embreex \(.+\); pip install embreex$"):
        RayCaster(np.zeros((1, 3, 3)))


def test_an_effect_other_than_ambient_occlusion_is_refused(gl):
    other = ChosenEffect(Effect("fog", "fog", "a test", Resource("fog", "r32f"), lambda **_: ()), ())
    with pytest.raises(EffectError, match=r"^effect fog is not an ambient occlusion method$"):
        method_error(gl, other, scene_of("room"), (16, 12))
