"""The error of the displayed image that encodings cause, over pixels sampled from each class of a scene's surfaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.display import Display
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Covered, Rendering, rendering
from ....gbuffer.sampled import SampledScene
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

PIPELINE = "deferred"
SIZE = (640, 480)
# Surfaces that lie along the world's axes, and the others by perceptual roughness, each up to its own.
AXIS_ALIGNED = "floors and walls"
MIRROR, GLOSSY, ROUGH = "mirror", "glossy", "rough"
UP_TO = {MIRROR: 0.2, GLOSSY: 0.5, ROUGH: np.inf}
# What is closer to an axis counts as along it: 1 - cos of 0.1 degrees.
ALONG = 1.5e-6
# Pixels of every class, and those that are shared out by what classes add to the frame's error.
OF_EACH, SHARED = 512, 2048
# Sets of normals that are lit at once.
ROWS = 16
# Pixels are drawn by how much they change where normals are tilted at random by this angle, half of them evenly.
TILT_DEG, TILTS = 0.5, 4
# From unit normals in the encoding's axes and view positions, float32 of shape (count, 3), to decoded normals.
Trip = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Sample:
    """Pixels of one class.

    Attributes:
        name: the class.
        columns: which of the image's samples they are.
        share: of the frame's pixels that are of a surface, those of this class.
        weights: of each pixel, so that the mean of weighted figures is that of the class; float64 of shape (count,).
    """

    name: str
    columns: slice
    share: float
    weights: np.ndarray


class SampledImage:
    """Sampled pixels of a scene at one moment, with exact normals and with those of encodings.

    Attributes:
        classes: the samples of each class that is there.
        normals, positions: in view space, float32 of shape (count, 3).
        to_world: view space to the world's axes, (3, 3).
    """

    def __init__(self, scene: Scene, maker: SceneMaker, made: Rendering, seed: int, device: Device, stack: ExitStack):
        made.frame.show(scene)
        surfaces = made.surfaces()
        covered = made.covered(surfaces)
        self.to_world = np.linalg.inv(scene.view.matrix())[:3, :3]
        is_seen = covered.pixels[::-1] & ~_is_behind_glass(made, surfaces)
        self.display: Display = maker.display(made.image())
        changes = _changes(made, surfaces, covered, self.display, seed)
        places = np.zeros((*is_seen.shape, 3), np.float32)
        places[::-1][covered.pixels] = covered.position
        classes = _class_of(surfaces, self.to_world, scene.is_metal_rough)
        pixels, self.classes = _sampled(classes, is_seen, changes, places, seed)
        rows, columns = pixels.T
        self._surfaces = [texels[rows, columns] for texels in surfaces]
        self.normals, self.positions = self._surfaces[0][:, :3], places[rows, columns]
        self._scene = scene
        height, width = is_seen.shape
        self._lit = SampledScene(device, stack, scene, (width, height), pixels, self.positions, ROWS)
        self._exact = self.display.image(self._lit.lit(scene, self._surfaces, self.normals[None])[0])

    def errors(self, jobs: Sequence[tuple[Trip, Float[np.ndarray, "3 3"] | None]]) -> Float[np.ndarray, "jobs count"]:
        """Return the squared error of each displayed pixel, the mean of its channels; 1 where it is no number.

        Args:
            jobs: what encodes and decodes normals, each with the rotation from the world's axes to its own; None for
                view space.
        """
        return np.concatenate([self._errors(jobs[at : at + ROWS]) for at in range(0, len(jobs), ROWS)])

    def _errors(self, jobs: Sequence[tuple[Trip, np.ndarray | None]]) -> np.ndarray:
        normals = np.stack([self._decoded(*job) for job in jobs])
        shown = self.display.image(self._lit.lit(self._scene, self._surfaces, normals))
        apart = np.where(np.isfinite(shown), shown - self._exact, 1.0)
        return np.mean(apart**2, axis=-1)

    def _decoded(self, trip: Trip, turn: np.ndarray | None) -> np.ndarray:
        if turn is None:
            return trip(self.normals, self.positions)
        matrix = turn @ self.to_world
        given = (self.normals.astype(np.float64) @ matrix.T).astype(np.float32)
        return (trip(given, self.positions).astype(np.float64) @ matrix).astype(np.float32)

    def by_class(
        self, errors: Float[np.ndarray, "jobs count"], held: Bool[np.ndarray, " count"]
    ) -> Mapping[str, Float[np.ndarray, " jobs"]]:
        """Return the mean squared error of each class, and as "" that of the frame: classes by their share.

        Args:
            held: pixels that count; a class without any is left out.
        """
        found, total, whole = {}, np.zeros(len(errors)), 0.0
        for sample in self.classes:
            weights = sample.weights * held[sample.columns]
            if inside := float(weights.mean()):
                found[sample.name] = errors[:, sample.columns] @ weights / weights.sum()
                total, whole = total + sample.share * inside * found[sample.name], whole + sample.share * inside
        return {"": total / whole, **found} if whole else {}

    def pixel_error(self, errors: Float[np.ndarray, " count"]) -> float:
        """Return the standard error of the frame's mean squared error that the choice of pixels causes."""
        parts = ((sample, sample.share * sample.weights * errors[sample.columns]) for sample in self.classes)
        return float(np.sqrt(sum(part.var() / part.size for _, part in parts)))


def sampled_images(
    device: Device, stack: ExitStack, maker: SceneMaker, setting: Setting, powers: Sequence[float | None], seed: int
) -> dict[float | None, SampledImage]:
    """Return a scene's sampled pixels at each specular power, open with the stack."""
    scene = maker.make(setting)
    plan = Plan(maker.within(SIZE), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, True, 1.0)
    with rendering(device, PIPELINES[PIPELINE], scene, plan) as made:
        moments = {power: scene if power is None else scene.with_power(power) for power in powers}
        return {power: SampledImage(moment, maker, made, seed, device, stack) for power, moment in moments.items()}


def _is_behind_glass(made: Rendering, surfaces: Sequence[np.ndarray]) -> np.ndarray:
    """Where transparent surfaces change the image, (height, width), row 0 on top; the whole image is left drawn."""
    opaque = made.lit(surfaces, upto="transparent")
    return np.any(made.lit(surfaces) != opaque, axis=-1)


def _class_of(surfaces: Sequence[np.ndarray], to_world: np.ndarray, is_metal_rough: bool) -> np.ndarray:
    """The number of each pixel's class, 0 for AXIS_ALIGNED, (height, width)."""
    power = surfaces[2][..., 3]
    # r = (2 / (s + 2))^(1/4), B. Karis, Specular BRDF Reference, 2013
    roughness = power if is_metal_rough else (2.0 / (power + 2.0)) ** 0.25
    along = np.abs(surfaces[0][..., :3] @ to_world.T).max(axis=-1) > 1 - ALONG
    return np.where(along, 0, 1 + np.searchsorted(list(UP_TO.values()), roughness))


def _changes(
    made: Rendering, surfaces: Sequence[np.ndarray], covered: Covered, display: Display, seed: int
) -> np.ndarray:
    """How much each displayed pixel changes where normals are tilted a little, at random: the mean square, (height,
    width)."""
    random, exact = np.random.default_rng([seed, 3]), display.image(made.lit(surfaces))
    total = np.zeros(exact.shape[:2])
    for _ in range(TILTS):
        tilted = covered.normals + np.radians(TILT_DEG) * random.standard_normal(covered.normals.shape)
        tilted /= np.linalg.norm(tilted, axis=-1, keepdims=True)
        shown = display.image(made.lit(covered.with_normals(surfaces, tilted.astype(np.float32))))
        total += np.mean((shown - exact) ** 2, axis=-1)
    return np.where(np.isfinite(total), total / TILTS, 0.0)


def _sampled(
    classes: np.ndarray, is_seen: np.ndarray, changes: np.ndarray, places: np.ndarray, seed: int
) -> tuple[np.ndarray, list[Sample]]:
    """Pixels of each class, (count, 2), neighbours in space next to each other as far as they go, and their samples.

    Pixels are drawn by what they change, and half of them evenly, so that none has a weight above 2.
    """
    random, total = np.random.default_rng([seed, 2]), max(int(is_seen.sum()), 1)
    whole = changes[is_seen].sum() or 1.0
    chosen, samples, begin = [], [], 0
    for number, name in enumerate((AXIS_ALIGNED, *UP_TO)):
        there = np.argwhere(is_seen & (classes == number))
        if not len(there):
            continue
        change = changes[there[:, 0], there[:, 1]]
        # The least error of a sum: as many of each part as it adds (Neyman 1934).
        count = OF_EACH + round(SHARED * float(change.sum() / whole))
        # p = (1 + e / mean e) / 2 n, and a weight of 1 / n p
        chance = (1 + (change / change.mean() if change.any() else 1.0)) / (2 * len(there))
        picked = random.choice(len(there), count, p=chance / chance.sum())
        picked = picked[_along_a_curve(places[there[picked, 0], there[picked, 1]])]
        chosen.append(there[picked])
        columns = slice(begin, begin + len(picked))
        samples.append(Sample(name, columns, len(there) / total, 1 / (len(there) * chance[picked])))
        begin = columns.stop
    return np.concatenate(chosen or [np.zeros((0, 2), int)]), samples


def _along_a_curve(places: np.ndarray, bits: int = 10) -> np.ndarray:
    """The order of points, (count, 3), along Morton's curve, so that what one lamp reaches is in few runs."""
    spread = np.ptp(places, axis=0).max() or 1.0
    cells = ((places - places.min(axis=0)) / spread * (2**bits - 1)).astype(np.int64)
    return np.argsort(sum((cells[:, axis] >> bit & 1) << (3 * bit + axis) for bit in range(bits) for axis in range(3)))
