"""Mixing of decoded normals in NumPy; with exact normals, it gives the correct result of every operation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from ....gbuffer.defines.materials import CONSTANTS
from .model import QUAD
from .patches import Mixes
from .reference import angles_between, unit_rows


def _resolved_texels(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    first = (mixes.counts / mixes.samples)[:, None]
    return texels[0] * first + texels[1] * (1 - first)


def _blended_normals(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    alpha = mixes.alphas[:, None]
    return unit_rows(unit_rows(texels[0]) * (1 - alpha) + unit_rows(texels[1]) * alpha)


def _bilinear_weights(shares: np.ndarray) -> np.ndarray:
    """Return the bilinear weights of a patch's first 2 x 2 texels, of shape (4, patches, 1)."""
    x, y = shares.T
    return np.stack([(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y])[..., None]


def _upsampled_normals(texels: np.ndarray, mixes: Mixes) -> np.ndarray:
    """Return the mean normals, (patches, 3), with the weights that gbuffer/glsl/filter.glsl applies to light:
    bilinear, over texels whose normal is close to the normal of the texel with the largest weight."""
    quad, weights = unit_rows(texels[QUAD, :]), _bilinear_weights(mixes.quarters)
    nearest = np.take_along_axis(quad, weights.argmax(axis=0)[None], axis=0)
    weights = weights * (np.sum(quad * nearest, axis=-1, keepdims=True) > CONSTANTS["FILTER_COSINE"])
    return np.sum(quad * weights, axis=0) / np.sum(weights, axis=0)


Mean = Callable[[np.ndarray, Mixes], np.ndarray]
# By operation, how decoded normals are mixed; what is right is the same of exact normals.
BY_NORMALS: Mapping[str, Mean] = MappingProxyType(
    {"resolve_decoded": _resolved_texels, "blend_decoded": _blended_normals, "upsample": _upsampled_normals}
)
STORED_AGAIN = ("blend_decoded",)
MEANS: Mapping[str, Mean] = MappingProxyType(
    {
        "filter": lambda texels, mixes: np.sum(texels[QUAD, :] * _bilinear_weights(mixes.shares), axis=0),
        "mip_2x2": lambda texels, _: texels[QUAD, :].mean(axis=0),
        "mip_4x4": lambda texels, _: texels.mean(axis=0),
        "resolve": _resolved_texels,
        "resolve_decoded": _resolved_texels,
        "blend": _blended_normals,
        "blend_decoded": _blended_normals,
        "detail": lambda _, mixes: mixes.details,
        "upsample": _upsampled_normals,
    }
)
# By operation, what exact normals would give where that is not what is right: blending follows a straight line.
STRAIGHT: Mapping[str, Mean] = MappingProxyType(
    {"detail": lambda texels, mixes: _blended_normals(np.stack([texels[0], mixes.decals]), mixes)}
)
# Operations whose mean's length says how much normals vary; a blend's does not.
AVERAGES = ("filter", "mip_2x2", "mip_4x4", "resolve", "resolve_decoded")
# By operation, the texels that it mixes; all where none are named.
PAIR = (0, 1)
USED: Mapping[str, Any] = MappingProxyType(
    {
        **dict.fromkeys(("filter", "mip_2x2", "upsample"), QUAD),
        **dict.fromkeys(("resolve", "resolve_decoded", "blend", "blend_decoded"), PAIR),
    }
)


@dataclass(frozen=True, eq=False)
class Right:
    """The correct result of an operation, whatever the encoding.

    Attributes:
        mean: mix of exact normals, not renormalised, (patches, 3).
        normals: `mean` renormalised to length 1.
        used: exact normals that are mixed, (texels, patches, 3).
        reach_deg: largest angle between the correct normal and a mixed normal, (patches,).
        geometry_deg: error of the operation on exact normals, (patches,).
    """

    mean: np.ndarray
    normals: np.ndarray
    used: np.ndarray
    reach_deg: np.ndarray
    geometry_deg: np.ndarray


@lru_cache(maxsize=128)
def right_of(mixes: Mixes, operation: str) -> Right:
    """Return the correct result of an operation on mixes. Cached, because all codecs share it."""
    texels = mixes.patches.normals
    mean = MEANS[operation](texels, mixes)
    normals, straight = unit_rows(mean), STRAIGHT.get(operation, MEANS[operation])(texels, mixes)
    used = np.stack([texels[0], mixes.decals]) if operation == "detail" else texels[USED.get(operation, slice(None)), :]
    reach = angles_between(used, np.broadcast_to(normals, used.shape)).max(axis=0)
    return Right(mean, normals, used, reach, angles_between(straight, normals))
