"""The figures of a row: the error of mixed normals, and the share of garbage."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..table import Row
from .means import AVERAGES, BY_NORMALS, MEANS, right_of
from .patches import Mixes
from .reference import angles_between, toksvig_power
from .table import GARBAGE_DEG, MOST_ALONE_DEG


class Figures:
    """The results of mixes, over those that an encoding can represent.

    Args:
        mixes: the mixes.
        domain: domain of the encoding.
        power: specular power that Toksvig's formula starts from.
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
        """Return the figures of an operation; only the reason, as `skipped`, if no mix can be represented."""
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
        """Return the errors in percent of the specular power that Toksvig's formula gives."""
        texels = np.nan_to_num(self._texels.astype(np.float64))
        decoded = MEANS[operation](texels, self._mixes)[held]
        exact, mixed_power, after = (toksvig_power(_lengths(v), self._power) for v in (mean, mixed, decoded))
        return {
            "power_error_percent": 100 * float(np.mean(np.abs(mixed_power / exact - 1))),
            "power_decoded_percent": 100 * float(np.mean(np.abs(after / exact - 1))),
        }


def excused(operation: str, alone_deg: float) -> float:
    """Return the part of the largest error of the texels alone that excuses a result: all of it if each texel is
    decoded first, which adds no error; otherwise at most that of a good encoding."""
    return alone_deg if operation in BY_NORMALS else min(alone_deg, MOST_ALONE_DEG)


def _worst_columns(texels: np.ndarray, right: np.ndarray, mixed: np.ndarray) -> Row:
    """Return the two texels, of (count, 3), that are farthest apart, the right normal and the result, as text."""
    first, other = np.unravel_index(np.argmin(texels @ texels.T), (len(texels), len(texels)))
    named = {"worst_first": texels[min(first, other)], "worst_second": texels[max(first, other)]}
    named |= {"worst_right": right, "worst_result": mixed}
    return {name: f"({', '.join(f'{c:.4f}' for c in n)})" for name, n in named.items()}


def _lengths(v: np.ndarray) -> np.ndarray:
    return np.nan_to_num(np.linalg.norm(v.astype(np.float64), axis=-1))


def outside(name: str, domain: str) -> str:
    """Return the reason, in words, why a set has nothing to mix for an encoding: every patch leaves the domain."""
    return f"no patch of {name} is entirely in the domain of the encoding ({domain})"


def error_of_percent(which: np.ndarray) -> float:
    """Return the standard error of a share, in percent, by the rule of succession: not 0 even if the count is 0.

    For k of n it is the standard error of a share of (k + 1) / (n + 2), whose uncertainty is a beta distribution's.
    """
    count, share = which.size, (np.count_nonzero(which) + 1) / (which.size + 2)
    return 100.0 * float(np.sqrt(share * (1 - share) / (count + 3)))


def percent(which: np.ndarray) -> float:
    """Return the percentage of true values, 0 to 100."""
    return 100.0 * float(np.mean(which))
