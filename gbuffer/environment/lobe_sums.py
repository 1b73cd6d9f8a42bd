"""An environment filtered by GGX's lobe around each direction: sums over all of its texels, not samples.

The lobe depends on two latitudes and a difference of longitudes. The contribution of a row of texels to a row of
directions is therefore a convolution along the longitudes, computed as a product of spectra. A lobe several texels
wide is summed by its values at texel centres. A narrower lobe is integrated over each texel, whose radiance is
constant. Far from the lobe's centre the integral uses two latitudes per texel and is exact along the longitudes; near
the centre it uses as many nodes as needed.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from scipy import fft

# Half the width of a lobe, in texels, from which values in the middles of texels are enough: their sum is the lobe's
# integral to 1e-7.
RESOLVED = 3
# This many rows away two nodes integrate any lobe over a texel to 1e-4 of it.
NEAR = 6.5
# Nodes of a piece of a near texel; pieces are half as wide as the lobe in its middle, and double from there.
NODES = 4
# Rows of directions at once, and longitudes of the lobe at once: what the processor's cache holds.
ROWS, LONGITUDES = 8, 64


@dataclass(frozen=True)
class Grid:
    """Grid of texels and directions.

    Attributes:
        height: rows of the environment, which is twice as wide.
        step: number of texels per direction along either axis: 1, or an even number.
        alpha: alpha of the lobe, above 0.
    """

    height: int
    step: int
    alpha: float

    @property
    def width(self) -> int:
        return 2 * self.height

    @property
    def texel(self) -> float:
        """Height and width of a texel, in radians."""
        return np.pi / self.height

    @property
    def latitudes(self) -> np.ndarray:
        """Polar angles of the rows of directions, in radians."""
        return (np.arange(self.height // self.step) + 0.5) * self.texel * self.step

    @property
    def offset(self) -> float:
        """Longitude from a direction to the centre of its own texel, or of the next texel to the right, in texels."""
        return 0.0 if self.step == 1 else 0.5

    @property
    def scale(self) -> float:
        """Half the lobe's width, in radians."""
        return 2 * self.alpha

    @property
    def is_resolved(self) -> bool:
        """Whether the lobe's values at texel centres are accurate enough."""
        return self.scale >= RESOLVED * self.texel


def lobe(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """Return D n.l for n = v = r, up to a factor, from r.l in `cosine`, which is overwritten with the result."""
    density = cosine * (0.5 * (alpha**2 - 1))
    density += 0.5 * (1 + alpha**2)
    np.square(density, out=density)
    np.maximum(cosine, 0, out=cosine)
    return np.divide(cosine, density, out=cosine)


def seen_through_lobe(radiance: np.ndarray, alpha: float, step: int = 1) -> np.ndarray:
    """Return the mean of an environment over the lobe of each direction, (height / step, width / step, 3), float64.

    Args:
        radiance: (height, width, 3), width twice the height.
        alpha: roughness squared, above 0.
        step: number of texels per direction along either axis: 1, or an even number that divides the height.
    """
    grid = Grid(len(radiance), step, alpha)
    spectra = _spectra(grid, radiance)
    rows = len(grid.latitudes)
    seen = np.empty((rows, 2 * rows, 3))
    for first in range(0, -(-rows // 2), ROWS):
        # Rows below the equator see the mirror image.
        upper = np.arange(first, min(first + ROWS, -(-rows // 2)))
        sums, weights = _sums(grid, grid.latitudes[upper], spectra)
        seen[upper], seen[rows - 1 - upper] = (_pixels(grid, half) / weights for half in (sums[..., :3], sums[..., 3:]))
    return seen


def _spectra(grid: Grid, radiance: np.ndarray) -> np.ndarray:
    """Return spectra along the longitudes, (frequencies, rows, 12): those of each channel, then those of the image
    upside down; first the real parts of all six, then their imaginary parts."""
    spectra = np.asarray(fft.rfft(radiance.astype(np.float64), axis=1, workers=1)).swapaxes(0, 1)
    spectra = spectra * _width(grid)[:, None, None]
    both = np.concatenate([spectra, spectra[:, ::-1]], axis=-1)
    return np.ascontiguousarray(np.concatenate([np.real(both), np.imag(both)], axis=-1))


def _width(grid: Grid) -> np.ndarray:
    """Return the spectrum of a texel along its row, (height + 1,): that of its whole width or, if the lobe is
    resolved, that of a peak at its centre, which is 1 everywhere."""
    frequencies = np.arange(grid.height + 1)
    return np.ones(len(frequencies)) if grid.is_resolved else np.sinc(frequencies / grid.width)


def _sums(grid: Grid, latitudes: np.ndarray, spectra: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the spectra of radiance times lobe, (frequencies, rows of directions, 6), and the sums of the lobe,
    (rows, 1, 1)."""
    lobes = _lobe_spectra(grid, latitudes)
    sums = lobes @ spectra
    return sums[..., :6] + 1j * sums[..., 6:], lobes[0].sum(-1)[:, None, None]


def _pixels(grid: Grid, spectrum: np.ndarray) -> np.ndarray:
    """Return the values of rows of directions, (rows, width / step, 3), from spectra, (frequencies, rows, 3)."""
    turned = spectrum * np.exp(-2j * np.pi * grid.offset / grid.width * np.arange(len(spectrum)))[:, None, None]
    every = np.asarray(fft.irfft(turned, grid.width, axis=0, workers=1))
    return every[grid.step // 2 :: grid.step].swapaxes(0, 1)


def _lobe_spectra(grid: Grid, latitudes: np.ndarray) -> np.ndarray:
    """Return the spectra, along each row of texels, of the lobes around directions of these latitudes, with the shape
    (frequencies, directions, rows)."""
    spectra = _transformed(grid, _far_lobes(grid, latitudes))
    if not grid.is_resolved:
        for number, latitude in enumerate(latitudes):
            near, lobes = _near_lobes(grid, latitude)
            # These are integrated along the longitudes already, and their texels' spectra have the width in them.
            spectra[:, number, near] = _transformed(grid, lobes) / _width(grid)[:, None]
    return spectra


def _transformed(grid: Grid, lobes: np.ndarray) -> np.ndarray:
    """Return the real spectra of symmetrical lobes from one half of their longitudes, the first axis. A lobe is
    centred on the centre or the edge of a texel."""
    if not grid.offset:
        return np.asarray(fft.dct(lobes, 1, axis=0, workers=1))
    spectrum = np.asarray(fft.dct(lobes, 2, axis=0, workers=1))
    # The highest frequency is 0 at all nodes.
    return np.concatenate([spectrum, np.zeros_like(spectrum[:1])])


def _far_lobes(grid: Grid, latitudes: np.ndarray) -> np.ndarray:
    """Return integrals of the lobe over texel heights, at central longitudes, (longitudes, directions, rows)."""
    turns = np.cos((np.arange(grid.height + (not grid.offset)) + grid.offset) * grid.texel)
    nodes, weights = _gauss(np.arange(grid.height + 1) * grid.texel, 1 if grid.is_resolved else 2)
    nodes, weights = nodes.T.ravel(), (weights * np.sin(nodes)).T.ravel()
    integrals = np.empty((len(turns), len(latitudes), grid.height))
    for number, latitude in enumerate(latitudes):
        level, tilt = np.cos(latitude) * np.cos(nodes), np.sin(latitude) * np.sin(nodes)
        for first in range(0, len(turns), LONGITUDES):
            part = slice(first, first + LONGITUDES)
            values = lobe(turns[part, None] * tilt + level, grid.alpha)
            values *= weights
            np.sum(values.reshape(len(values), -1, grid.height), axis=1, out=integrals[part, number])
    return integrals


def _near_lobes(grid: Grid, latitude: float) -> tuple[slice, np.ndarray]:
    """Return the slice of rows near a direction's latitude, and integrals of the lobe there, (longitudes, rows)."""
    place = latitude / grid.texel
    first, end = max(0, int(np.ceil(place - NEAR - 0.5))), min(grid.height, int(place + NEAR + 0.5))
    edges = np.arange(first, end + 1) * grid.texel
    nodes, weights, rows = _pieces(edges, latitude, grid.scale, np.inf)
    # The shortest circle of latitude near by has the lobe spread over the most longitudes.
    sine = np.sin(np.clip(np.pi / 2, edges[0], edges[-1]))
    turns = np.arange(grid.height + (not grid.offset) + 1) + grid.offset - 0.5
    reach = 8 * grid.texel / max(np.sin(latitude), grid.texel)
    longitudes, breadths, columns = _pieces(turns * grid.texel, 0, grid.scale / sine, reach)
    cosines = np.cos(longitudes)[:, None] * (np.sin(latitude) * np.sin(nodes)) + np.cos(latitude) * np.cos(nodes)
    values = lobe(cosines, grid.alpha) * (weights * np.sin(nodes)) * breadths[:, None] / grid.texel
    return slice(first, end), np.add.reduceat(np.add.reduceat(values, columns, axis=0), rows, axis=1)


def _pieces(edges: np.ndarray, middle: float, scale: float, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return nodes and weights of integrals between neighbouring edges, and the index of each integral's first node.

    Pieces are half of `scale` wide at the lobe's centre and double in width outwards; beyond `reach` each piece has
    two nodes.
    """
    doublings = np.arange(1 + max(0, int(np.ceil(np.log2(2 * (edges[-1] - edges[0]) / scale)))))
    graded = scale / 2 * 2.0**doublings
    cuts = np.concatenate([middle - graded[::-1], [middle], middle + graded])
    cut = np.unique(np.concatenate([edges, cuts[(cuts > edges[0]) & (cuts < edges[-1])]]))
    last = int(np.searchsorted(cut, min(middle + reach, edges[-1])))
    (near, of_near), (far, of_far) = _gauss(cut[: last + 1], NODES), _gauss(cut[last:], 2)
    begins = np.searchsorted(cut, edges[:-1])
    starts = np.minimum(begins, last) * NODES + np.maximum(begins - last, 0) * 2
    nodes, weights = np.concatenate([near.ravel(), far.ravel()]), np.concatenate([of_near.ravel(), of_far.ravel()])
    return nodes, weights, starts


def _gauss(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss-Legendre nodes and weights between neighbouring edges, (intervals, count)."""
    nodes, weights = _legendre(count)
    middles, halves = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    return middles[:, None] + halves[:, None] * nodes, halves[:, None] * weights


@functools.cache
def _legendre(count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.polynomial.legendre.leggauss(count)
