"""The error of a rendered image against a reference, as displayed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float


def squared_error(image: Float[np.ndarray, "*shape 3"], reference: Float[np.ndarray, "*shape 3"]) -> tuple[float, int]:
    """Return the mean squared error between two displayed images, or parts of them, over all channels, in [0, 1].

    Returns:
        the error, and the number of pixels that are not finite, each of which counts as 1 in every channel.
    """
    finite = np.isfinite(image)
    # An image seldom has such a pixel, and looking at each one's three channels takes NumPy long.
    if finite.all():
        return float(np.mean((image - reference) ** 2)), 0
    broken = ~finite.all(axis=-1, keepdims=True)
    difference = np.where(broken, 1.0, np.nan_to_num(image) - reference)
    return float(np.mean(difference**2)), int(broken.sum())
