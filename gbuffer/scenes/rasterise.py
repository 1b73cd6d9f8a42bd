"""A software rasteriser in NumPy: the same pixels on every machine, with or without an OpenGL driver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .mesh import Mesh

# Candidate pixels held at once; bounds memory whatever the scene.
CHUNK = 1 << 16
# How far outside a triangle, in its own barycentric weights, a pixel's centre still counts as on the edge.
EDGE = 1e-9
# Pixels along a side of the squares that boxes are cut into: those wholly outside a triangle's edge are left out.
SIDE = 16
# What rounding may add to an edge function, in its largest value.
ROUNDED = 1e-12


# Of points in triangles, by their numbers, (points,), and the weights of their corners, (points, 3): which are drawn.
IsDrawn = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Camera:
    """A perspective camera at the origin of view space: x right, y up, looking down -z.

    Attributes:
        width, height: size of the image in pixels.
        fov: vertical field of view in degrees.
        near, far: distances along -z.
    """

    width: int
    height: int
    fov: float
    near: float
    far: float


@dataclass(frozen=True)
class Rendered:
    """The surface visible at each pixel.

    Attributes:
        normals: interpolated and renormalised, view space, (height, width, 3), float32; zero on the background.
        positions: view-space positions, (height, width, 3), float32; (0, 0, -far) on the background.
        covered: whether a surface covers the pixel, (height, width), bool. Row 0 is at the top.
        triangle: index of the mesh's triangle, (height, width), int64; arbitrary on the background.
    """

    normals: np.ndarray
    positions: np.ndarray
    covered: np.ndarray
    triangle: np.ndarray


def rasterise(mesh: Mesh, camera: Camera, is_drawn: IsDrawn | None = None) -> Rendered:
    """Return the nearest surface of a view-space mesh at each pixel's centre; both sides of triangles are drawn.

    Homogeneous rasterisation (Olano and Greer 1997): edge functions come from clip coordinates, so that triangles
    that reach behind the eye need no clipping.

    Args:
        is_drawn: a test of points in triangles; the mesh has holes where it fails. None to draw all points.
    """
    corners = mesh.positions[mesh.triangles]
    clip = to_clip(corners, camera)
    # Left out: triangles seen edge on, poles' triangles that have no area, and what lies wholly before the near plane.
    seen = (abs(np.linalg.det(clip)) > 1e-12) & np.any(clip[..., 2] > camera.near, axis=1)
    corners, normals, clip = corners[seen], mesh.normals[mesh.triangles][seen], clip[seen]
    inverse = np.linalg.inv(clip)
    triangle, boxes = _squares(_pixel_boxes(clip, camera))
    is_met = _is_met(inverse[triangle], boxes, camera)
    number = np.flatnonzero(seen)
    kept = None if is_drawn is None else lambda some, weights: is_drawn(number[some], weights)
    rendered = _resolve(corners, normals, inverse, triangle[is_met], boxes[is_met], camera, kept)
    return replace(rendered, triangle=np.append(number, 0)[rendered.triangle])


def to_clip(corners: np.ndarray, camera: Camera) -> np.ndarray:
    """Return view-space points, (..., 3), in clip coordinates x, y and w."""
    half = np.tan(np.radians(camera.fov) / 2)
    return corners * (1 / (half * camera.width / camera.height), 1 / half, -1.0)


def _pixel_boxes(clip: np.ndarray, camera: Camera) -> np.ndarray:
    """Return a box of pixels around each triangle, (triangles, 4): first column, first row, last column + 1 and last
    row + 1. The box is the whole image if a corner is nearer than the near plane."""
    size = np.array([camera.width, camera.height])
    w = clip[..., 2:]
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = (clip[..., :2] / w * (0.5, -0.5) + 0.5) * size
    low, high = np.floor(pixels.min(axis=1)), np.ceil(pixels.max(axis=1))
    crosses = np.any(w[..., 0] < camera.near, axis=1)[:, None]
    low = np.where(crosses, 0, np.clip(low, 0, size)).astype(np.int64)
    high = np.where(crosses, size, np.clip(high, 0, size)).astype(np.int64)
    return np.concatenate([low, np.maximum(high, low)], axis=1)


def _squares(boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cut the boxes of triangles into squares of at most SIDE pixels. Return each square's triangle, in ascending
    order, and its box, (squares, 4)."""
    across, down = -(-(boxes[:, 2:] - boxes[:, :2]).T // SIDE)
    triangle = np.repeat(np.arange(len(boxes)), across * down)
    within = np.arange(len(triangle)) - np.repeat(np.cumsum(across * down) - across * down, across * down)
    row, column = np.divmod(within, across[triangle])
    low = boxes[triangle, :2] + SIDE * np.stack([column, row], axis=1)
    return triangle, np.concatenate([low, np.minimum(low + SIDE, boxes[triangle, 2:])], axis=1)


def _is_met(inverse: np.ndarray, boxes: np.ndarray, camera: Camera) -> np.ndarray:
    """Return, for each box, whether every edge of its triangle has a pixel of the box on its inner side, (boxes,).
    Edge functions are linear, so they are largest at one of the box's four corners."""
    columns, rows = boxes[:, (0, 2, 0, 2)] - (0, 1, 0, 1), boxes[:, (1, 1, 3, 3)] - (0, 0, 1, 1)
    edges = np.einsum("cjn,njk->nck", centres(columns.T, rows.T, camera), inverse)
    edges += EDGE * edges.sum(axis=2, keepdims=True)
    largest = edges.max(axis=1)
    return np.all(largest >= -ROUNDED * np.abs(edges).max(axis=1), axis=1)


def centres(column: np.ndarray, row: np.ndarray, camera: Camera) -> np.ndarray:
    """Return the centres of pixels as (x, y, 1), with x and y in [-1, 1], y up, along the second-to-last axis."""
    x = (column + 0.5) / camera.width * 2 - 1
    y = 1 - (row + 0.5) / camera.height * 2
    return np.stack([x, y, np.ones_like(x)], axis=-2)


def _candidates(triangle_of: np.ndarray, boxes: np.ndarray):
    """Yield (triangle, column, row) arrays for all pixels in all boxes, at most CHUNK pixels at a time."""
    widths, heights = (boxes[:, 2:] - boxes[:, :2]).T
    ends = np.cumsum(widths * heights)
    for start in range(0, int(ends[-1]) if len(ends) else 0, CHUNK):
        index = np.arange(start, min(start + CHUNK, int(ends[-1])))
        box = np.searchsorted(ends, index, side="right")
        within = index - (ends[box] - widths[box] * heights[box])
        row, column = np.divmod(within, widths[box])
        yield triangle_of[box], boxes[box, 0] + column, boxes[box, 1] + row


def _resolve(corners, normals, inverse, triangle_of, boxes, camera: Camera, is_drawn: IsDrawn | None) -> Rendered:
    depth = np.full(camera.width * camera.height, np.inf)
    normal = np.zeros((camera.width * camera.height, 3))
    position = np.tile([0.0, 0.0, -camera.far], (camera.width * camera.height, 1))
    nearest = np.full(len(depth), -1)
    for triangle, column, row in _candidates(triangle_of, boxes):
        # Each edge function is a corner's weight over w; their sum is 1/w.
        edges = np.einsum("jn,njk->nk", centres(column, row, camera), inverse[triangle])
        one_over_w = edges.sum(axis=1)
        # A centre on an edge two triangles share belongs to both, so that rounding leaves no crack between them.
        inside = np.all(edges >= -EDGE * one_over_w[:, None], axis=1)
        inside &= (one_over_w * camera.far >= 1) & (one_over_w * camera.near <= 1)
        if is_drawn is not None:
            candidates = np.flatnonzero(inside)
            weights = edges[candidates] / one_over_w[candidates, None]
            inside[candidates] = is_drawn(triangle[candidates], weights)
        triangle, edges, one_over_w = triangle[inside], edges[inside], one_over_w[inside]
        pixel, w = (row * camera.width + column)[inside], 1 / one_over_w
        order = np.lexsort((w, pixel))
        first = order[np.concatenate([[True], np.diff(pixel[order]) > 0])] if len(order) else order
        first = first[w[first] < depth[pixel[first]]]
        weights = (edges * w[:, None])[first]
        depth[pixel[first]] = w[first]
        nearest[pixel[first]] = triangle[first]
        normal[pixel[first]] = np.einsum("nc,nck->nk", weights, normals[triangle[first]])
        position[pixel[first]] = np.einsum("nc,nck->nk", weights, corners[triangle[first]])
    length = np.linalg.norm(normal, axis=1)
    # Normals that cancel each other within a triangle leave none: nothing to be measured there.
    covered = np.isfinite(depth) & (length > 0)
    normal[covered] /= length[covered, None]
    shape = (camera.height, camera.width)
    return Rendered(
        normal.reshape(*shape, 3).astype(np.float32),
        position.reshape(*shape, 3).astype(np.float32),
        covered.reshape(shape),
        nearest.reshape(shape),
    )
