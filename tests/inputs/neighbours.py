"""Numbers beside numbers: where rounding goes the one way or the other."""

import numpy as np


def around(values: np.ndarray, ulps: int = 3) -> np.ndarray:
    """float32 values and their neighbours, `ulps` to each side."""
    found = [values.astype(np.float32)]
    for towards in (np.float32(-np.inf), np.float32(np.inf)):
        step = found[0]
        for _ in range(ulps):
            step = np.nextafter(step, towards)
            found.append(step)
    return np.concatenate(found)
