"""The share of light from a constant environment that a rough metal reflects: the two numbers of the split sum.

    reflected = f0 scale + bias,
    scale = integral of D V n.l (1 - (1 - v.h)^5),  bias = integral of D V n.l (1 - v.h)^5

over light directions l. D is GGX with alpha = roughness^2, V is height-correlated Smith visibility, and the Fresnel
term is Schlick's.
"""

from __future__ import annotations

import functools

import numpy as np

# Gauss-Legendre's nodes along a slope, and in each half of the half turn from the viewer's side to the far side.
NODES = 24, 8
# A bilinear look-up in a table of this size is within 1e-3 of the integral from n.v = 0.05.
SIZE = 128
# n.v = 0 sees no microfacets: its limit is meant, far below every alpha of a table.
LEAST_N_V = 1e-9


def dfg(n_v: np.ndarray, roughness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the scale and the bias of f0, float64, in the broadcast shape of the arguments.

    Args:
        n_v: cosines between normal and viewer, in [0, 1].
        roughness: perceptual roughness, in [0, 1]; 0 is a mirror, for which only the Fresnel term matters.
    """
    n_v, alpha = np.broadcast_arrays(np.maximum(n_v, LEAST_N_V), np.square(np.asarray(roughness, np.float64)))
    weight, v_h = _microfacets(n_v[..., None], alpha[..., None])
    bias = weight * np.square(np.square(1 - v_h)) * (1 - v_h)
    return (weight - bias).sum(-1), bias.sum(-1)


def _microfacets(n_v: np.ndarray, alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each node's contribution to the integral without Fresnel, and its v.h; the nodes are the last axis.

    A microfacet's slope is alpha tan(x) towards longitude p, where p = 0 is the viewer's side. Then D n.h dh is
    sin 2x dx dp / 2 pi, and twice that with the mirror image of p. The light direction reaches the horizon at
    slope^2 - 2 slope tan(v) cos p = 1; x ends there, so that the integrand is smooth.
    """
    share, of_share, cosine, of_turn = _nodes()
    sine = np.sqrt(1 - n_v**2)
    towards = sine / n_v * cosine
    # The greater root of the quadratic, without the difference of large numbers on the far side.
    root = np.abs(towards) + np.sqrt(1 + towards**2)
    steepest = np.where(towards > 0, root, 1 / root)
    end = np.arctan2(steepest, alpha)
    tangent = np.tan(end * share)
    slope = alpha * tangent
    n_h = 1 / np.sqrt(1 + slope**2)
    # v.h / n.h, not negative where light arrives.
    ratio = np.maximum(n_v + sine * slope * cosine, 0)
    n_l = np.maximum(2 * ratio * n_h**2 - n_v, 0)
    s_v, s_l = (np.sqrt(c**2 * (1 - alpha**2) + alpha**2) for c in (n_v, n_l))
    # 4 V n.l v.h / n.h, as dl = 4 v.h dh.
    lit = 2 * n_l * ratio / np.maximum(n_l * s_v + n_v * s_l, np.finfo(np.float64).tiny)
    sine_2x = 2 * tangent / (1 + tangent**2)
    return lit * sine_2x * (end * (of_share * of_turn)), np.minimum(ratio * n_h, 1)


@functools.cache
def _nodes() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return four arrays with one entry per node: its share in [0, 1], the share's weight, the cosine of its
    longitude and the longitude's weight. The products of the two weights sum to 1."""
    (shares, of_shares), (turns, of_turns) = (np.polynomial.legendre.leggauss(count) for count in NODES)
    # On the far side light ends earlier, and for grazing viewers suddenly: no node reaches across.
    longitudes = np.concatenate([(turns + 1) * np.pi / 4, (turns + 3) * np.pi / 4])
    count = len(longitudes)
    along = np.repeat((shares + 1) / 2, count), np.repeat(of_shares / 2, count)
    return *along, np.tile(np.cos(longitudes), NODES[0]), np.tile(of_turns / 4, 2 * NODES[0])


@functools.cache
def dfg_table(size: int = SIZE) -> np.ndarray:
    """Return the scale and bias in a table, (size, size, 2), float32.

    Row i is for roughness i / (size - 1), column j for n.v = (j / (size - 1))^2. Columns are denser at grazing
    angles, because the shadowing of a smooth surface changes most for n.v below roughness^2.
    """
    nodes = np.linspace(0, 1, size)
    # Few at once: what is in the processor's cache is read many times.
    parts = np.array_split(nodes**2, -(-size // 8))
    rows = [np.concatenate([np.stack(dfg(part, roughness), -1) for part in parts]) for roughness in nodes]
    table = np.stack(rows).astype(np.float32)
    table.setflags(write=False)
    return table
