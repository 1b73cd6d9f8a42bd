"""The error that encodings cause in the displayed image, over pixels sampled from each surface class of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....gbuffer.gl.device import Device
from ....gbuffer.sampled import SampledScene
from ...subjects.normals.domains import in_domain
from .whole import AXIS_ALIGNED, UP_TO, Trip, Turn, WholeImage

if TYPE_CHECKING:
    from jaxtyping import Float

# Pixels of every class, and those that are shared out by what classes add to the frame's error.
OF_EACH, SHARED = 512, 2048
# Sets of normals that are lit at once.
ROWS = 16
# Pixels are drawn by how much they change where normals are tilted at random by this angle, half of them evenly.
TILT_DEG, TILTS = 0.5, 4


@dataclass(frozen=True)
class Sample:
    """Sampled pixels of one class.

    Attributes:
        name: the class.
        columns: the range of the class in the image's samples.
        share: the share of this class in the frame's pixels that show a surface.
        weights: the weight of each pixel, such that the mean of weighted figures is the mean of the class; float64 of
            shape (count,).
    """

    name: str
    columns: slice
    share: float
    weights: np.ndarray


class SampledImage:
    """Sampled pixels of an image.

    Args:
        whole: the image.
        seed: the seed for the choice of pixels.
        device: the device that lights the pixels.
        stack: the exit stack that keeps the resources for lighting.

    Attributes:
        classes: the samples of each class in the image.
        normals, positions: in view space, float32 of shape (count, 3).
    """

    def __init__(self, whole: WholeImage, seed: int, device: Device, stack: ExitStack):
        self._whole = whole
        pixels, self.classes = _sampled(whole, _changes(whole, seed), seed)
        rows, columns = pixels.T
        self._surfaces = [texels[rows, columns] for texels in whole.surfaces]
        self.normals, self.positions = self._surfaces[0][:, :3], whole.places[rows, columns]
        height, width = whole.classes.shape
        self._lit = SampledScene(device, stack, whole.scene, (width, height), pixels, self.positions, ROWS)
        self._exact = whole.display.image(self._lit.lit(whole.scene, self._surfaces, self.normals[None])[0])

    def errors(self, trip: Trip, turns: Sequence[Turn]) -> Float[np.ndarray, "turns count"]:
        """Return the squared error of each sampled pixel, as displayed, in each orientation of an encoding: (turns,
        count). The error is averaged over the channels; a channel that is not finite counts as 1."""
        parts = (turns[first : first + ROWS] for first in range(0, len(turns), ROWS))
        return np.concatenate([self._errors(trip, part) for part in parts])

    def _errors(self, trip: Trip, turns: Sequence[Turn]) -> np.ndarray:
        normals = self._whole.decoded(trip, turns, self.normals, self.positions)
        shown = self._whole.display.image(self._lit.lit(self._whole.scene, self._surfaces, normals))
        return np.mean(np.where(np.isfinite(shown), shown - self._exact, 1.0) ** 2, axis=-1)

    def by_class(self, trip: Trip, turns: Sequence[Turn], domain: str) -> dict[str, Float[np.ndarray, " turns"]]:
        """Return the mean squared error of each class in each orientation, (turns,), by class, and under "" the mean
        squared error of the frame, with classes weighted by their shares; {} if no sampled pixel counts.

        Args:
            domain: pixels with normals outside it do not count; a class without other pixels is left out.
        """
        return self._means(self.errors(trip, turns), in_domain(self.normals, self.positions, domain))

    def _means(self, errors: np.ndarray, held: np.ndarray) -> dict[str, np.ndarray]:
        means, total, whole = {}, np.zeros(len(errors)), 0.0
        for sample in self.classes:
            weights = sample.weights * held[sample.columns]
            if inside := float(weights.mean()):
                means[sample.name] = errors[:, sample.columns] @ weights / weights.sum()
                total, whole = total + sample.share * inside * means[sample.name], whole + sample.share * inside
        return {"": total / whole, **means} if whole else {}

    def pixel_error(self, errors: Float[np.ndarray, " count"]) -> float:
        """Return the standard error that the choice of pixels causes in the frame's mean squared error.

        Args:
            errors: the squared errors of the sampled pixels in one orientation."""
        parts = (sample.share * sample.weights * errors[sample.columns] for sample in self.classes)
        return float(np.sqrt(sum(part.var() / part.size for part in parts)))


def _changes(whole: WholeImage, seed: int) -> np.ndarray:
    """Return the mean squared change of each displayed pixel, (height, width), if normals are tilted slightly at
    random."""
    random = np.random.default_rng([seed, 3])

    def tilted(normals: np.ndarray, _: np.ndarray) -> np.ndarray:
        n = normals + np.radians(TILT_DEG) * random.standard_normal(normals.shape)
        return (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)

    total = np.zeros(whole.classes.shape)
    for _ in range(TILTS):
        total += np.mean((whole.shown(tilted, None) - whole.exact) ** 2, axis=-1)
    return np.where(np.isfinite(total), total / TILTS, 0.0)


def _sampled(whole: WholeImage, changes: np.ndarray, seed: int) -> tuple[np.ndarray, list[Sample]]:
    """Return the rows and columns of sampled pixels, (count, 2), and a `Sample` for each class that the image shows.

    Pixels are grouped by class, in an order that keeps spatial neighbours together. Half of a pixel's probability is
    the same for all pixels, and half is proportional to its change, so that no weight exceeds 2.
    """
    random, is_seen = np.random.default_rng([seed, 2]), whole.classes >= 0
    total, change_of_all = max(int(is_seen.sum()), 1), float(np.sum(changes[is_seen])) or 1.0
    chosen, samples, begin = [], [], 0
    for number, name in enumerate((AXIS_ALIGNED, *UP_TO)):
        there = np.argwhere(whole.classes == number)
        if not len(there):
            continue
        change = changes[there[:, 0], there[:, 1]]
        # The least error of a sum: as many of each part as it adds (Neyman 1934).
        count = OF_EACH + round(SHARED * float(change.sum() / change_of_all))
        # p = (1 + e / mean e) / 2 n, and a weight of 1 / n p
        relative: np.ndarray = change / change.mean() if change.any() else np.ones(len(there))
        chance = (1 + relative) / (2 * len(there))
        picked = random.choice(len(there), count, p=chance / chance.sum())
        picked = picked[_along_a_curve(whole.places[there[picked, 0], there[picked, 1]])]
        chosen.append(there[picked])
        columns = slice(begin, begin + len(picked))
        samples.append(Sample(name, columns, len(there) / total, 1 / (len(there) * chance[picked])))
        begin = columns.stop
    return np.concatenate(chosen or [np.zeros((0, 2), int)]), samples


def _along_a_curve(places: np.ndarray, bits: int = 10) -> np.ndarray:
    """Return the indices that put points, (count, 3), in Morton order, so that a lamp reaches few runs of them."""
    spread = np.ptp(places, axis=0).max() or 1.0
    cells = ((places - places.min(axis=0)) / spread * (2**bits - 1)).astype(np.int64)
    curve = np.zeros(len(places), np.int64)
    for bit in range(bits):
        for axis in range(3):
            curve |= (cells[:, axis] >> bit & 1) << (3 * bit + axis)
    return np.argsort(curve)
