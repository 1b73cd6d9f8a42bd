"""FLIP, a measure of the perceived difference between two images that alternate at the same place.

P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild: FLIP: A Difference Evaluator
for Alternating Images, HPG 2020. Implemented as published for images in [0, 1], with separable filters.
"""

from __future__ import annotations

import math
from functools import cache, cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.ndimage import correlate1d

if TYPE_CHECKING:
    from jaxtyping import Float

    Plane = Float[np.ndarray, "height width"]
    Planes = Float[np.ndarray, "3 height width"]

# The authors' screen: 0.7 m wide, with 3840 pixels, at 0.7 m.
PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * math.pi / 180

# Contrast sensitivity as sums of a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees, by channel of YCxCz (table 1).
SENSITIVITY = (((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))
WIDEST = 0.04
# Features are seen with filters of this width in degrees (section 3.3).
FEATURE_DEG = 0.082
# Exponents of the colour's and the feature's difference, and the two points of the map to [0, 1] (section 3.2).
Q_COLOUR, Q_FEATURE, P_COLOUR, P_TARGET = 0.7, 0.5, 0.4, 0.95

# Linear sRGB to XYZ, and the white of D65.
XYZ_OF_RGB = np.array(
    [
        [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
        [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
        [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
    ],
    np.float32,
)
RGB_OF_XYZ = np.linalg.inv(XYZ_OF_RGB.astype(float)).astype(np.float32)
WHITE = XYZ_OF_RGB.sum(axis=1)[:, None, None]


class _Seen(NamedTuple):
    """An image as the eye perceives it: L*a*b* with the Hunt effect, and the strengths of edges and points."""

    colour: Planes
    edges: Plane
    points: Plane


class Flip:
    """A comparison of images with one reference, which is filtered only once, on first use.

    Args:
        reference: sRGB display values in [0, 1].
    """

    def __init__(self, reference: Float[np.ndarray, "height width 3"]):
        self.reference = reference

    @cached_property
    def _reference_seen(self) -> _Seen:
        return _seen(self.reference)

    def of(self, image: Float[np.ndarray, "height width 3"]) -> Plane:
        """Return the difference between an image and the reference at each pixel, 0 to 1.

        Args:
            image: sRGB display values, of the same size as the reference. NaN counts as 0.
        """
        ours, theirs = _seen(image), self._reference_seen
        apart = _apart(ours.colour, theirs.colour) ** Q_COLOUR
        most, knee = _most(), P_COLOUR * _most()
        colour = np.where(
            apart < knee, apart * (P_TARGET / knee), P_TARGET + (apart - knee) * ((1 - P_TARGET) / (most - knee))
        )
        strongest = np.maximum(abs(ours.edges - theirs.edges), abs(ours.points - theirs.points))
        return colour ** (1 - (strongest / math.sqrt(2)) ** Q_FEATURE)


def _seen(image: Float[np.ndarray, "height width 3"]) -> _Seen:
    planes = np.ascontiguousarray(np.moveaxis(np.nan_to_num(image, posinf=1.0, neginf=0.0), -1, 0), np.float32)
    opponent = _opponent_of(_mixed(XYZ_OF_RGB, _linear(np.clip(planes, 0, 1))))
    filtered = np.stack([_filtered(plane, terms) for plane, terms in zip(opponent, SENSITIVITY, strict=True)])
    colour = _lab_of(_mixed(XYZ_OF_RGB, np.clip(_mixed(RGB_OF_XYZ, _xyz_of(filtered)), 0, 1)))
    return _Seen(colour, *_features((opponent[0] + 16) / 116))


def _mixed(matrix: Float[np.ndarray, "3 3"], planes: Planes) -> Planes:
    return np.tensordot(matrix, planes, 1)


def _linear(srgb: Planes) -> Planes:
    return np.where(srgb > 0.04045, ((srgb + 0.055) / 1.055) ** 2.4, srgb / 12.92)


def _opponent_of(xyz: Planes) -> Planes:
    """Convert XYZ to YCxCz relative to white, (3, height, width): 116 Y - 16, 500 (X - Y), 200 (Y - Z)."""
    x, y, z = xyz / WHITE
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def _xyz_of(opponent: Planes) -> Planes:
    y = (opponent[0] + 16) / 116
    return np.stack([y + opponent[1] / 500, y, y - opponent[2] / 200]) * WHITE


def _lab_of(xyz: Planes) -> Planes:
    """Convert XYZ to L*a*b*, (3, height, width), with a* and b* multiplied by 0.01 L* for the Hunt effect."""
    limit = 6 / 29
    share = xyz / WHITE
    x, y, z = np.where(share > limit**3, np.cbrt(share), share / (3 * limit**2) + 4 / 29)
    lightness = 116 * y - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)])


def _apart(a: Planes, b: Planes) -> Plane:
    """Return the HyAB distance between two L*a*b* images at each pixel: distance in L* plus distance in (a*, b*)."""
    return abs(a[0] - b[0]) + np.hypot(a[1] - b[1], a[2] - b[2])


@cache
def _most() -> float:
    """Return the largest colour difference, between green and blue, raised to the power Q_COLOUR."""
    green, blue = (_lab_of(_mixed(XYZ_OF_RGB, np.eye(3, dtype=np.float32)[k][:, None, None])) for k in (1, 2))
    return float(_apart(green, blue)[0, 0] ** Q_COLOUR)


def _filtered(plane: Plane, terms: tuple[tuple[float, float], ...]) -> Plane:
    """Return a plane filtered with a sum of separable Gaussians, normalised to 1.

    Args:
        terms: (a, b) for each Gaussian a sqrt(pi / b) exp(-pi^2 d^2 / b), with the distance d in degrees."""
    radius = math.ceil(3 * math.sqrt(WIDEST / (2 * math.pi**2)) * PIXELS_PER_DEGREE)
    degrees = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
    gaussians = [np.exp(-((math.pi * degrees) ** 2) / b) for _, b in terms]
    weights = [a * math.sqrt(math.pi / b) * g.sum() ** 2 for (a, b), g in zip(terms, gaussians, strict=True)]
    seen = [w * _along_both(plane, g / g.sum(), g / g.sum()) for w, g in zip(weights, gaussians, strict=True)]
    return np.sum(seen, axis=0) / sum(weights)


def _features(lightness: Plane) -> tuple[Plane, Plane]:
    """Return the strengths of edges and of points at each pixel, from the first and second derivatives of a Gaussian,
    with positive weights that add up to 1 and negative weights that add up to -1."""
    width = 0.5 * FEATURE_DEG * PIXELS_PER_DEGREE
    radius = math.ceil(3 * width)
    x = np.arange(-radius, radius + 1)
    gaussian = np.exp(-(x**2) / (2 * width**2))
    smooth = gaussian / gaussian.sum()
    both = (_balanced(-x * gaussian), _balanced((x**2 / width**2 - 1) * gaussian))
    edges, points = (np.hypot(_along_both(lightness, k, smooth), _along_both(lightness, smooth, k)) for k in both)
    return edges, points


def _balanced(weights: Float[np.ndarray, " taps"]) -> Float[np.ndarray, " taps"]:
    return np.where(weights > 0, weights / weights[weights > 0].sum(), weights / -weights[weights < 0].sum())


def _along_both(plane: Plane, along_x: Float[np.ndarray, " taps"], along_y: Float[np.ndarray, " taps"]) -> Plane:
    return correlate1d(correlate1d(plane, along_x, 1, mode="nearest"), along_y, 0, mode="nearest")
