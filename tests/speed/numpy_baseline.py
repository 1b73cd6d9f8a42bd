"""The encodings in NumPy, on whole arrays of shape (count, 3), as written in an afternoon.

Throughput is compared with this baseline, which is also a second, independent implementation for the tests: no
encoding here is shared with the catalogue. Any float dtype; codes are signed.
"""

from __future__ import annotations

import numpy as np

from normalbench.bench.ground.angles import angles_deg


def quantise_unorm(code: np.ndarray, levels: int = 255) -> np.ndarray:
    """Return codes in [-1, 1] through UNORM and back."""
    return np.round(np.clip(code * 0.5 + 0.5, 0, 1) * levels) / levels * 2 - 1


def xyz(n, view, store):
    return store(n)


def xyz_renormalised(n, view, store):
    d = store(n)
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def xy(n, view, store):
    e = store(n[:, :2])
    z = np.sqrt(np.maximum(1 - np.sum(e * e, axis=1, keepdims=True), 0))
    return np.concatenate([e, z], axis=1)


def xy_sign(n, view, store):
    return xy(n, view, store) * np.where(n[:, 2:] < 0, [1, 1, -1], 1).astype(n.dtype)


def spherical(n, view, store):
    e = store(np.stack([np.arctan2(n[:, 1], n[:, 0]) / np.pi, n[:, 2]], axis=1))
    a, z = e[:, 0] * np.pi, e[:, 1]
    r = np.sqrt(np.maximum(1 - z * z, 0))
    return np.stack([np.cos(a) * r, np.sin(a) * r, z], axis=1)


AXIS = np.linspace(-1, 1, 256)
ANGLE_TABLE = np.arctan2(AXIS[:, None], AXIS[None, :]) / np.pi
XY_TABLE = np.stack([np.cos(np.pi * AXIS), np.sin(np.pi * AXIS)], -1) * np.sqrt(1 - AXIS**2)[:, None, None]


def _texel(p):
    return np.floor(np.clip(p * 0.5 + 0.5, 0, 1) * 255 + 0.5).astype(np.int32)


def spherical_lut(n, view, store):
    i = _texel(n[:, :2])
    e = store(np.stack([ANGLE_TABLE.astype(n.dtype)[i[:, 1], i[:, 0]], n[:, 2]], axis=1))
    j = _texel(e)
    return np.concatenate([XY_TABLE.astype(n.dtype)[j[:, 1], j[:, 0]], e[:, 1:]], axis=1)


def spheremap(n, view, store):
    with np.errstate(divide="ignore", invalid="ignore"):
        e = store(n[:, :2] / np.sqrt(n[:, 2:] * 8 + 8) * 2) * 2
    f = np.minimum(np.sum(e * e, axis=1, keepdims=True), 4)
    return np.concatenate([e * np.sqrt(1 - f / 4), 1 - f / 2], axis=1)


def spheremap_classic(n, view, store):
    with np.errstate(divide="ignore", invalid="ignore"):
        e = store(n[:, :2] / np.sqrt(np.sum(n[:, :2] ** 2, axis=1, keepdims=True) + (n[:, 2:] + 1) ** 2))
    f = np.maximum((2 - np.sum(e * e, axis=1, keepdims=True)) / 4, 0.25)
    return np.concatenate([2 * e * np.sqrt(4 * f - 1), 8 * f - 3], axis=1)


def cryengine3(n, view, store):
    flat = n[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    e = store(along * np.sqrt(np.maximum(0.5 - 0.5 * n[:, 2:], 0)))
    z = np.maximum(1 - np.sum(e * e, axis=1, keepdims=True), 0)
    return np.concatenate([2 * e * np.sqrt(z), 2 * z - 1], axis=1)


def stereographic(n, view, store):
    with np.errstate(divide="ignore", invalid="ignore"):
        e = store(n[:, :2] / (n[:, 2:] + 1) / 1.7777) * 1.7777
    g = 2 / (1 + np.sum(e * e, axis=1, keepdims=True))
    return np.concatenate([g * e, g - 1], axis=1)


def per_pixel_view(n, view, store):
    z = -view / np.linalg.norm(view, axis=1, keepdims=True)
    x = np.stack([z[:, 2], np.zeros_like(z[:, 0]), -z[:, 0]], axis=1)
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(z, x)
    e = store(np.stack([np.sum(x * n, axis=1), np.sum(y * n, axis=1)], axis=1))
    height = np.sqrt(np.maximum(1 - np.sum(e * e, axis=1, keepdims=True), 0))
    return x * e[:, :1] + y * e[:, 1:] + z * height


def octahedral(n, view, store):
    p = n[:, :2] / np.sum(np.abs(n), axis=1, keepdims=True)
    folded = (1 - np.abs(p[:, ::-1])) * np.where(p >= 0, 1, -1).astype(n.dtype)
    e = store(np.where(n[:, 2:] < 0, folded, p))
    z = 1 - np.sum(np.abs(e), axis=1, keepdims=True)
    e = e - np.where(e >= 0, 1, -1).astype(n.dtype) * np.maximum(-z, 0)
    d = np.concatenate([e, z], axis=1)
    return d / np.linalg.norm(d, axis=1, keepdims=True)


BASELINES = {
    f.__name__: f
    for f in (
        xyz,
        xyz_renormalised,
        xy,
        xy_sign,
        spherical,
        spherical_lut,
        spheremap,
        spheremap_classic,
        cryengine3,
        stereographic,
        per_pixel_view,
        octahedral,
    )
}


def whole_row(n: np.ndarray, d: np.ndarray) -> tuple[float, ...]:
    """Return MSE, the article's 8-bit MSE, and the mean, RMS, 99th percentile and largest angle in degrees."""
    difference = np.abs(n - d)
    angle = angles_deg(n, d)
    return (
        float(np.mean(difference**2)),
        float(np.mean((np.round(np.minimum(difference, 1) * 255) / 255) ** 2)),
        float(angle.mean()),
        float(np.sqrt(np.mean(angle**2))),
        float(np.percentile(angle, 99)),
        float(angle.max()),
    )
