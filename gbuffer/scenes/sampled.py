"""Texture maps without an OpenGL driver: mipmapped normal maps, sampled for each pixel, and alpha cut-outs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from .mesh import Mesh, tangents
from .metal_rough import Map, MetalRough, Wrap
from .rasterise import Camera, IsDrawn, Rendered, centres, to_clip
from .scene import Material

# Probes along the longer side of a pixel's footprint, at most: as GL's anisotropic filters usually have.
PROBES = 16
# The largest integer of the coarser maps that tell how far maps of 8 bits are off, and their steps in steps of 8 bits.
# Errors of neighbouring texels are alike where a map is smooth, in coarser maps as in finer ones: so filters take as
# much from either.
COARSER = 63
COARSENED = 255 / COARSER


class Pyramid:
    """Mipmaps of the first three channels of a map, as directions with components in [-1, 1]."""

    def __init__(self, lying: Map):
        self._lying = lying

    @cached_property
    def levels(self) -> list[np.ndarray]:
        """Mip levels, (height, width, 3) each, float32 in [-1, 1]: the map first, and last a level of one texel."""
        most = np.iinfo(self._lying.texels.dtype).max
        levels = [self._lying.texels[..., :3] * np.float32(2 / most) - np.float32(1)]
        while max(levels[-1].shape[:2]) > 1:
            levels.append(_halved(_halved(levels[-1]).swapaxes(0, 1)).swapaxes(0, 1))
        return levels

    def through(self, uv: np.ndarray, along_x: np.ndarray, along_y: np.ndarray) -> np.ndarray:
        """Return the map filtered over the footprints of pixels, (pixels, 3).

        Args:
            uv: (pixels, 2), texture coordinates of each pixel's centre.
            along_x, along_y: (pixels, 2), the change of `uv` to the next pixel.

        The footprint is sampled at up to PROBES points along its longer side. Each sample interpolates between the
        two levels with the texel sizes nearest to the shorter side.
        """
        size = np.array(self.levels[0].shape[1::-1])
        sides = np.stack([along_x, along_y])
        lengths = np.linalg.norm(sides * size, axis=2)
        longer = np.argmax(lengths, axis=0)
        along = np.take_along_axis(sides, longer[None, :, None], axis=0)[0]
        long, short = lengths.max(axis=0), lengths.min(axis=0)
        count = np.clip(np.ceil(long / np.maximum(short, 1e-12)), 1, PROBES)
        level = np.clip(np.log2(np.maximum(long / count, 1e-12)), 0, len(self.levels) - 1)
        total = np.zeros((len(uv), 3))
        for probe in range(int(count.max()) if len(count) else 0):
            some = np.flatnonzero(probe < count)
            step = ((probe + 0.5) / count[some] - 0.5)[:, None]
            total[some] += self._between(uv[some] + step * along[some], level[some])
        return total / count[:, None]

    def _between(self, uv: np.ndarray, level: np.ndarray) -> np.ndarray:
        """Return trilinear samples, (points, 3), between the mip levels below and above the fractional `level`."""
        samples = np.zeros((len(uv), 3))
        below = np.minimum(level.astype(int), len(self.levels) - 1)
        above = np.minimum(below + 1, len(self.levels) - 1)
        share = (level - below)[:, None]
        for number in np.unique(np.concatenate([below, above])):
            for chosen, weight in ((below == number, 1 - share), (above == number, share)):
                samples[chosen] += _bilinear(self.levels[number], uv[chosen], self._lying.wrap) * weight[chosen]
        return samples


def _bilinear(texels: np.ndarray, uv: np.ndarray, wrap: tuple[Wrap, Wrap]) -> np.ndarray:
    """Return bilinear samples of texels at `uv`, (points, channels)."""
    height, width = texels.shape[:2]
    position = uv * (width, height) - 0.5
    low = np.floor(position).astype(np.int64)
    share = position - low
    (left, right), (top, bottom) = (
        [_wrapped(low[:, axis] + step, count, wrap[axis]) for step in (0, 1)]
        for axis, count in ((0, width), (1, height))
    )
    x, y = share[:, :1], share[:, 1:]
    upper = texels[top, left] * (1 - x) + texels[top, right] * x
    return upper * (1 - y) + (texels[bottom, left] * (1 - x) + texels[bottom, right] * x) * y


def _wrapped(index: np.ndarray, count: int, wrap: Wrap) -> np.ndarray:
    """Return texel indices, wrapped at the edges of the map."""
    if wrap == "clamp":
        return np.clip(index, 0, count - 1)
    if wrap == "repeat":
        return index % count
    folded = index % (2 * count)
    return np.minimum(folded, 2 * count - 1 - folded)


def _halved(texels: np.ndarray) -> np.ndarray:
    """Return half as many rows, rounded down, each the mean of the rows that it covers, in whole or in part; a single
    row unchanged."""
    rows = len(texels)
    half = rows // 2
    if rows == 1:
        return texels
    if rows % 2 == 0:
        return (texels[0::2] + texels[1::2]) * np.float32(0.5)
    i = np.arange(half, dtype=np.float32)[:, None, None]
    first, last = texels[: rows - 1 : 2] * (half - i), texels[2::2] * (i + 1)
    return (first + texels[1::2] * half + last) / np.float32(rows)


def mapped_normals(
    rendered: Rendered, camera: Camera, drawn: Sequence[tuple[Mesh, Material | MetalRough]]
) -> np.ndarray:
    """Return the normals of a rendered image with its materials' normal maps applied, (height, width, 3), float32.

    Args:
        rendered: the image of all meshes of `drawn`, joined in this order.
        drawn: meshes in view space and their materials.
    """
    normals = rendered.normals.copy()
    ends = np.cumsum([len(mesh.triangles) for mesh, _ in drawn])
    mesh_of = np.searchsorted(ends, rendered.triangle, side="right")
    pyramids: dict[int, Pyramid] = {}
    for number, (mesh, material) in enumerate(drawn):
        if not isinstance(material, MetalRough) or (lying := material.normal_map) is None:
            continue
        row, column = np.nonzero((mesh_of == number) & rendered.covered)
        first = ends[number] - len(mesh.triangles)
        corners = mesh.triangles[rendered.triangle[row, column] - first]
        weights, along_x, along_y = _weights(mesh.positions[corners], column, row, camera)
        placed = placed_uv(mesh, lying)[corners]
        uv, du, dv = (np.einsum("pc,pck->pk", w, placed) for w in (weights, along_x, along_y))
        pyramid = pyramids.setdefault(id(lying.texels), Pyramid(lying))
        slopes = pyramid.through(uv, du, dv) * (material.normal_scale, material.normal_scale, 1.0)
        tangent = np.einsum("pc,pck->pk", weights, tangents(mesh)[corners])
        normals[row, column] = _turned(normals[row, column].astype(np.float64), tangent, slopes)
    return normals


def coarser(drawn: Sequence[tuple[Mesh, Material | MetalRough]]) -> list[tuple[Mesh, Material | MetalRough]] | None:
    """Return the same pairs with 8-bit normal maps rounded to integers up to COARSER; None if no map has 8 bits."""
    coarse_texels: dict[int, np.ndarray] = {}
    pairs = []
    for mesh, material in drawn:
        lying = material.normal_map if isinstance(material, MetalRough) else None
        if isinstance(material, MetalRough) and lying and lying.texels.dtype == np.uint8:
            if (texels := coarse_texels.get(id(lying.texels))) is None:
                levels = np.round(np.arange(256) / 255 * COARSER) / COARSER
                texels = coarse_texels[id(lying.texels)] = np.round(levels * 65535).astype(np.uint16)[lying.texels]
            material = replace(material, normal_map=replace(lying, texels=texels))
        pairs.append((mesh, material))
    return pairs if coarse_texels else None


def cut_out(drawn: Sequence[tuple[Mesh, Material | MetalRough]]) -> IsDrawn | None:
    """Return the test for `rasterise` on joined meshes: a point's alpha is not below its material's threshold.

    Alpha is sampled without mipmaps. The function returns None if no material has a cut-out.
    """
    ends = np.cumsum([len(mesh.triangles) for mesh, _ in drawn])
    cut = {n: (mesh, m) for n, (mesh, m) in enumerate(drawn) if isinstance(m, MetalRough) and m.cutoff > 0}

    def is_drawn(triangle: np.ndarray, weights: np.ndarray) -> np.ndarray:
        mesh_of = np.searchsorted(ends, triangle, side="right")
        is_opaque = np.ones(len(triangle), bool)
        for number, (mesh, material) in cut.items():
            some = np.flatnonzero(mesh_of == number)
            corners = mesh.triangles[triangle[some] - (ends[number] - len(mesh.triangles))]
            is_opaque[some] = _alpha(mesh, material.base_map, corners, weights[some]) >= material.cutoff
        return is_opaque

    return is_drawn if cut else None


def _alpha(mesh: Mesh, lying: Map | None, corners: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return a map's alpha at points in triangles, (points,); 1 without a map."""
    if lying is None:
        return np.ones(len(corners))
    uv = np.einsum("pc,pck->pk", weights, placed_uv(mesh, lying)[corners])
    return _bilinear(lying.texels[..., 3:], uv, lying.wrap)[:, 0] / np.iinfo(lying.texels.dtype).max


def placed_uv(mesh: Mesh, lying: Map) -> np.ndarray:
    """Return the texture coordinates of a map at a mesh's vertices, (vertices, 2), from the first uv set if the mesh
    lacks a second."""
    uv = mesh.second_uv if lying.uv_set and mesh.second_uv is not None else mesh.uv
    return uv @ lying.placed[:, :2].T + lying.placed[:, 2]


def _weights(corners: np.ndarray, column: np.ndarray, row: np.ndarray, camera: Camera) -> tuple[np.ndarray, ...]:
    """Return the corners' weights at pixel centres, and their changes to the next column and to the next row,
    (pixels, 3) each: (e / s)' = (e' - e / s s') / s for the edge functions e and their sum s."""
    inverse = np.linalg.inv(to_clip(corners, camera))
    edges = np.einsum("jp,pjk->pk", centres(column, row, camera), inverse)
    total = edges.sum(axis=1, keepdims=True)
    weights = edges / total
    steps = (inverse[:, 0] * (2 / camera.width), inverse[:, 1] * (-2 / camera.height))
    along = ((step - weights * step.sum(axis=1, keepdims=True)) / total for step in steps)
    return weights, *along


def _turned(n: np.ndarray, tangent: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return unit normals perturbed by the texels of a normal map: x along the tangent, y against the bitangent,
    because an image's v grows downwards, and z along the normal. A normal of zero length is replaced with `n`."""
    t = tangent[:, :3] - n * np.sum(n * tangent[:, :3], axis=1, keepdims=True)
    t /= np.maximum(np.linalg.norm(t, axis=1, keepdims=True), 1e-12)
    b = np.where(tangent[:, 3:] < 0, -1.0, 1.0) * np.cross(n, t)
    normals = t * slopes[:, :1] - b * slopes[:, 1:2] + n * slopes[:, 2:]
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 1e-9, normals / np.maximum(length, 1e-9), n)
