"""Maps of angles over the sphere, which are drawn as images instead of marks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .plots import drawn_off_screen

# A histogram's least angle: nothing of 32 bits and less is finer, and what is 0 has no logarithm.
LEAST_DEG = 1e-4
# Perceptually uniform, and the same order to those who do not see all colours.
SPHERE_COLOURS = "viridis"


def _figure(size: tuple[float, float], **layout: Any) -> tuple[Any, Any]:
    """Return a new matplotlib figure and its axes."""
    return drawn_off_screen().subplots(figsize=size, layout="constrained", **layout)


Maps = Mapping[str, np.ndarray]


def sphere_range(maps: Maps) -> tuple[float, float]:
    """Return the smallest and the largest angle, in degrees, of a common logarithmic scale for maps; a zero error is
    below the scale."""
    angles = np.concatenate([plane[np.isfinite(plane)] for plane in maps.values()])
    largest = float(angles.max(initial=LEAST_DEG))
    above = angles[angles > largest * 1e-4]
    return (float(np.percentile(above, 1)) if above.size else largest / 10), largest * 1.0001


def coloured(plane: np.ndarray, limits: tuple[float, float]) -> np.ndarray:
    """Return colours for angles on a logarithmic scale, uint8 of shape (..., 4); transparent where there is no angle.

    Args:
        plane: angles in degrees, NaN for none.
        limits: smallest and largest angle of the scale."""
    import matplotlib

    low, high = np.log(limits)
    with np.errstate(divide="ignore"):
        share = (np.log(np.nan_to_num(plane, nan=1.0)) - low) / (high - low)
    colours = matplotlib.colormaps[SPHERE_COLOURS](np.clip(share, 0, 1))
    colours[..., 3] = np.isfinite(plane)
    return np.round(colours * 255).astype(np.uint8)


def _mark(axis: Any, n: np.ndarray, cells: int) -> None:
    """Draw a red ring around each direction, on the disc of its half.

    Args:
        axis: the matplotlib axes with both discs.
        n: directions, (count, 3).
        cells: width of a disc in cells."""
    is_behind = n[:, 2] < 0
    # Lambert (1772): a distance r from the middle has |z| = 1 - r^2, and the rim is at 1.
    across = n[:, :2] / np.sqrt(1 + np.abs(n[:, 2:]))
    x, y = (across[:, 0] + 1) / 2 + is_behind, (1 - across[:, 1]) / 2
    axis.scatter(x * cells - 0.5, y * cells - 0.5, s=9, facecolors="none", edgecolors="red", linewidths=0.6)


def _marked_title(name: str, marks: Maps | None) -> str:
    count = len((marks or {}).get(name, ()))
    return f"{name}\n{count} directions decode incorrectly (red)" if count else name


def sphere_chart(maps: Maps, marks: Maps | None = None, halves: tuple[str, str] = ("", "")) -> Any:
    """Return a matplotlib figure of angles over the sphere, with two discs for each codec and a common colour scale.

    Args:
        maps: degrees of shape (2, cells, cells) by codec: the half that faces the viewer and the other half, in
            Lambert's azimuthal equal-area projection; NaN where there is no angle.
        marks: directions to mark, (count, 3), by codec.
        halves: captions below the two discs.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import LogLocator

    limits, across = sphere_range(maps), min(3, len(maps))
    down = -(-len(maps) // across)
    size = (3.2 * across + 0.9, 1.9 * down + 0.3)
    figure, axes = _figure(size, nrows=down, ncols=across, squeeze=False)
    for axis, (name, discs) in zip(axes.flat, maps.items(), strict=False):
        axis.imshow(coloured(np.concatenate(list(discs), axis=1), limits), interpolation="none")
        _mark(axis, (marks or {}).get(name, np.empty((0, 3))), discs.shape[-1])
        for side, caption in enumerate(halves):
            axis.text((side + 0.5) * discs.shape[-1], discs.shape[-1], caption, size=6, ha="center", va="top")
        axis.set_title(_marked_title(name, marks), size=8)
    for axis in axes.flat:
        axis.set_axis_off()
    scale = ScalarMappable(LogNorm(*limits), SPHERE_COLOURS)
    # As plain text, which matplotlib lays out much faster than powers of ten.
    bar = figure.colorbar(
        scale, ax=axes, label="degrees", shrink=0.8, aspect=30, ticks=LogLocator(subs=(1, 2, 5)), format="{x:g}"
    )
    bar.minorticks_off()
    return figure
