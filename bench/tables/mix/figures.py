"""The figures in a row: the error of mixed normals, and the share of garbage."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..table import Row
from .means import AVERAGES, BY_NORMALS, MEANS, right_of
from .patches import Mixes
from .reference import angles_between, toksvig_power
from .table import GARBAGE_DEG, MOST_ALONE_DEG


class Figures:
    """The results of mixing, over the mixes that an encoding can represent.

    Args:
        mixes: the mixes.
        domain: domain of the encoding.
        power: specular power to which Toksvig's formula is applied.
        texels: decoded texels of the patches, (TEXELS, patches, 3).
        mixed: result of each operation, decoded, not renormalised, (patches, 3).
    """

    def __init__(self, mixes: Mixes, domain: str, power: float, texels: np.ndarray, mixed: Mapping[str, np.ndarray]):
        self._mixes, self._domain, self._power, self._texels, self._mixed = mixes, domain, power, texels, mixed
        self._normals, self._held = mixes.patches.normals, mixes.patches.held_by(domain)
        self._alone = angles_between(texels[:, self._held], self._normals[:, self._held])

    def errors(self, operation: str) -> np.ndarray:
        """Return the error of each mix in degrees, (patches,); -1 if the encoding cannot represent the mix."""
        angles = angles_between(self._mixed[operation], right_of(self._mixes, operation).normals)
        return np.where(self._held_mask(operation), angles, -1.0)

    def _held_mask(self, operation: str) -> np.ndarray:
        return self._held & self._mixes.held_by(operation, self._domain)

    def of(self, operation: str) -> Row:
        """Return the figures for an operation; if no mix can be represented, only the reason in `skipped`."""
        held = self._held_mask(operation)
        if not held.any():
            return {"skipped": outside(self._mixes.patches.name, self._domain)}
        right, mixed = right_of(self._mixes, operation), self._mixed[operation][held]
        errors, alone = angles_between(mixed, right.normals[held]), self._alone
        reach, geometry = right.reach_deg[held], right.geometry_deg[held]
        explained = geometry + 2 * excused(operation, float(alone.max()))
        garbage = errors > explained + np.minimum(GARBAGE_DEG, reach)
        row: Row = {
            "count": int(held.sum()),
            "invalid": int(np.count_nonzero(~np.isfinite(mixed).all(axis=-1))),
            "alone_mean_deg": float(alone.mean()),
            "alone_max_deg": float(alone.max()),
            "angle_mean_deg": float(errors.mean()),
            "angle_p99_deg": float(np.percentile(errors, 99)),
            "angle_max_deg": float(errors.max()),
            "added_max_deg": float(errors.max() - alone.max()),
            "geometry_max_deg": float(geometry.max()),
            "reach_max_deg": float(reach.max()),
            "garbage_percent": percent(garbage),
            "garbage_error_percent": error_of_percent(garbage),
        }
        worst = int(errors.argmax())
        row |= _worst_columns(right.used[:, held][:, worst], right.normals[held][worst], mixed[worst])
        return row | (self._power_columns(operation, held, right.mean[held], mixed) if operation in AVERAGES else {})

    def _power_columns(self, operation: str, held: np.ndarray, mean: np.ndarray, mixed: np.ndarray) -> Row:
        """Return the errors of the specular power from Toksvig's formula, in percent: after mixing codes, and after
        mixing decoded texels."""
        texels = np.nan_to_num(self._texels.astype(np.float64))
        decoded = MEANS[operation](texels, self._mixes)[held]
        exact, mixed_power, after = (toksvig_power(_lengths(v), self._power) for v in (mean, mixed, decoded))
        return {
            "power_error_percent": 100 * float(np.mean(np.abs(mixed_power / exact - 1))),
            "power_decoded_percent": 100 * float(np.mean(np.abs(after / exact - 1))),
        }


def excused(operation: str, alone_deg: float) -> float:
    """Return the part of the unmixed texels' largest error that excuses a result. All of it is excused if the
    operation mixes decoded normals; otherwise at most the error of a good encoding."""
    return alone_deg if operation in BY_NORMALS else min(alone_deg, MOST_ALONE_DEG)


def _worst_columns(texels: np.ndarray, right: np.ndarray, mixed: np.ndarray) -> Row:
    """Return the two texels that are farthest apart among texels of shape (count, 3), the right normal and the
    result, as text columns."""
    first, other = np.unravel_index(np.argmin(texels @ texels.T), (len(texels), len(texels)))
    named = {"worst_first": texels[min(first, other)], "worst_second": texels[max(first, other)]}
    named |= {"worst_right": right, "worst_result": mixed}
    return {name: f"({', '.join(f'{c:.4f}' for c in n)})" for name, n in named.items()}


def _lengths(v: np.ndarray) -> np.ndarray:
    return np.nan_to_num(np.linalg.norm(v.astype(np.float64), axis=-1))


def outside(name: str, domain: str) -> str:
    """Return the reason why an encoding cannot be measured on a set: every patch leaves the encoding's domain."""
    return f"no patch of {name} is entirely in the domain of the encoding ({domain})"


def error_of_percent(which: np.ndarray) -> float:
    """Return the standard error of the share of true values, in percent, by the rule of succession: it is not 0 even
    if no value is true.

    For k of n values, this is the standard error of the share (k + 1) / (n + 2) under a beta distribution.
    """
    count, share = which.size, (np.count_nonzero(which) + 1) / (which.size + 2)
    return 100.0 * float(np.sqrt(share * (1 - share) / (count + 3)))


def percent(which: np.ndarray) -> float:
    """Return the percentage of true values in an array."""
    return 100.0 * float(np.mean(which))
