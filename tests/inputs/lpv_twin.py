"""Light propagation volumes in NumPy and float64, written from the papers: a reference for the shaders.

A field has the shape (x, y, z, 4, channels): four coefficients of spherical harmonics in each cell. Points are given
in cells from the low corner of the volume.
"""

from __future__ import annotations

from itertools import product

import numpy as np

# Y_00, Y_1-1, Y_10, Y_11 = (1/2 sqrt(1/pi), -1/2 sqrt(3/pi) y, 1/2 sqrt(3/pi) z, -1/2 sqrt(3/pi) x)
BAND0, BAND1 = 0.5 * np.sqrt(1 / np.pi), 0.5 * np.sqrt(3 / np.pi)
# The Lambertian lobe: pi in band 0, 2 pi / 3 in band 1
LOBE = np.array([np.pi, *[2 * np.pi / 3] * 3])
AXES = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
SHIFT = 0.5 - 2.0**-10


def harmonics(w) -> np.ndarray:
    """Return the harmonics, (..., 4), of directions, (..., 3)."""
    w = np.asarray(w, float)
    constant = np.full(w.shape[:-1], BAND0)
    return np.stack([constant, -BAND1 * w[..., 1], BAND1 * w[..., 2], -BAND1 * w[..., 0]], axis=-1)


def lobe(n) -> np.ndarray:
    """Return max(n.w, 0) in two bands, (..., 3) to (..., 4)."""
    return LOBE * harmonics(n)


def square_angle(distance: float, half: float = 0.5) -> float:
    """Return the solid angle of a square seen along its axis: four quarters, each asin(sin a sin b) for the angles to
    its edges."""
    sine = half / np.hypot(half, distance)
    return 4 * float(np.arcsin(sine * sine))


FRONT = square_angle(1.5)
SIDE = (square_angle(0.5) - FRONT) / 4


def flux(field: np.ndarray) -> np.ndarray:
    """Return a field's total flux for each channel: its intensity integrated over the sphere."""
    return field[..., 0, :].sum(axis=(0, 1, 2)) * 2 * np.sqrt(np.pi)


def added(shape: tuple[int, int, int], points: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the sum of the points' values in each cell, floor(point); points outside are left out."""
    cell = np.floor(points).astype(int)
    inside = np.all((cell >= 0) & (cell < shape), axis=-1)
    field = np.zeros((*shape, *values.shape[1:]))
    np.add.at(field, tuple(cell[inside].T), values[inside])
    return field


def injected(cells: int, points: np.ndarray, normals: np.ndarray, fluxes: np.ndarray) -> np.ndarray:
    """Return the field of VPLs. Points and normals are (count, 3), fluxes (count, channels)."""
    values = lobe(normals)[:, :, None] * fluxes[:, None, :] / np.pi
    return added((cells,) * 3, points + SHIFT * normals, values)


def blocked(cells: int, points: np.ndarray, normals: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Return the potentials of surfels at the cells' corners, (x, y, z, 4); the unit of area is a cell's face."""
    values = lobe(normals) * np.minimum(areas, 1)[:, None]
    return added((cells + 1,) * 3, points + 0.5 + (SHIFT - 0.5) * normals, values)


def shifted(field: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Return the field moved by `by` cells; zeros move in from outside."""
    moved = np.zeros_like(field)
    there = tuple(slice(max(-b, 0), field.shape[i] - max(b, 0)) for i, b in enumerate(by))
    here = tuple(slice(max(b, 0), field.shape[i] + min(b, 0)) for i, b in enumerate(by))
    moved[here] = field[there]
    return moved


def at_faces(potentials: np.ndarray, side: np.ndarray) -> np.ndarray:
    """Return potentials in the middle of each cell's face on one side: the mean of its four corners."""
    count = np.array(potentials.shape[:3]) - 1
    corners = [c for c in product((0, 1), repeat=3) if np.dot(2 * np.array(c) - 1, side) > 0]
    return sum(potentials[tuple(slice(a, a + n) for a, n in zip(c, count, strict=True))] for c in corners) / 4


def step(field: np.ndarray, potentials=None, amplifier=0.0, normaliser=1 / np.pi, clamps=False) -> np.ndarray:
    """Return a field after one step of propagation."""
    after = np.zeros_like(field)
    if potentials is not None:
        most = np.minimum(LOBE[0] * BAND0 / np.maximum(potentials[..., :1], 1e-300), 1)
        potentials = potentials * most
    for way in AXES:
        there = shifted(field, way)
        blockers = at_faces(potentials, -way) if potentials is not None else None
        for face in AXES:
            if np.array_equal(face, -way):
                continue
            ahead = np.array_equal(face, way)
            w = way if ahead else (way + face / 2) / np.linalg.norm(way + face / 2)
            intensity = np.einsum("k,xyzkc->xyzc", harmonics(w), there)
            passes = (FRONT if ahead else SIDE) * (np.maximum(intensity, 0) if clamps else intensity)
            if blockers is not None:
                passes = passes * (1 - np.clip(amplifier * blockers @ harmonics(-w), 0, 1))[..., None]
            after += normaliser * lobe(face)[:, None] * passes[..., None, :]
    return after


def propagated(field: np.ndarray, steps: int, potentials=None, amplifier=0.0) -> np.ndarray:
    """Return the sum of a field and its first `steps` steps of propagation; the first step is not blocked."""
    total = field
    for number in range(steps):
        field = step(field, potentials if number else None, amplifier)
        total = total + field
    return total


def looked_up(total: np.ndarray, points: np.ndarray, normals: np.ndarray, cell: float) -> np.ndarray:
    """Return light times 1 / pi at points, (count, channels), from VPLs whose colours are E / pi; normals of 0 read
    band 0."""
    place = points + 0.5 * normals - 0.5
    corner = np.floor(place).astype(int)
    share, most = place - corner, total.shape[0] - 1
    basis = harmonics(-normals)
    light = np.zeros((len(points), total.shape[-1]))
    for right in product((0, 1), repeat=3):
        neighbours = np.clip(corner + right, 0, most)
        weight = np.prod(np.where(right, share, 1 - share), axis=1)
        light += weight[:, None] * np.einsum("nk,nkc->nc", basis, total[tuple(neighbours.T)])
    return np.maximum(light, 0) / (cell / 2) ** 2
