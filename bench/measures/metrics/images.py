"""How far two rendered images are apart, as displayed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...ground.output.errors import MissingError

if TYPE_CHECKING:
    from jaxtyping import Float


def squared_error(image: Float[np.ndarray, "*shape 3"], reference: Float[np.ndarray, "*shape 3"]) -> tuple[float, int]:
    """Mean squared error over every pixel and channel of two displayed images, or of some of their pixels, in [0, 1].

    Returns:
        the error, and how many pixels are no number; each of those counts as 1 in every channel.
    """
    finite = np.isfinite(image)
    # An image seldom has such a pixel, and looking at each one's three channels takes NumPy long.
    if finite.all():
        return float(np.mean((image - reference) ** 2)), 0
    broken = ~finite.all(axis=-1, keepdims=True)
    difference = np.where(broken, 1.0, np.nan_to_num(image) - reference)
    return float(np.mean(difference**2)), int(broken.sum())


def require_flip(what: str = "--flip") -> None:
    """Raises MissingError where FLIP cannot be measured, which `what` needs."""
    try:
        import flip_evaluator  # noqa: F401 # asked for, not used
    except ImportError as error:
        raise MissingError(f"{what} needs flip-evaluator ({error}); pip install flip-evaluator") from error


def flip(
    image: Float[np.ndarray, "height width 3"], reference: Float[np.ndarray, "height width 3"]
) -> Float[np.ndarray, "height width"]:
    """NVIDIA's FLIP (Andersson et al. 2020) of two displayed images at its usual 67 pixels a degree: 0 to 1 for each
    pixel."""
    from flip_evaluator import evaluate

    # It passes over a pixel that is not a number; as black it differs.
    exact, measured = (np.nan_to_num(i).astype(np.float32) for i in (reference, image))
    return evaluate(exact, measured, "LDR", applyMagma=False)[0][..., 0]
