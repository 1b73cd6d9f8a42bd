"""Patches of 4 x 4 texels, built around directions or cut from images, and the weights for mixing their texels."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ....encodings.vec import Vec3
from ....gbuffer.codecs.mixing.passes import QUARTERS, SIDE, Meetings
from ...subjects.normals.domains import in_domain
from ...subjects.normals.normal_sets import NormalSet
from .reference import angles_between, reoriented, tilted, unit_rows

# Places of a filter are multiples of 2^-12 of a texel, which texture coordinates have exactly.
FRACTION_BITS = 12
ALPHAS = tuple(tenth / 10 for tenth in range(1, 10))
# The fewest patches of an image, so that each alpha has rows of its own.
LEAST_SIDE = 16
TEXELS = SIDE * SIDE
# Neighbours of an image that are further apart lie on either side of an edge.
LEAST_EDGE_DEG = 20.0
# Steradians of the whole sphere.
SPHERE = 4 * math.pi


@dataclass(frozen=True, eq=False)
class Patches:
    """The patches of one set.

    Attributes:
        name: name of the set.
        angle_deg: angle between neighbours; None for patches cut from an image.
        edge_deg: angle across an edge through each patch; None if there is no edge.
        count: number of patches that are measured; the others pad the image.
        normals: unit normals, float64 of shape (TEXELS, patches, 3), row by row from the first texel.
        views: float32 of shape (patches, 3).
        seed: seed of the set.
        code_space: the space of the normals in a captured frame.
        is_anywhere: whether patches may be anywhere on the sphere, in any rotation, because the set is the sphere.
    """

    name: str
    angle_deg: float | None
    count: int
    normals: np.ndarray
    views: np.ndarray
    seed: int
    edge_deg: float | None = None
    code_space: str | None = None
    is_anywhere: bool = False

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the image of patches, powers of two."""
        bits = (self.normals.shape[1] - 1).bit_length()
        return 1 << (bits + 1) // 2, 1 << bits // 2

    def held_by(self, domain: str) -> np.ndarray:
        """Return a mask of the measured patches whose texels are all in a domain, bool of shape (patches,)."""
        is_held = np.arange(self.normals.shape[1]) < self.count
        return np.logical_and(is_held, np.all(in_domain(self.normals, self.views, domain), axis=0))


@dataclass(frozen=True, eq=False)
class Mixes:
    """Patches, and the weights with which their texels are mixed.

    Attributes:
        patches: the patches.
        samples: samples per pixel.
        shares, quarters: positions that a filter and an upsampling read, float64 of shape (patches, 2).
        counts: number of a pixel's samples that have the first normal, (patches,).
        alphas: blend factors, (patches,).
        decals: unit normals laid over the first texel, (patches, 3).
        details: the correct result of blending each decal with its alpha, (patches, 3).
    """

    patches: Patches
    samples: int
    shares: np.ndarray
    quarters: np.ndarray
    counts: np.ndarray
    alphas: np.ndarray
    decals: np.ndarray
    details: np.ndarray

    def held_by(self, operation: str, domain: str) -> np.ndarray:
        """Return a mask of the mixes that an encoding of a domain can represent, bool of shape (patches,). Only the
        decals and results of `detail` are checked; `Patches.held_by` checks the texels."""
        if operation != "detail":
            return np.ones(len(self.alphas), bool)
        both = np.stack([self.decals, self.details])
        return np.all(in_domain(both, self.patches.views, domain), axis=0)

    def meetings(self) -> Meetings:
        """Return the texels and weights as images for a device."""
        width, height = self.patches.size
        blocks = _with_fourth(self.patches.normals).reshape(SIDE, SIDE, height, width, 4)

        def image(a: np.ndarray) -> np.ndarray:
            return a.reshape(height, width, *a.shape[1:])

        return Meetings(
            blocks.transpose(2, 0, 3, 1, 4).reshape(SIDE * height, SIDE * width, 4),
            image(_with_fourth(self.decals)),
            image(_with_fourth(self.patches.views)),
            image(self.shares),
            image(self.quarters),
            image(self.counts),
            image(self.alphas)[:, 0],
        )


def _with_fourth(vectors: np.ndarray) -> np.ndarray:
    return np.pad(vectors.astype(np.float32), [(0, 0)] * (vectors.ndim - 1) + [(0, 1)])


def mixes_of(patches: Patches, samples: int) -> Mixes:
    """Return the patches with random weights, decals and details, reproducible from their seed."""
    random = np.random.default_rng([patches.seed, 1])
    width, height = patches.size
    count = width * height
    alphas = np.repeat(np.array(ALPHAS)[np.arange(height) * len(ALPHAS) // height], width)
    shares = random.integers(0, 2**FRACTION_BITS, (count, 2)) / 2**FRACTION_BITS
    first, second = patches.normals[0], patches.normals[1]
    # The detail is tilted as far as the second normal, in a direction of its own.
    tilt = np.arctan2(np.linalg.norm(np.cross(first, second), axis=1), np.sum(first * second, axis=1))
    turn = random.uniform(0, 2 * np.pi, count)
    return Mixes(
        patches,
        samples,
        shares,
        random.choice(QUARTERS, (count, 2)),
        random.integers(1, samples, count),
        alphas,
        reoriented(first, tilted(tilt, turn)),
        reoriented(first, tilted(alphas * tilt, turn)),
    )


def patches_of(
    normals: NormalSet, angles_deg: tuple[float, ...], count: int, seed: int, edges_deg: tuple[float, ...] = ()
) -> Iterator[Patches]:
    """Yield the patches of a set. If the set is an image, these are squares of its pixels. Otherwise they are patches
    around the set's directions for each angle, then the patches of the first angle with each edge through them."""
    if normals.shape:
        yield from _own_neighbours(normals, count, seed)
        return
    directions = _chosen_directions(normals, count, seed)
    is_anywhere = normals.area == SPHERE
    by_angle = [
        replace(_turned_patches(normals.name, directions, angle, seed), is_anywhere=is_anywhere) for angle in angles_deg
    ]
    yield from by_angle
    yield from (_with_edge(by_angle[0], edge, seed) for edge in edges_deg)


def _patch_indices(count: int) -> np.ndarray:
    """Return the indices of `count` patches, repeated from 0 up to a power of two or LEAST_SIDE^2, if larger."""
    whole = max(1 << (count - 1).bit_length(), LEAST_SIDE**2)
    return np.arange(whole) % count


def _set_arrays(normals: NormalSet) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the normals, views and coverage of a set: arrays of shape (count, 3), (count, 3) and (count,)."""
    gathered = ([], [], [])
    for load in normals.loads():
        chunk = load()
        for parts, planes in zip(gathered, (chunk.n, chunk.view, chunk.covered), strict=True):
            parts.append(np.stack([np.asarray(p) for p in planes], axis=1) if isinstance(planes, Vec3) else planes)
    n, view, covered = (np.concatenate(parts)[: normals.count] for parts in gathered)
    return n, view, np.asarray(covered)


def _chosen_directions(normals: NormalSet, count: int, seed: int) -> np.ndarray:
    """Return `count` of a set's normals, evenly chosen or repeated, in random order because alphas depend on a
    patch's row."""
    n, _, covered = _set_arrays(normals)
    n = unit_rows(n[covered].astype(np.float64))
    return n[np.random.default_rng([seed, 2]).permutation(np.arange(count) * len(n) // count)]


def _turned_patches(name: str, directions: np.ndarray, angle_deg: float, seed: int) -> Patches:
    """Return randomly rotated patches with an angle between neighbours; each direction is at a random place in the
    first 2 x 2 texels.

    n(w) = cos |w| n + sin |w| w / |w|, where w is a step on the tangent plane.
    """
    count, random = len(directions), np.random.default_rng([seed, 0])
    within, turn = random.random((count, 2)), random.uniform(0, 2 * np.pi, count)
    grid = np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=-1).reshape(TEXELS, 1, 2)
    steps = math.radians(angle_deg) * (grid - within)
    length, way = np.hypot(steps[..., 0], steps[..., 1]), np.arctan2(steps[..., 1], steps[..., 0]) + turn
    across = tilted(np.full_like(length, np.pi / 2), way)
    tangents = reoriented(np.broadcast_to(directions, across.shape), across)
    n = np.cos(length)[..., None] * directions + np.sin(length)[..., None] * tangents
    chosen = _patch_indices(count)
    views = np.broadcast_to(np.array([0, 0, -1], np.float32), (len(chosen), 3))
    return Patches(name, angle_deg, count, rounded(n[:, chosen]), views, seed)


def _with_edge(patches: Patches, edge_deg: float, seed: int) -> Patches:
    """Return patches whose texels on one side of a line are rotated by an angle about a tangent, as if on another
    surface. The line runs between the first two texels, at a random angle, so that every mix has texels from both
    sides.

    n' = n cos a + (t x n) sin a + t (t . n) (1 - cos a), with t unit (Rodrigues).
    """
    random = np.random.default_rng([seed, 3])
    count = patches.normals.shape[1]
    turn, lean = random.uniform(0, 2 * np.pi, count), random.uniform(-np.pi / 3, np.pi / 3, count)
    grid = np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=-1).reshape(TEXELS, 1, 2)
    way = np.stack([np.cos(lean), np.sin(lean)], axis=-1)
    is_beyond = np.sum((grid - np.array([0.5, 0.0])) * way, axis=-1) > 0
    n, angle = patches.normals, np.radians(edge_deg)
    tangent = reoriented(n[0], tilted(np.full(count, np.pi / 2), turn))
    along = np.sum(n * tangent, axis=-1, keepdims=True)
    turned = n * np.cos(angle) + np.cross(np.broadcast_to(tangent, n.shape), n) * np.sin(angle)
    turned += tangent * along * (1 - np.cos(angle))
    mixed = np.where(is_beyond[..., None], unit_rows(turned), n)
    return replace(patches, edge_deg=edge_deg, normals=rounded(mixed), is_anywhere=False)


def _own_neighbours(normals: NormalSet, count: int, seed: int) -> Iterator[Patches]:
    """Yield up to two sets of fully covered squares at random places of an image: first squares inside a surface,
    then squares across an edge, with the median angle of the edges. Nothing if no square is covered."""
    assert normals.shape
    height, width = normals.shape
    n, view, covered = (a.reshape(height, width, -1) for a in _set_arrays(normals))
    if min(height, width) < SIDE:
        return
    window = np.lib.stride_tricks.sliding_window_view(covered[..., 0], (SIDE, SIDE)).all(axis=(2, 3))
    places = np.argwhere(window)
    if not len(places):
        return
    y, x = np.random.default_rng([seed, 0]).permutation(places)[:count].T
    chosen = _patch_indices(len(x))
    right, up = np.meshgrid(np.arange(SIDE), np.arange(SIDE))
    rows, columns = (a.reshape(TEXELS, 1) + b for a, b in ((up, y[chosen]), (right, x[chosen])))
    cut, seen = unit_rows(n[rows, columns].astype(np.float64)), view[rows[0], columns[0]]
    steepest = _steepest_deg(cut)
    for is_edge in (False, True):
        (which,) = np.nonzero((steepest[: len(x)] > LEAST_EDGE_DEG) == is_edge)
        if len(which):
            again = which[_patch_indices(len(which))]
            edge = float(np.round(np.median(steepest[which]))) if is_edge else None
            cut_out = rounded(cut[:, again]), seen[again]
            yield Patches(normals.name, None, len(which), *cut_out, seed, edge, normals.code_space)


def _steepest_deg(normals: np.ndarray) -> np.ndarray:
    """Return the largest angle between adjacent texels in each patch, in degrees, of shape (patches,).

    Args:
        normals: array of shape (TEXELS, patches, 3)."""
    grid = normals.reshape(SIDE, SIDE, *normals.shape[1:])
    pairs = ((grid[1:], grid[:-1]), (grid[:, 1:], grid[:, :-1]))
    return np.max([angles_between(first, other).max(axis=(0, 1)) for first, other in pairs], axis=0)


def rounded(n: np.ndarray) -> np.ndarray:
    """Return normals rounded to float32, the precision of an encoder's input, as float64."""
    return n.astype(np.float32).astype(np.float64)
