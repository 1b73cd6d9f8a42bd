"""The angle between vectors in NumPy, which needs neither unit length nor care near 0 and 180 degrees."""

from __future__ import annotations

import numpy as np


def angles_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Degrees between rows, in float64: atan2(|a x (b - a)|, a . b). Vectors of length 0 and NaN are the caller's.

    Args:
        a, b: of shape (..., 3).
    """
    a, b = a.astype(np.float64), b.astype(np.float64)
    across = np.linalg.norm(np.cross(a, b - a), axis=-1)
    return np.degrees(np.arctan2(across, np.sum(a * b, axis=-1)))
