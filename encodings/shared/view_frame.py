"""The pixel's own frame, whose z looks back along the line of sight. The GLSL twin is `view_frame.glsl`."""

from __future__ import annotations

from ..vec import Vec3, cross, unit


def view_frame(view: Vec3) -> tuple[Vec3, Vec3, Vec3]:
    """Return the x, y and z axes of the pixel's frame, given its view-space position: z points to the eye, and x is
    horizontal (+x if the ray goes straight up or down)."""
    # z = -view, x = normalize(z.z, 0, -z.x), y = cross(z, x)
    z = -unit(view)
    x = unit(Vec3(z.z, 0.0 * z.z, -z.x))
    return x, cross(z, x), z
