"""How a time grows with a size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float | None:
    """The e of time = c size^e, by least squares in logarithms; None of fewer than two sizes."""
    if len(set(sizes)) < 2:
        return None
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def growth_lines(name: str, size: str, sizes: Sequence[int], times: Sequence[float], unit: str = "") -> Iterator[str]:
    """A line that says how the time grows, of two sizes or more that are a factor of 2 apart: times of nearer ones
    differ as much by themselves.

    Args:
        name: what was timed.
        size: what the sizes are called.
        unit: what they count, with a blank in front.
    """
    if (found := exponent(sizes, times)) is not None and max(sizes) >= 2 * min(sizes):
        yield f"{name}: time grows as {size}^{found:.2f} from {min(sizes)} to {max(sizes)}{unit}"
