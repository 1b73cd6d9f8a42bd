"""Environments from formulas, and the directions of texels."""

import numpy as np
import pytest

from normalbench.gbuffer.environment.catalogue import ENVIRONMENTS
from normalbench.gbuffer.environment.environment import directions, solid_angles
from normalbench.gbuffer.environment.made import drawn
from normalbench.gbuffer.environment.sky import SUN, SUN_IRRADIANCE
from normalbench.gbuffer.environment.sun import without_sun
from normalbench.gbuffer.scenes.built_in.studio import FLOOR, WALL
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting


@pytest.fixture(scope="module", params=ENVIRONMENTS)
def environment(request):
    return ENVIRONMENTS[request.param].make()


def test_texel_directions_follow_the_documented_layout():
    """The first row is up, the middle is -z, and to the right of it is +x."""
    towards = directions(64)
    assert towards.shape == (64, 128, 3)
    assert towards[0, :, 1].min() > 0.999 and towards[-1, :, 1].max() < -0.999
    assert towards[32, 64] == pytest.approx([0, 0, -1], abs=0.05)
    assert towards[32, 96] == pytest.approx([1, 0, 0], abs=0.05)
    assert towards[32, 0] == pytest.approx([0, 0, 1], abs=0.05)
    assert np.linalg.norm(towards, axis=-1) == pytest.approx(np.ones((64, 128)))


@pytest.mark.parametrize("height", [8, 256])
def test_solid_angles_add_up_to_the_sphere(height):
    assert solid_angles(height).shape == (height, 1)
    assert solid_angles(height).sum() * 2 * height == pytest.approx(4 * np.pi, rel=1e-12)


def test_environment_is_512_x_256_and_reproducible(environment):
    again = ENVIRONMENTS[environment.name].make()
    assert environment.radiance.shape == (256, 512, 3) and environment.radiance.dtype == np.float32
    assert np.isfinite(environment.radiance).all() and environment.radiance.min() >= 0.02
    assert np.array_equal(environment.radiance, again.radiance)
    with pytest.raises(ValueError, match="read-only"):
        environment.radiance[0, 0] = 0


def test_the_studio_has_no_sun_and_a_contrast_of_hundreds():
    studio = ENVIRONMENTS["studio"].make()
    assert without_sun(studio) is studio
    assert 10 < studio.radiance.max() <= 20 and np.median(studio.radiance) < 0.1
    assert studio.radiance.max() / studio.radiance.min() > 500


def test_the_studios_grid_has_fine_lines_with_soft_edges():
    """Along a row of the wall towards +z, radiance rises and falls with each line, through many values."""
    studio = ENVIRONMENTS["studio"].make().radiance[..., 1]
    row = np.roll(studio, 256, axis=1)[124, 226:286]
    peaks = (row[1:-1] > row[:-2]) & (row[1:-1] >= row[2:]) & (row[1:-1] > 0.3)
    assert peaks.sum() >= 8, row
    assert len(np.unique(row.round(3))) > 6


def test_mirrors_in_the_studio_scene_show_its_room():
    """The floor is below and the back wall ahead, each of uniform light; the environment is above and behind."""
    scene, whole = SCENES["studio"].make(Setting()), ENVIRONMENTS["studio"].make().radiance
    assert scene.environment is not None
    seen, towards = scene.environment.radiance, directions(256)
    floor, wall = seen[-1, 0], seen[128 - 20, 256]
    ahead = (towards[..., 2] < -0.95) & (towards[..., 1] > 0)
    assert np.all(seen[towards[..., 1] < -0.5] == floor) and np.all(seen[ahead] == wall)
    # A room of few lamps: between what the darkest and the lightest part of it would light a floor to.
    assert 0.1 < floor[1] / FLOOR.base[1] < 5 and 0.1 < wall[1] / WALL.base[1] < 5
    unseen = (towards[..., 1] > 0.95) | (towards[..., 2] > 0.9) & (towards[..., 1] > 0.3)
    assert np.array_equal(seen[unseen], whole[unseen])


def test_the_sun_is_removed_from_the_sky_completely():
    sky = ENVIRONMENTS["sky"].make()
    assert sky.radiance.max() > 1e4
    sunless = without_sun(sky)
    towards, irradiance = np.negative(sunless.sun[0]), np.array(sunless.sun[1])
    assert np.degrees(np.arccos(towards @ SUN)) < 0.1
    assert irradiance == pytest.approx(SUN_IRRADIANCE, rel=0.02)
    assert sunless.radiance.max() <= 30


def test_the_sky_is_brighter_than_the_ground():
    sky = without_sun(ENVIRONMENTS["sky"].make()).radiance.mean(-1)
    assert sky[:120].min() > 2 * sky[140:].max()


def test_a_texel_is_the_mean_over_its_area():
    """A half-lit texel has half the light, and each row is averaged by area."""
    assert drawn(lambda towards: np.ones_like(towards), 8) == pytest.approx(np.ones((8, 16, 3)))
    half = drawn(lambda towards: (towards[..., :1] > 0) * np.ones(3), 8)
    assert half[:, 8:].min() == 1 and half[:, :8].max() == 0
    at_x = drawn(lambda towards: (towards[..., :1] > np.sin(np.pi / 16)) * np.ones(3), 8)[3:5, 8, 0]
    assert ((at_x > 0.2) & (at_x < 0.8)).all(), at_x
