"""Test objects that fill the image and reflect the most varied part of their environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from scipy.ndimage import uniform_filter

from ....gbuffer.environment.environment import Environment, directions
from ....gbuffer.scenes.built_in.studio import panel
from ....gbuffer.scenes.mesh import Mesh, sphere
from ....gbuffer.scenes.metal_rough import MetalRough
from ....gbuffer.scenes.scene import Light, Scene, ScenePart, View

# From so far the rays of a picture are nearly parallel; all objects are two wide and two high.
DISTANCE = 57.0
WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
# The sun that lights what is dull: from beside the camera, so that the sphere has all angles to it.
SUN_COLOUR, SUN_FROM = (3.0, 3.0, 3.0), (1.0, 1.0, 1.0)
# A window of so many degrees is what the flattest panel reflects.
WINDOW = 8.0
# Beyond this latitude, in degrees, a picture of all directions is drawn out.
HIGHEST = 60.0


@dataclass(frozen=True)
class Kind:
    """A test object.

    Attributes:
        mesh: function that makes its surface.
        is_metal: whether the object is a metal that reflects its whole environment; otherwise it is white and dull,
            and lit only by a sun.
    """

    mesh: Callable[[], Mesh]
    is_metal: bool = True


OBJECTS: Mapping[str, Kind] = MappingProxyType(
    {
        "sphere": Kind(lambda: sphere(1.0, 96, 48)),
        "panel20": Kind(lambda: panel(2.0, 2.0, 20.0, 10.0, 32)),
        "panel4": Kind(lambda: panel(2.0, 2.0, 4.0, 2.0, 32)),
        "plaster": Kind(lambda: sphere(1.0, 96, 48), is_metal=False),
    }
)


@dataclass(frozen=True)
class Shown:
    """An object that a camera sees alone, under an environment or, without one, in the light of a sun."""

    name: str
    environment: Environment | None
    part: ScenePart
    view: View

    def scene(self, roughness: float) -> Scene:
        """Return a scene with the object at this roughness, under its environment or otherwise in the sun."""
        material = MetalRough(WHITE, float(OBJECTS[self.name].is_metal), roughness)
        direction = tuple(-float(x) / np.sqrt(3) for x in SUN_FROM)
        lights = () if self.environment else (Light("sun", SUN_COLOUR, direction=direction),)
        return Scene((self.part,), (material,), lights, BLACK, self.view, self.view, environment=self.environment)


def shown(name: str, environment: Environment | None) -> Shown:
    """Return an object whose centre reflects the most varied direction of an environment to the camera."""
    back = busiest(environment) if environment else np.array([0.0, 0.0, 1.0])
    right = np.cross((0.0, 1.0, 0.0), back)
    right /= np.linalg.norm(right)
    model = np.eye(4)
    model[:3, :3] = np.stack([right, np.cross(back, right), back], axis=1)
    x, y, z = map(float, back * DISTANCE)
    fov = float(np.degrees(2 * np.arctan(1 / DISTANCE)))
    view = View((x, y, z), (0.0, 0.0, 0.0), fov, DISTANCE - 2, DISTANCE + 2)
    return Shown(name, environment, ScenePart(OBJECTS[name].mesh(), model[None], np.array([0]), casts=False), view)


def busiest(environment: Environment) -> np.ndarray:
    """Return the unit direction, (3,), around which the logarithm of an environment's brightness varies most within
    WINDOW degrees; at most HIGHEST degrees from the horizon."""
    light = np.log2(environment.radiance.mean(axis=-1, dtype=np.float64) + 1e-3)
    height = len(light)
    window = max(round(WINDOW / 180 * height), 3)
    # At the poles it wraps the wrong way, where nothing is looked for.
    mean, square = (uniform_filter(x, window, mode="wrap") for x in (light, light**2))
    polar = (np.arange(height) + 0.5) / height * np.pi
    spread = np.where(np.abs(np.degrees(polar) - 90)[:, None] < HIGHEST, square - mean**2, -1.0)
    row, column = np.unravel_index(int(spread.argmax()), spread.shape)
    return directions(height)[row, column]
