"""How far light travels through skin, and the taps of each method. Lengths are in millimetres of skin.

d'Eon and Luebke, Advanced Techniques for Realistic Real-Time Skin Rendering, GPU Gems 3, 2007, chapter 14;
Jimenez and Gutierrez, SeparableSSS, 2012; Christensen and Burley, Approximate Reflectance Profiles for Efficient
Subsurface Scattering, 2015.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

# d'Eon's three-layer skin: six Gaussians, their variances in square millimetres, and weights of red, green and blue.
VARIANCES = np.array([0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41])
WEIGHTS = np.array(
    [
        (0.233, 0.455, 0.649),
        (0.100, 0.336, 0.344),
        (0.118, 0.198, 0.0),
        (0.113, 0.007, 0.007),
        (0.358, 0.004, 0.0),
        (0.078, 0.0, 0.0),
    ]
)

# What the separable kernel makes of them: the wider five of red for all channels, drawn together by channel. The
# narrowest is light that does not go in, which the strength accounts for.
STRENGTH, FALL_OFF = np.array([0.48, 0.41, 0.28]), np.array([1.0, 0.37, 0.3])
LEAST_FALL_OFF = 0.001
# Kernels of more than 20 samples reach 3 mm, others 2; offsets grow with the square of their number.
REACHES, MANY = (2.0, 3.0), 20


def separable_kernel(samples: int) -> np.ndarray:
    """Return weights for red, green and blue, and offsets in mm, (samples, 4), starting with the central tap.

    The kernel is that of SeparableSSS.cpp, 2012.

    Args:
        samples: number of taps, odd, 3 or more.
    """
    reach = REACHES[samples > MANY]
    o = np.linspace(-reach, reach, samples)
    # range sign(o) o^2 / range^2
    offsets = np.sign(o) * o**2 / reach
    gaps = np.abs(np.diff(offsets, prepend=offsets[0], append=offsets[-1]))
    weights = ((gaps[:-1] + gaps[1:]) / 2)[:, None] * _narrowed_profile(offsets)
    # k_i = s k_i / sum k, and of what does not go in: k_0 = 1 - s + s k_0
    weights = STRENGTH * weights / weights.sum(axis=0)
    weights[samples // 2] += 1 - STRENGTH
    kernel = np.concatenate([weights, offsets[:, None]], axis=1)
    return np.concatenate([kernel[samples // 2 :][:1], np.delete(kernel, samples // 2, axis=0)])


def _narrowed_profile(r: np.ndarray) -> np.ndarray:
    """Return the sum of w_red exp(-(r / (0.001 + falloff))^2 / 2v) / v, (offsets, 3), up to a constant factor."""
    rr = (r[:, None] / (LEAST_FALL_OFF + FALL_OFF)) ** 2
    v = VARIANCES[1:]
    return np.einsum("g,gnc->nc", WEIGHTS[1:, 0] / v, np.exp(-rr / (2 * v[:, None, None])))


@dataclass(frozen=True)
class Gaussians:
    """A sum of Gaussians, each computed by blurring the previous Gaussian.

    Attributes:
        variances: variances in square millimetres, in ascending order.
        weights: weights of red, green and blue, (1 + number of Gaussians, 3); the first row is for unblurred light.
    """

    variances: tuple[float, ...]
    weights: np.ndarray

    @property
    def increments(self) -> np.ndarray:
        """Variance of each blur: the differences of `variances`, because sigma_fg^2 = sigma_f^2 + sigma_g^2."""
        return np.diff(self.variances, prepend=0.0)


# By X/Y pairs. Five are d'Eon's own, whose narrowest Gaussian, of 0.08 mm, is left unblurred. Three and four are fitted
# to them by least squares over the plane, with weights that are not negative and sum to 1.
GAUSSIANS: Mapping[int, Gaussians] = MappingProxyType(
    {
        3: Gaussians(
            (0.04889, 0.2125, 2.027),
            np.array(
                [
                    (0.2334, 0.4548, 0.6494),
                    (0.0980, 0.3474, 0.3459),
                    (0.1705, 0.1978, 0.0),
                    (0.4981, 0.0, 0.0047),
                ]
            ),
        ),
        4: Gaussians(
            (0.04840, 0.1912, 0.9595, 3.316),
            np.array(
                [
                    (0.2331, 0.4550, 0.6490),
                    (0.0990, 0.3370, 0.3436),
                    (0.1333, 0.2012, 0.0024),
                    (0.2375, 0.0041, 0.0050),
                    (0.2971, 0.0027, 0.0),
                ]
            ),
        ),
        5: Gaussians(tuple(VARIANCES[1:].tolist()), WEIGHTS),
    }
)
# Taps of a Gaussian lie within so many standard deviations.
DEVIATIONS = 3.0


def gaussian_kernel(variance: float, samples: int) -> np.ndarray:
    """Return weights, equal for red, green and blue, and offsets in mm, (samples, 4), in ascending order of offset.
    Taps are evenly spaced over 3 standard deviations on either side; `variance` is in mm^2."""
    offsets = np.linspace(-DEVIATIONS, DEVIATIONS, samples) * variance**0.5
    weights = np.exp(-(offsets**2) / (2 * variance))
    return np.concatenate([np.repeat(weights[:, None] / weights.sum(), 3, axis=1), offsets[:, None]], axis=1)


def burley_distances() -> np.ndarray:
    """Return the distances d, in mm, of R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r) for red, green and blue.

    With these distances, light travels as far on average as with d'Eon's sum: the mean of r is 2.5 d for R, and
    sqrt(pi v / 2) for a Gaussian of variance v.
    """
    return np.sqrt(np.pi * VARIANCES / 2) @ WEIGHTS / 2.5


def burley_radius(u: np.ndarray, d: float) -> np.ndarray:
    """Return the radii within which the shares `u` of the light remain, each in [0, 1), for a distance d. This is the
    inverse of CDF(r) = 1 - e^(-r/d) / 4 - 3 e^(-r/3d) / 4 (Golubev 2019)."""
    # With x = e^(-r/3d), x^3 + 3x = 4 (1 - u) = k, which has one real root.
    k = 4 * (1 - np.asarray(u))
    g = np.cbrt(k / 2 + np.sqrt(k**2 / 4 + 1))
    return -3 * d * np.log(g - 1 / g)


def burley_radii(samples: int) -> np.ndarray:
    """Return the radii of a disc's taps, (samples,), in mm: midpoints of equal shares of red, which goes farthest."""
    return burley_radius((np.arange(samples) + 0.5) / samples, float(burley_distances().max()))
