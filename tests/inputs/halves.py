"""A glTF file with a dome in vertex normals next to the same dome in a normal map."""

from __future__ import annotations

from typing import Any

import numpy as np
from written import Document, png_bytes

from normalbench.gbuffer.scenes.mesh import grid_triangles

CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
# What turns and mirrors a square about its middle.
WAYS = [np.array(m) @ n for m in (((1, 0), (0, 1)), ((-1, 0), (0, 1))) for n in ([[1, 0], [0, 1]], [[0, 1], [-1, 0]])]
# The slope of the dome at its rim.
RIM = 0.6


def picture(slopes, kind: type[np.unsignedinteger] = np.uint16) -> bytes:
    """Return a normal map of 16 or 8 bits; `slopes` gives x and y of its normals at (right, up), each in [-1, 1]."""
    middles = (np.arange(128) + 0.5) / 64 - 1
    right, up = np.meshgrid(middles, -middles)
    x, y = slopes(right, up)
    n = np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=-1)
    return png_bytes(np.round((n * 0.5 + 0.5) * np.iinfo(kind).max).astype(kind))


def dome(right, up):
    """Return x and y of a dome's normals: its left side faces left."""
    return RIM * right, RIM * up


def uv_of(way: np.ndarray, corners: np.ndarray = CORNERS) -> np.ndarray:
    """Return the uv coordinates that place an image on a square's corners by `way`; v grows downwards."""
    return (corners @ way.T) * (0.5, -0.5) + 0.5


def halves(
    way: np.ndarray, authored: bool = False, kind: type[np.unsignedinteger] = np.uint16, **material: Any
) -> Document:
    """Return two 2 x 2 squares that face a camera, in the same material except for the map: on the left, vertices
    have the dome's normals; on the right, a normal map has them, placed by `way`, one of WAYS.

    Args:
        way: (2, 2), orthogonal; a determinant of -1 mirrors the image.
        authored: whether the file has tangents.
        kind: type of the map's texels.
        material: other fields of both materials.
    """
    document = Document()
    picture_of_dome = {"index": document.texture(picture(dome, kind), wrapS=33071, wrapT=33071)}
    mapped, modelled = document.material(normalTexture=picture_of_dome, **material), document.material(**material)
    steps = np.linspace(-1, 1, 33)
    x, y = (a.ravel() for a in np.meshgrid(steps, steps))
    n = np.stack([RIM * x, RIM * y, np.sqrt(1 - RIM**2 * (x * x + y * y))], axis=1)
    grid = np.stack([x, y, 0 * x], axis=1)
    document.node(mesh=document.mesh(grid, n, grid_triangles(32, 32), material=modelled), translation=[-1.1, 0, 0])
    more = {"TEXCOORD_0": uv_of(way)} | ({"TANGENT": file_tangents(way)} if authored else {})
    flat = np.concatenate([CORNERS, np.zeros((4, 1))], axis=1)
    square = document.mesh(flat, [(0, 0, 1)] * 4, [(0, 1, 2), (0, 2, 3)], material=mapped, **more)
    document.node(mesh=square, translation=[1.1, 0, 0])
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]
    document.node(camera=0, translation=[0, 0, 6])
    return document


def file_tangents(way: np.ndarray) -> list[tuple[float, ...]]:
    """Return glTF tangents: the direction of the image's right on the square, and the sign that gives its up."""
    right, up = way
    return [(*right, 0, np.sign(right[0] * up[1] - right[1] * up[0]))] * 4
