"""Visibility of points in a scene, measured by rays: the reference for ambient occlusion methods.

The visibility of a point with normal n is V = (1/pi) times the integral of (1 - w(t)) cos over the hemisphere of n. A
ray travels a distance t until it meets a surface, and w is the share of light that a surface at that distance
blocks. The textbook definition has w = 1 at all distances. A method with a radius has its own w, and rays without it
would measure the fall-off instead of the method. Rays are drawn with cosine density, so V is the mean of 1 - w.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....gbuffer.scenes.scene import Scene
from ...ground.output.errors import MissingError

if TYPE_CHECKING:
    from jaxtyping import Float

# Rays in flight: some 50 MB.
BLOCK = 2**19
# Rays start closer to the eye by this share of the distance, so that float32 keeps them over their own surface. The eye
# sees the point: nothing lies between.
NEARER = 1e-4


class Visible(NamedTuple):
    """The visibility of points, measured by rays.

    Attributes:
        visibility: the visibility of each point.
        error: the standard error of each visibility.
        bent: the mean direction from which light arrives, scaled by the amount of light.
    """

    visibility: Float[np.ndarray, " points"]
    error: Float[np.ndarray, " points"]
    bent: Float[np.ndarray, "points 3"]


def triangles_of(scene: Scene) -> Float[np.ndarray, "triangles 3 3"]:
    """Return the corners of all opaque triangles of a scene (alpha 1), in world space: (triangles, 3, 3)."""
    there = [
        part.mesh.positions[part.mesh.triangles] @ model[:3, :3].T + model[:3, 3]
        for part in scene.parts
        for model, material in zip(part.models, part.materials, strict=True)
        if scene.materials[material].alpha == 1
    ]
    return np.concatenate(there) if there else np.zeros((0, 3, 3))


def require_rays() -> None:
    """Raise MissingError if the ray caster is not installed."""
    try:
        import embreex.mesh_construction  # noqa: F401 # asked for, not used
    except ImportError as error:
        raise MissingError(f"rays need embreex ({error}); pip install embreex") from error


class RayCaster:
    """A ray caster for triangles, which uses Embree in float32.

    Args:
        triangles: their corners. Both sides of a triangle stop rays.

    Raises:
        MissingError: embreex is not installed.
    """

    def __init__(self, triangles: Float[np.ndarray, "triangles 3 3"]):
        require_rays()
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self._scene = EmbreeScene(robust=True)
        TriangleMesh(self._scene, np.ascontiguousarray(triangles, np.float32))

    def distances(
        self, origins: Float[np.ndarray, "rays 3"], directions: Float[np.ndarray, "rays 3"]
    ) -> Float[np.ndarray, " rays"]:
        """Return each ray's distance to the nearest triangle; over 1e30 if the ray hits none. Directions have
        length 1."""
        given = (np.ascontiguousarray(a, np.float32) for a in (origins, directions))
        return self._scene.run(*given, query="DISTANCE")

    def visible(
        self,
        positions: Float[np.ndarray, "points 3"],
        normals: Float[np.ndarray, "points 3"],
        rays: int,
        lost: Callable[[Float[np.ndarray, "points rays"]], Float[np.ndarray, "points rays"]],
        seed: int = 0,
    ) -> Visible:
        """Return the visibility of points by rays, its standard error and the bent normal of each point.

        Args:
            positions: points slightly above their own surfaces.
            normals: unit normals.
            rays: the number of rays per point, 2 or more.
            lost: a function from distances to w, the share of light that a surface at each distance blocks.
            seed: the seed for the directions.
        """
        rng, blocks = np.random.default_rng(seed), []
        for first, count in _block_ranges(len(positions), max(BLOCK // rays, 1)):
            n = normals[first : first + count]
            directions = cosine_directions(n, rays, rng)
            origins = np.broadcast_to(positions[first : first + count, None], directions.shape)
            far = self.distances(origins.reshape(-1, 3), directions.reshape(-1, 3)).reshape(count, rays)
            light = 1 - lost(far.astype(np.float64))
            error = light.std(axis=1, ddof=1) / np.sqrt(rays)
            blocks.append((light.mean(axis=1), error, np.mean(light[..., None] * directions, axis=1)))
        return Visible(*(np.concatenate(each) for each in zip(*blocks, strict=True)))


def _block_ranges(total: int, most: int) -> Iterator[tuple[int, int]]:
    yield from ((first, min(most, total - first)) for first in range(0, total, most))


def cosine_directions(
    normals: Float[np.ndarray, "normals 3"], count: int, rng: np.random.Generator
) -> Float[np.ndarray, "normals {count} 3"]:
    """Return `count` random unit directions around each normal, with density proportional to the cosine of the angle
    to the normal.

    They point from the origin to uniformly distributed points on the unit sphere around the tip of the normal, which
    gives exactly the cosine density.
    """
    z, turn = rng.uniform(-1, 1, (2, len(normals), count)) * np.array([1.0, np.pi])[:, None, None]
    ring = np.sqrt(1 - z**2)
    ball = np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=-1)
    directions = normals[:, None] + ball
    # At the foot of the ball all directions are in the tangent plane; the length is 0 there and the odds are nil.
    return directions / np.maximum(np.linalg.norm(directions, axis=-1, keepdims=True), 1e-12)
