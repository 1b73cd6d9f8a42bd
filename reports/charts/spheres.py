"""Maps of errors over the sphere, for a page and for files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice, zip_longest
from typing import Any

import numpy as np

from ..page.embedded import small_uri
from ..page.found import SphereMap
from . import sphere_chart
from .drawings import Drawing
from .looks import as_text

# How finely a rim's cells are parted.
FINE = 8
# A page has at most so many maps: each takes 11 kB and two pictures.
MOST = 64
# Of a colour scale.
FEWEST_TICKS = 3


@dataclass(frozen=True)
class Globe:
    """Images of a codec's errors over the sphere, with the codec's name and its errors in words."""

    label: str
    mean: str
    largest: str
    figures: str


@dataclass(frozen=True)
class Globes:
    """The images of all codecs with the same number of bits, on a common colour scale."""

    bits: int
    globes: Sequence[Globe]
    low: float
    high: float
    ticks: Sequence[tuple[float, str]]


def _groups(maps: Sequence[SphereMap]) -> dict[int, list[SphereMap]]:
    """Return the maps grouped by the number of bits, beginning with the number that has the most codecs."""
    groups: dict[int, list[SphereMap]] = {}
    for sphere_map in maps:
        groups.setdefault(sphere_map.bits, []).append(sphere_map)
    return dict(sorted(groups.items(), key=lambda item: (-len(item[1]), item[0])))


def shown(maps: Sequence[SphereMap], most: int = MOST) -> list[SphereMap]:
    """Return at most `most` maps for a page, in the given order. The most accurate codec for each number of bits is
    chosen first, then the second most accurate, and so on."""
    ranked = [sorted(group, key=lambda sphere: float(np.nanmean(sphere.mean_deg))) for group in _groups(maps).values()]
    turns = (sphere_map for turn in zip_longest(*ranked) for sphere_map in turn if sphere_map is not None)
    kept = {sphere_map.key.label for sphere_map in islice(turns, most)}
    return [sphere_map for sphere_map in maps if sphere_map.key.label in kept]


def globes(maps: Sequence[SphereMap]) -> list[Globes]:
    """Return the maps as images for a page, grouped by number of bits, with one colour scale per group."""
    return [_globes(bits, group) for bits, group in _groups(maps).items()]


def _globes(bits: int, maps: Sequence[SphereMap]) -> Globes:
    limits = sphere_chart.sphere_range({f"{m.key.label} {which}": a for m in maps for which, a in _named_planes(m)})
    drawn_globes = []
    for sphere_map in maps:
        mean, largest = (small_uri(_disc_pixels(plane, limits)) for _, plane in _named_planes(sphere_map))
        front, back = (f"{_mean(h):.3g}" if np.isfinite(h).any() else "" for h in sphere_map.mean_deg)
        figures = f"mean {front} degrees facing the viewer" + (f", {back} away" if back else "")
        drawn_globes.append(
            Globe(sphere_map.key.label, mean, largest, f"{figures}; largest {np.nanmax(sphere_map.max_deg):.3g}")
        )
    low, high = limits
    values: list[float] = []
    for steps in ((1, 2, 5), range(1, 10)):
        if len(values) < FEWEST_TICKS:
            values = [m * 10.0**e for e in range(-7, 4) for m in steps if low <= m * 10.0**e <= high]
    ticks = [(100 * math.log(v / low) / math.log(high / low), f"{v:g}") for v in values]
    return Globes(bits, drawn_globes, low, high, ticks)


def _mean(half: np.ndarray) -> float:
    """Return the mean over a disc's cells, each weighted by the part of it inside the disc."""
    side = (np.arange(len(half) * FINE) + 0.5) / (len(half) * FINE) * 2 - 1
    inside = (side[:, None] ** 2 + side**2 <= 1).reshape(len(half), FINE, len(half), FINE).sum(axis=(1, 3))
    held = np.isfinite(half)
    return float(np.average(half[held], weights=np.maximum(inside[held], 1)))


def _named_planes(sphere_map: SphereMap) -> list[tuple[str, np.ndarray]]:
    return [("mean", sphere_map.mean_deg), ("largest", sphere_map.max_deg)]


def _disc_pixels(plane: np.ndarray, limits: tuple[float, float]) -> np.ndarray:
    return sphere_chart.coloured(np.concatenate([plane[0], plane[1]], axis=1), limits)


def colour_strip() -> str:
    """Return the colour scale, from the smallest to the largest value, as an image in a data URI."""
    steps = np.exp(np.linspace(0, 1, 256))[None]
    return small_uri(sphere_chart.coloured(steps, (1.0, math.e)))


def drawings(maps: Sequence[SphereMap]) -> list[Drawing]:
    """Return the maps as charts for files, one chart for each number of bits."""
    description = "Mean angular error in degrees in each direction."
    return [
        Drawing(
            f"sphere-{bits}-bits", f"Errors over the sphere, {bits} bits", description, partial(_drawn_figure, group)
        )
        for bits, group in _groups(maps).items()
    ]


def _drawn_figure(maps: Sequence[SphereMap]) -> Any:
    return sphere_chart.sphere_chart({as_text(sphere_map.key.label): sphere_map.mean_deg for sphere_map in maps})
