"""The angle between vectors in NumPy: accurate near 0 and 180 degrees, for vectors of any length above 0."""

from __future__ import annotations

import numpy as np


def angles_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles between vectors in degrees, float64 of shape (...): atan2(|a x (b - a)|, a . b). The caller
    has to handle vectors of length 0 and NaN.

    Args:
        a, b: of shape (..., 3).
    """
    # By columns: to add up each row of three NumPy takes longer.
    (ax, ay, az), (bx, by, bz) = (np.moveaxis(v.astype(np.float64), -1, 0) for v in (a, b))
    dx, dy, dz = bx - ax, by - ay, bz - az
    x, y, z = ay * dz - az * dy, az * dx - ax * dz, ax * dy - ay * dx
    return np.degrees(np.arctan2(np.sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz))
