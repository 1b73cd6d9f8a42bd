"""Whole frames of a scene, with exact normals and with the decoded normals of encodings; surfaces are drawn once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.display import Display
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import Pipeline
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting
from ...subjects.normals.domains import in_domain, view_angles

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

SIZE = (640, 480)
# Surfaces that lie along the world's axes, and the others by perceptual roughness, each up to its own.
AXIS_ALIGNED = "floors and walls"
MIRROR, GLOSSY, ROUGH = "mirror", "glossy", "rough"
UP_TO = {MIRROR: 0.2, GLOSSY: 0.5, ROUGH: np.inf}
# What is closer to an axis counts as along it: 1 - cos of 0.1 degrees.
ALONG = 1.5e-6
# From unit normals and view positions, float32 of shape (count, 3), to what an encoding decodes.
Trip = Callable[[np.ndarray, np.ndarray], np.ndarray]
# The rotation from the world's axes to the encoding's, (3, 3); None for an encoding in view space.
Turn = np.ndarray | None


class WholeImage:
    """A scene at one moment.

    Attributes:
        scene: the scene at that moment.
        display: the conversion of linear light to the displayed image.
        exact: the displayed image with exact normals, (height, width, 3), row 0 on top.
        surfaces: as `Rendering.surfaces` returns them for layout fp32.
        classes: the number of each pixel's class among AXIS_ALIGNED and the classes of UP_TO, (height, width); -1 if
            no surface is visible, or a surface is visible through another surface.
        places: positions in view space, float32 of shape (height, width, 3).
        to_world: the matrix from view space to the world's axes, (3, 3).
    """

    def __init__(self, scene: Scene, maker: SceneMaker, rendered: Rendering):
        rendered.frame.show(scene)
        self.scene, self._made = scene, rendered
        self.surfaces = rendered.surfaces()
        self._covered = rendered.covered(self.surfaces)
        opaque, linear = rendered.lit(self.surfaces, upto="transparent"), rendered.lit(self.surfaces)
        self.display: Display = maker.display(linear)
        self.exact = self.display.image(linear)
        self.to_world = np.linalg.inv(scene.view.matrix())[:3, :3]
        self.places = np.zeros((*self.covered.shape, 3), np.float32)
        self.places[::-1][self._covered.pixels] = self._covered.position
        is_seen = self.covered & ~np.any(linear != opaque, axis=-1)
        self.classes = np.where(is_seen, self._all_classes(), -1)

    @cached_property
    def covered(self) -> Bool[np.ndarray, "height width"]:
        """A mask of the pixels that show a surface, (height, width), row 0 on top."""
        return self._covered.pixels[::-1]

    def _all_classes(self) -> np.ndarray:
        power = self.surfaces[2][..., 3]
        # r = (2 / (s + 2))^(1/4), B. Karis, Specular BRDF Reference, 2013
        roughness = power if self.scene.is_metal_rough else (2.0 / (power + 2.0)) ** 0.25
        along = np.abs(self.surfaces[0][..., :3] @ self.to_world.T).max(axis=-1) > 1 - ALONG
        return np.where(along, 0, 1 + np.searchsorted(list(UP_TO.values()), roughness))

    def decoded(
        self, trip: Trip, turns: Sequence[Turn], normals: Float[np.ndarray, "count 3"], positions: np.ndarray
    ) -> Float[np.ndarray, "turns count 3"]:
        """Return view-space normals after a round trip through an encoding in each of its orientations, again in view
        space: (turns, count, 3)."""
        matrices = [np.eye(3) if turn is None else turn @ self.to_world for turn in turns]
        given = np.concatenate([normals @ matrix.T for matrix in matrices]).astype(np.float32)
        decoded = trip(given, np.tile(positions, (len(turns), 1))).reshape(len(turns), *normals.shape)
        return np.stack([part @ matrix for part, matrix in zip(decoded, matrices, strict=True)]).astype(np.float32)

    def shown(self, trip: Trip, turn: Turn) -> Float[np.ndarray, "height width 3"]:
        """Return the displayed image with an encoding's decoded normals in one orientation, (height, width, 3)."""
        # To list what is drawn takes as long as to light it.
        if self._made.frame.scene is not self.scene:
            self._made.frame.show(self.scene)
        (normals,) = self.decoded(trip, [turn], self._covered.normals, self._covered.position)
        return self.display.image(self._made.lit(self._covered.with_normals(self.surfaces, normals)))

    def held_by(self, domain: str) -> Bool[np.ndarray, "height width"]:
        """Return the mask of covered pixels whose normal is in a domain."""
        return self.covered & in_domain(self.surfaces[0][..., :3], self.places, domain)

    def view_angles(self) -> Float[np.ndarray, " covered"]:
        """Return the angles between the covered pixels' normals and the lines of sight to the viewer, in degrees."""
        return view_angles(self.surfaces[0][self.covered, :3], self.places[self.covered])

    def by_class(self, trip: Trip, turns: Sequence[Turn], domain: str) -> dict[str, Float[np.ndarray, " turns"]]:
        """Return the mean squared error of each class and, under "", of the frame; see `SampledImage.by_class`."""
        held, rows = self.held_by(domain), []
        numbers = {"": held} | {name: held & (self.classes == i) for i, name in enumerate((AXIS_ALIGNED, *UP_TO))}
        for turn in turns:
            shown = self.shown(trip, turn)
            errors = np.mean(np.where(np.isfinite(shown), shown - self.exact, 1.0) ** 2, axis=-1)
            rows.append({name: errors[mask].mean() for name, mask in numbers.items() if mask.any()})
        return {name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())}


def whole_images(
    device: Device,
    stack: ExitStack,
    pipeline: Pipeline,
    maker: SceneMaker,
    setting: Setting,
    powers: Sequence[float | None],
) -> dict[float | None, WholeImage]:
    """Return a `WholeImage` of a scene for each specular power, by power; None leaves the scene's materials as they
    are. The images may be used until the stack is closed."""
    scene = maker.make(setting)
    plan = Plan(
        maker.within(SIZE), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], max(pipeline.light_targets), True, 1.0
    )
    renderer = stack.enter_context(rendering(device, pipeline, scene, plan))
    moments = {power: scene if power is None else scene.with_power(power) for power in powers}
    return {power: WholeImage(moment, maker, renderer) for power, moment in moments.items()}
