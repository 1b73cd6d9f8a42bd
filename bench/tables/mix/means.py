"""Normals that are mixed after they are decoded; and, of exact normals, what every operation should give. NumPy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from ....gbuffer.defines.materials import CONSTANTS
from .model import QUAD
from .patches import Mixes
from .reference import unit_rows


def _resolved(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    first = (mixes.counts / mixes.samples)[:, None]
    return texels[0] * first + texels[1] * (1 - first)


def _blended(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    alpha = mixes.alphas[:, None]
    return unit_rows(unit_rows(texels[0]) * (1 - alpha) + unit_rows(texels[1]) * alpha)


def _bilinear(shares: np.ndarray) -> np.ndarray:
    """The weights of the first four texels, (4, patches, 1)."""
    x, y = shares.T
    return np.stack([(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y])[..., None]


def _upsampled(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    """As gbuffer/glsl/filter.glsl weighs light: bilinear, by those whose normal is close to the nearest one's."""
    quad, weights = unit_rows(texels[QUAD, :]), _bilinear(mixes.quarters)
    nearest = np.take_along_axis(quad, weights.argmax(axis=0)[None], axis=0)
    weights = weights * (np.sum(quad * nearest, axis=-1, keepdims=True) > CONSTANTS["FILTER_COSINE"])
    return np.sum(quad * weights, axis=0) / np.sum(weights, axis=0)


Mean = Callable[[np.ndarray, Mixes], np.ndarray]
# By operation, how decoded normals are mixed; what is right is the same of exact normals.
BY_NORMALS: Mapping[str, Mean] = MappingProxyType(
    {"resolve_decoded": _resolved, "blend_decoded": _blended, "upsample": _upsampled}
)
STORED_AGAIN = ("blend_decoded",)
MEANS: Mapping[str, Mean] = MappingProxyType(
    {
        "filter": lambda texels, mixes: np.sum(texels[QUAD, :] * _bilinear(mixes.shares), axis=0),
        "mip_2x2": lambda texels, _: texels[QUAD, :].mean(axis=0),
        "mip_4x4": lambda texels, _: texels.mean(axis=0),
        "resolve": _resolved,
        "resolve_decoded": _resolved,
        "blend": _blended,
        "blend_decoded": _blended,
        "detail": lambda _, mixes: mixes.details,
        "upsample": _upsampled,
    }
)
# By operation, what exact normals would give where that is not what is right: blending follows a straight line.
STRAIGHT: Mapping[str, Mean] = MappingProxyType(
    {"detail": lambda texels, mixes: _blended(np.stack([texels[0], mixes.decals]), mixes)}
)
# Operations whose mean's length says how much normals vary; a blend's does not.
AVERAGES = ("filter", "mip_2x2", "mip_4x4", "resolve", "resolve_decoded")
