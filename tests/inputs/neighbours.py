"""Values next to given values, where rounding may go either way."""

import numpy as np


def around(values: np.ndarray, ulps: int = 3) -> np.ndarray:
    """Return float32 values and their neighbours, `ulps` to each side."""
    arrays = [values.astype(np.float32)]
    for towards in (np.float32(-np.inf), np.float32(np.inf)):
        step = arrays[0]
        for _ in range(ulps):
            step = np.nextafter(step, towards)
            arrays.append(step)
    return np.concatenate(arrays)
