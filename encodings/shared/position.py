"""View-space positions from stored depths: by the inverse projection, by its two terms, and by the eye ray.

All functions take the position on the screen, from -1 to 1 to the right and up. The GLSL twin of this file is
`position.glsl`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..vec import Vec2, Vec3, jnp

if TYPE_CHECKING:
    from jaxtyping import Array, Float


class CameraTerms(NamedTuple):
    """The values of a camera and a projection that are passed to a shader, in float32.

    `terms` are the two terms of the projection's z row: clip-space z is terms.x z + terms.y.
    """

    near: Float[Array, ""]
    far: Float[Array, ""]
    rays: Vec2
    clip: Vec2
    clip_to_view: Float[Array, "4 4"]
    terms: Vec2


@dataclass(frozen=True)
class Projection:
    """The mapping from depth to clip space.

    Attributes:
        row: (near, far) -> a, b: clip-space z is a z + b, with w = -z.
        clip: a, b: z / w is a depth + b for the depth buffer's depth from 0 to 1. (2, -1) is OpenGL's default; (1,
            0) needs glClipControl, and has no sum that would round away a float's fine steps near 0.
    """

    row: Callable[[float, float], tuple[float, float]]
    clip: tuple[float, float]


@dataclass(frozen=True)
class Camera:
    """A perspective camera at the origin of view space, looking down -z.

    Attributes:
        near, far: distances along -z.
        fov: vertical field of view in degrees.
        aspect: width of the image over its height.
    """

    near: float
    far: float
    fov: float
    aspect: float

    @property
    def rays(self) -> tuple[float, float]:
        """The x and y at depth 1 of the ray through the screen's upper right corner."""
        up = float(np.tan(np.radians(self.fov) / 2))
        return up * self.aspect, up

    def clip_to_view(self, projection: Projection | None) -> Float[np.ndarray, "4 4"]:
        """Return the inverse of a projection's matrix for this camera, float64, for column vectors; the identity if
        the projection is None."""
        if projection is None:
            return np.eye(4)
        right, up = self.rays
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1], matrix[3, 2] = 1 / right, 1 / up, -1.0
        matrix[2, 2:] = projection.row(self.near, self.far)
        return np.linalg.inv(matrix)

    def terms(self, projection: Projection | None) -> tuple[float, float]:
        """Return a and b of a projection's z row, a z + b, for this camera; 0 and 1 if the projection is None."""
        return projection.row(self.near, self.far) if projection else (0.0, 1.0)

    def seen(self, projection: Projection | None) -> CameraTerms:
        """Return the camera's values for a projection, in float32, as passed to a shader."""
        near, far, *rays = map(jnp.float32, (self.near, self.far, *self.rays))
        clip = Vec2(*map(jnp.float32, projection.clip if projection else (1.0, 0.0)))
        terms = Vec2(*map(jnp.float32, self.terms(projection)))
        return CameraTerms(near, far, Vec2(*rays), clip, jnp.asarray(self.clip_to_view(projection), jnp.float32), terms)


def position_from_window_depth(
    place: Vec2, depth: Float[Array | np.ndarray, "*shape"], clip: Vec2, clip_to_view: Float[Array, "4 4"]
) -> Vec3:
    """Return the view-space position for a depth buffer's depth, from 0 to 1, by the inverse projection.

    Args:
        place: position on the screen, -1 to 1 to the right and up; arrays of the same shape as `depth`.
        clip: how depth maps to clip space (see `Projection`).
        clip_to_view: the inverse projection, float32.
    """
    # p = clip_to_view (place, clip.x depth + clip.y, 1), position = p.xyz / p.w
    m, z = clip_to_view, clip.x * depth + clip.y
    p = [m[i, 0] * place.x + m[i, 1] * place.y + m[i, 2] * z + m[i, 3] for i in range(4)]
    return Vec3(*p[:3]) / p[3]


def position_from_projection_terms(
    place: Vec2, depth: Float[Array | np.ndarray, "*shape"], clip: Vec2, terms: Vec2, rays: Vec2
) -> Vec3:
    """Return the view-space position for a depth buffer's depth by the projection's two terms, as many engines do.

    Args:
        place, depth, clip: as in `position_from_window_depth`.
        terms: a, b: clip-space z is a z + b, with w = -z.
        rays: x and y at depth 1 of the ray through the screen's upper right corner.
    """
    # ndc = (a z + b) / -z, so -z = b / (ndc + a)
    return position_from_linear_depth(place, terms.y / (clip.x * depth + clip.y + terms.x), rays)


def position_from_linear_depth(place: Vec2, depth: Float[Array | np.ndarray, "*shape"], rays: Vec2) -> Vec3:
    """Return the view-space position for a linear, planar depth (-z): the eye ray times the depth."""
    # position = (place rays, -1) depth
    ray = place * rays
    return Vec3(ray.x * depth, ray.y * depth, -depth)
