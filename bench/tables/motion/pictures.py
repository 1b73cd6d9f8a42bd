"""Animations of the highlights that move the most: writing them into a folder, and finding them there again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ....gbuffer.scenes.built_in.gloss import POWERS
from ....reports.charts import motion as chart
from ....reports.page.pixels import Film
from ...ground.output.writing import files_of, whole_file
from ..charts import having
from ..table import Row
from .measure import Filmed

# Pixels around a sphere.
MARGIN = 3


def _file_stem(row: Row) -> str:
    words = ("encoding", "storage", "rounding", "space", "axis")
    return "-".join([*(str(row[name]) for name in words), f"{row['turn_deg']:g}"])


def write(folder: Path, row: Row, filmed: Filmed, exact: Filmed) -> None:
    """Write an animation of the sphere whose highlights move the most: decoded normals, exact normals and their
    difference, side by side. Nothing is written if there is no such sphere."""
    if exact.spheres is None or not np.any(where := exact.spheres == filmed.worst) or not filmed.worst:
        return
    window = _window(where)
    title = f"{row['encoding']} {row['storage']}, {row['space']} space, power {POWERS[filmed.worst - 1]:g}"
    frames = [chart.beside(frame[window], exact.lit[0][window], title) for frame in filmed.lit]
    with whole_file(folder / f"{_file_stem(row)}.png") as partial:
        chart.write_animation(partial, frames)


def _window(where: np.ndarray) -> tuple[slice, slice]:
    """Return the slices of rows and columns that enclose the pixels in a mask, (height, width), with a margin."""
    spans = [np.flatnonzero(where.any(axis=axis)) for axis in (1, 0)]
    y, x = (slice(max(int(span[0]) - MARGIN, 0), int(span[-1]) + MARGIN + 1) for span in spans)
    return y, x


def films(folder: Path, rows: Sequence[Row]) -> Iterator[Film]:
    """Yield the animation for the row whose highlights move the most, if the folder contains it. The file name is
    looked up in the folder, so that it cannot lead out of it."""
    there = files_of(folder)
    usable = sorted(having(rows, "highlight_px", "turn_deg"), key=lambda row: -row["highlight_px"])
    for row in usable[:1]:
        if path := there.get(f"{_file_stem(row)}.png"):
            code = f"{row['encoding']} {row['storage']} in {row['space']} space"
            caption = f"The highlight that moves the most: {code}, at {row['turn_deg']:g} degrees of {row['axis']} "
            caption += f"per frame. Decoded normals, exact normals, and their difference times {chart.GAIN:g}."
            yield Film(caption, path)
