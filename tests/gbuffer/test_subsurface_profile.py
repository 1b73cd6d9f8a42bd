"""Light in skin: the kernels and sums that the blurs use, without a device."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from normalbench.gbuffer.effects.subsurface.profile import (
    GAUSSIANS,
    VARIANCES,
    WEIGHTS,
    burley_distances,
    burley_radii,
    burley_radius,
    gaussian_kernel,
    separable_kernel,
)

# The kernels that SeparableSSS.h (Jimenez and Gutierrez, 2012) prints for its three qualities: the middle and one side.
PRESETS = {
    11: """0.560479 0.669086 0.784728 0
        0.00471691 0.000184771 5.07566e-005 -2
        0.0192831 0.00282018 0.00084214 -1.28
        0.03639 0.0130999 0.00643685 -0.72
        0.0821904 0.0358608 0.0209261 -0.32
        0.0771802 0.113491 0.0793803 -0.08""",
    17: """0.536343 0.624624 0.748867 0
        0.00317394 0.000134823 3.77269e-005 -2
        0.0100386 0.000914679 0.000275702 -1.53125
        0.0144609 0.00317269 0.00106399 -1.125
        0.0216301 0.00794618 0.00376991 -0.78125
        0.0347317 0.0151085 0.00871983 -0.5
        0.0571056 0.0287432 0.0172844 -0.28125
        0.0582416 0.0659959 0.0411329 -0.125
        0.0324462 0.0656718 0.0532821 -0.03125""",
    25: """0.530605 0.613514 0.739601 0
        0.000973794 1.11862e-005 9.43437e-007 -3
        0.00333804 7.85443e-005 1.2945e-005 -2.52083
        0.00500364 0.00020094 5.28848e-005 -2.08333
        0.00700976 0.00049366 0.000151938 -1.6875
        0.0094389 0.00139119 0.000416598 -1.33333
        0.0128496 0.00356329 0.00132016 -1.02083
        0.017924 0.00711691 0.00347194 -0.75
        0.0263642 0.0119715 0.00684598 -0.520833
        0.0410172 0.0199899 0.0118481 -0.333333
        0.0493588 0.0367726 0.0219485 -0.1875
        0.0402784 0.0657244 0.04631 -0.0833333
        0.0211412 0.0459286 0.0378196 -0.0208333""",
}


@pytest.mark.parametrize("samples", PRESETS)
def test_the_kernel_matches_the_published_kernel(samples):
    """Every weight and offset agrees with the printed digits to a relative 1e-5, and the kernel is symmetric."""
    kernel = separable_kernel(samples)
    printed = np.array(PRESETS[samples].split(), float).reshape(-1, 4)
    half = len(printed)
    apart = np.abs(kernel[:half] / np.where(printed == 0, 1, printed) - (printed != 0)).max()
    assert apart < 1e-5, f"{apart:.2g}, of {samples} samples"
    assert np.allclose(kernel[half:][::-1], kernel[1:half] * (1, 1, 1, -1), rtol=0, atol=1e-15)


@pytest.mark.parametrize("samples", [11, 17, 25, 33, 65, 97])
def test_a_kernel_conserves_light(samples):
    """The weights sum to 1 in each channel, to 1e-12."""
    for kernel in (separable_kernel(samples), gaussian_kernel(2.0, samples)):
        assert np.abs(kernel[:, :3].sum(axis=0) - 1).max() < 1e-12, kernel[:, :3].sum(axis=0)


def test_zero_thickness_loses_no_light():
    """T(0), the sum of the profile's weights, is 1 in each channel."""
    assert np.abs(WEIGHTS.sum(axis=0) - 1).max() < 1e-12, WEIGHTS.sum(axis=0)


# Sums of Gaussians


def overlap(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return integrals over the plane of products of normalised Gaussians: 1 / (2 pi (v_a + v_b))."""
    return 1 / (2 * np.pi * (a[:, None] + b))


def best(variances: np.ndarray, channel: int) -> tuple[np.ndarray, float]:
    """Return the weights, non-negative and with a sum of 1, that come closest to the six Gaussians, and the integral
    of the squared difference. The narrowest Gaussian is kept."""
    v = np.concatenate([VARIANCES[:1], variances])
    gram, target = overlap(v, v), overlap(v, VARIANCES) @ WEIGHTS[:, channel]
    root, heavy = np.linalg.cholesky(gram), 1e4
    weights, _ = nnls(
        np.vstack([root.T, np.full(len(v), heavy)]), np.concatenate([np.linalg.solve(root, target), [heavy]])
    )
    return weights, difference(v, weights, channel)


def difference(v: np.ndarray, weights: np.ndarray, channel: int) -> float:
    all_of_them, signed = np.concatenate([v, VARIANCES]), np.concatenate([weights, -WEIGHTS[:, channel]])
    return float(signed @ overlap(all_of_them, all_of_them) @ signed)


@pytest.mark.parametrize("pairs", [3, 4])
def test_fewer_gaussians_fit_the_six_optimally(pairs):
    """The weights are optimal for their variances, to 5e-4, and no variance 3% off gives less than 0.97 of the
    squared difference. The remaining error is 0.23% and 0.05% of the profile's norm for three and four pairs."""
    chosen, left = GAUSSIANS[pairs], {3: 0.0023, 4: 0.00052}[pairs]
    variances = np.array(chosen.variances)
    fits = [best(variances, channel) for channel in range(3)]
    apart = np.abs(np.stack([weights for weights, _ in fits], axis=1) - chosen.weights).max()
    assert apart < 5e-4, f"{apart:.2g}"
    assert np.abs(chosen.weights.sum(axis=0) - 1).max() < 1e-12, chosen.weights.sum(axis=0)
    total = sum(error for _, error in fits)
    for number in range(pairs):
        for factor in (0.97, 1.03):
            moved = np.where(np.arange(pairs) == number, factor * variances, variances)
            other = sum(best(moved, channel)[1] for channel in range(3))
            assert other > 0.97 * total, f"{moved}: {other:.3g}, and {total:.3g} as it is"
    norm = sum(WEIGHTS[:, c] @ overlap(VARIANCES, VARIANCES) @ WEIGHTS[:, c] for c in range(3))
    assert (total / norm) ** 0.5 < left, f"{(total / norm) ** 0.5:.3%}"


def test_five_pairs_of_blurs_give_the_six_gaussians():
    """sigma_fg^2 = sigma_f^2 + sigma_g^2: the blurs' variances add up to d'Eon's."""
    five = GAUSSIANS[5]
    assert np.allclose(np.cumsum(five.increments), VARIANCES[1:], rtol=1e-12)
    assert five.weights is WEIGHTS


# Normalised diffusion


def share_within(r: np.ndarray, d: float) -> np.ndarray:
    """Return CDF(r) = 1 - e^(-r/d) / 4 - 3 e^(-r/3d) / 4."""
    return 1 - np.exp(-r / d) / 4 - 3 * np.exp(-r / (3 * d)) / 4


def test_the_radius_is_the_inverse_of_the_share():
    """Accurate to 1e-9 up to a share of 0.9999; shares 0.5, 0.9 and 0.99 are at 1.552, 6.06 and 12.95 d."""
    u = np.linspace(0, 0.9999, 10001)
    apart = np.abs(share_within(burley_radius(u, 0.7), 0.7) - u).max()
    assert apart < 1e-9, f"{apart:.2g}"
    assert burley_radius(np.array([0.0, 0.5, 0.9, 0.99]), 1.0) == pytest.approx((0, 1.552, 6.06, 12.95), abs=5e-3)


@pytest.mark.parametrize("d", [0.05, 0.5, 2.0])
def test_normalised_diffusion_conserves_light(d):
    """R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r) integrates to 1 over the plane, to 1e-6, and up to r to the CDF."""
    edges = np.linspace(0, 80 * d, 400001)
    r, step = (edges[1:] + edges[:-1]) / 2, edges[1]
    ring = (np.exp(-r / d) + np.exp(-r / (3 * d))) / (8 * np.pi * d * r) * 2 * np.pi * r * step
    within = np.cumsum(ring)
    assert abs(within[-1] - 1) < 1e-6, within[-1]
    apart = np.abs(within - share_within(edges[1:], d)).max()
    assert apart < 1e-6, f"{apart:.2g}"


def test_normalised_diffusion_reaches_as_far_as_the_gaussians():
    """The mean of r, integrated numerically, is that of d'Eon's sum, to 1e-4."""
    edges = np.linspace(0, 60, 600001)
    r, step = (edges[1:] + edges[:-1]) / 2, edges[1]
    for channel, d in enumerate(burley_distances().tolist()):
        burley = np.sum((np.exp(-r / d) + np.exp(-r / (3 * d))) / (4 * d) * r) * step
        sums = (np.exp(-(r**2) / (2 * v)) * r / v * r * w for v, w in zip(VARIANCES, WEIGHTS[:, channel], strict=True))
        gaussians = np.sum(sum(sums)) * step
        assert burley == pytest.approx(gaussians, rel=1e-4), f"channel {channel}"


def test_taps_cover_equal_shares():
    """In red, the widest channel, adjacent taps enclose a share of 1 / samples."""
    shares = share_within(burley_radii(33), burley_distances().max())
    assert np.allclose(np.diff(shares), 1 / 33, atol=1e-9)
