"""What is looked at: an object that fills the picture, turned to where its environment is busiest."""

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
from ....gbuffer.scenes.scene import Scene, ScenePart, View

# From so far the rays of a picture are nearly parallel; all objects are two wide and two high.
DISTANCE = 57.0
# The colour of a metal that reflects all light.
METAL = (1.0, 1.0, 1.0)
# A window of so many degrees is what the flattest panel reflects.
WINDOW = 8.0
# Beyond this latitude, in degrees, a picture of all directions is drawn out.
HIGHEST = 60.0

OBJECTS: Mapping[str, Callable[[], Mesh]] = MappingProxyType(
    {
        "sphere": lambda: sphere(1.0, 96, 48),
        "panel20": lambda: panel(2.0, 2.0, 20.0, 10.0, 32),
        "panel4": lambda: panel(2.0, 2.0, 4.0, 2.0, 32),
    }
)


@dataclass(frozen=True)
class Shown:
    """An object under an environment, before a camera that sees nothing else."""

    name: str
    environment: Environment
    part: ScenePart
    view: View

    def scene(self, roughness: float) -> Scene:
        """It, of a metal that reflects all light."""
        metal = MetalRough(METAL, 1.0, roughness)
        none = (0.0, 0.0, 0.0)
        return Scene((self.part,), (metal,), (), none, self.view, self.view, environment=self.environment)


def shown(name: str, environment: Environment) -> Shown:
    """An object whose middle reflects the busiest direction of an environment to the camera."""
    back = busiest(environment)
    right = np.cross((0.0, 1.0, 0.0), back)
    right /= np.linalg.norm(right)
    model = np.eye(4)
    model[:3, :3] = np.stack([right, np.cross(back, right), back], axis=1)
    x, y, z = map(float, back * DISTANCE)
    fov = float(np.degrees(2 * np.arctan(1 / DISTANCE)))
    view = View((x, y, z), (0.0, 0.0, 0.0), fov, DISTANCE - 2, DISTANCE + 2)
    return Shown(name, environment, ScenePart(OBJECTS[name](), model[None], np.array([0]), casts=False), view)


def busiest(environment: Environment) -> np.ndarray:
    """The direction around which brightness varies most within a window, unit, (3,)."""
    light = np.log2(environment.radiance.mean(axis=-1, dtype=np.float64) + 1e-3)
    height = len(light)
    window = max(round(WINDOW / 180 * height), 3)
    # At the poles it wraps the wrong way, where nothing is looked for.
    mean, square = (uniform_filter(x, window, mode="wrap") for x in (light, light**2))
    polar = (np.arange(height) + 0.5) / height * np.pi
    spread = np.where(np.abs(np.degrees(polar) - 90)[:, None] < HIGHEST, square - mean**2, -1.0)
    row, column = np.unravel_index(int(spread.argmax()), spread.shape)
    return directions(height)[row, column]
