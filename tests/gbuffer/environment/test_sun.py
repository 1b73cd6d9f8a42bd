"""The sun of an environment, replaced by a light of equal irradiance, and lamps that are not suns."""

import numpy as np
import pytest

from normalbench.gbuffer.environment.environment import Environment, directions, solid_angles
from normalbench.gbuffer.environment.sun import MOST, found_sun, without_sun

HEIGHT = 128


def sky_with(texels, base=0.5):
    """Return a grey sky with bright texels, each given as (row, column, radiance)."""
    radiance = np.full((HEIGHT, 2 * HEIGHT, 3), base, np.float32)
    for row, column, light in texels:
        radiance[row, column] = light
    return Environment("sky", radiance, changes=("cropped",))


def irradiance(environment, n):
    """Return the irradiance of a surface with normal n, from the environment's image and its sun."""
    cosine = np.maximum(directions(HEIGHT) @ n, 0) * solid_angles(HEIGHT)
    light = (environment.radiance.astype(np.float64) * cosine[..., None]).sum((0, 1))
    if environment.sun is not None:
        goes, colour = environment.sun
        light = light + max(0, -np.dot(goes, n)) * np.array(colour)
    return light


SUN = [(30, 40, (5000, 4000, 2000)), (30, 41, (9000, 8000, 3000)), (31, 41, (2000, 100, 20)), (29, 41, (25, 20, 10))]


@pytest.mark.parametrize("n", [(0, 1, 0), (-1, 0, 0), (-0.6, 0.64, 0.48)])
def test_surfaces_get_the_same_light_without_the_sun(n):
    """A small difference remains, because the sun's colours vary and the light has a single direction."""
    whole = sky_with(SUN)
    parted = without_sun(whole)
    n = np.array(n) / np.linalg.norm(n)
    assert irradiance(parted, n) == pytest.approx(irradiance(whole, n), rel=2e-3)


def test_the_light_comes_from_the_middle_of_the_sun():
    parted = without_sun(sky_with(SUN))
    assert np.linalg.norm(parted.sun[0]) == pytest.approx(1)
    assert np.degrees(np.arccos(-directions(HEIGHT)[30, 41] @ parted.sun[0])) < 1
    assert parted.radiance.max() == MOST and parted.radiance[29, 41].tolist() == [25, 20, 10]
    assert parted.name == "sky" and parted.changes == ("cropped", "sun above 30 moved to a separate light")
    assert parted.radiance.dtype == np.float32


def test_a_sun_across_the_seam_is_a_single_sun():
    sun = found_sun(sky_with([(40, 0, 900), (40, 2 * HEIGHT - 1, 900)]).radiance)
    assert sun is not None and sun.towards[2] > 0.8 and abs(sun.towards[0]) < 1e-12


@pytest.mark.parametrize(
    "texels", [[], [(30, 40, 29.9)], [(30, 40, 900), (90, 200, 900)], [(30, column, 900) for column in range(40, 60)]]
)
def test_skies_without_a_sun_are_unchanged(texels):
    """The skies have nothing bright, two separate lamps, or a window."""
    whole = sky_with(texels)
    assert without_sun(whole) is whole


def test_a_sun_is_removed_only_once():
    """After the first call, the sun's light is already a light of the environment."""
    once = without_sun(sky_with(SUN))
    assert without_sun(once).sun == once.sun and "sun" in once.changes[-1]
