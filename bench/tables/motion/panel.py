"""Crawling steps: a slightly curved panel that reflects thin strips while the camera moves around it.

A quantisation step of an encoding stays on the surface, or moves over it, while the reflection moves past. People
notice this sooner than the step itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.environment.catalogue import ENVIRONMENTS
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Keeps, Rendering, rendering
from ....gbuffer.scenes.scene import Scene, View
from ..roughness.objects import shown
from . import turning

PIPELINE = "deferred"
OBJECT, ENVIRONMENT = "panel4", "strips"
# What reflects nearly as a mirror does, as wet floors, cars and screens do.
ROUGHNESS = 0.1
SIZE = (128, 128)
TONE_MAPPING = "aces"
# The camera goes as far to either side of where the panel reflects most, in degrees.
SWING_DEG = 4.0


@dataclass(frozen=True)
class Around:
    """A panel that is ready to render from each position of the camera."""

    scene: Scene
    made: Rendering
    axis: str
    turn: float
    frames: int

    def views(self) -> Iterator[View]:
        """Yield the camera of each frame."""
        angles = turning.angles(self.turn, self.frames, 2 * SWING_DEG)
        for angle in angles - np.max(angles) / 2:
            yield around(self.scene.view, self.axis, float(angle))

    def light(self, view: View, keeps: Keeps | None = None) -> np.ndarray:
        """Return a frame's linear light, (height, width, 3); with exact normals unless `keeps` is given."""
        self.made.draw(replace(self.scene, view=view, previous=view), keeps)
        return self.made.image()

    def covered(self) -> np.ndarray:
        """Return a mask of the pixels that show the panel in the last frame, bool of shape (height, width)."""
        return self.made.gbuffer()[0][..., 2] != 0


@dataclass(frozen=True)
class Exact:
    """Frames with exact normals: the displayed images, float32 of shape (height, width, 3), the masks of the panel,
    and the conversion to displayed values."""

    shown: list[np.ndarray]
    covered: list[np.ndarray]
    display: Display


@contextmanager
def going_around(device: Device, axis: str, turn: float, frames: int) -> Iterator[Around]:
    """Yield the panel, ready to render while a camera moves around it by `turn` degrees per frame, about the camera's
    own up, right or view axis."""
    scene = shown(OBJECT, ENVIRONMENTS[ENVIRONMENT].make()).scene(ROUGHNESS)
    plan = Plan(SIZE, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, False, 1.0, antialiased=False)
    with rendering(device, PIPELINES[PIPELINE], scene, plan) as drawing:
        yield Around(scene, drawing, axis, turn, frames)


def exact(panel: Around) -> Exact:
    """Return the frames with exact normals, all at the exposure measured in the middle frame."""
    light, covered = [], []
    for view in panel.views():
        light.append(panel.light(view))
        covered.append(panel.covered())
    middle = len(light) // 2
    display = Display(measured_exposure(light[middle][covered[middle]]), TONE_MAPPING)
    return Exact([display.image(frame).astype(np.float32) for frame in light], covered, display)


def differences(
    panel: Around, right: Exact, keeps_of: Callable[[View], Keeps]
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the difference between each frame's image and the image of exact normals, and a mask of the panel."""
    for index, view in enumerate(panel.views()):
        image = right.display.image(panel.light(view, keeps_of(view))).astype(np.float32)
        yield image - right.shown[index], right.covered[index]


def around(view: View, axis: str, degrees: float) -> View:
    """Return the camera moved around its target by the rotation that `View.turned` applies in place."""
    turned = view.turned(axis, degrees)
    x, y, z = map(float, np.add(view.target, np.subtract(view.eye, turned.target)))
    return replace(turned, eye=(x, y, z), target=view.target)
