"""The effect of each encoding of an attribute on the displayed image when everything else is exact: mean squared
errors by class of surfaces."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property

import jax
import numpy as np

from ....encodings.catalogue import ENCODINGS, LIGHT_BUFFERS, is_in_catalogue
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.words import targets_of
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.setting import Setting
from ...ground.output import cache
from ...ground.output.sources import sources
from ...measures.metrics.flip import Flip
from .attributes import Code, Surfaces

PIPELINE = "deferred"
# All of a metal/rough surface in floats.
EXACT = Layout(
    "exact",
    "a metal/rough surface in 32-bit floats",
    targets_of(
        "rgba32f: normal.x normal.y normal.z -; rgba32f: base_color shading_model; rgba32f: metallic f0 roughness ao"
    ),
    ENCODINGS["xyz"],
    "this project",
    space="world",
)
# Classes of surfaces by perceptual roughness, each up to its own; and those that give off light.
MIRROR, GLOSSY, ROUGH, EMISSIVE = CLASSES = ("mirror", "glossy", "rough", "emissive")
UP_TO = {MIRROR: 0.2, GLOSSY: 0.5, ROUGH: np.inf}
# A class of fewer pixels is not judged: a few edges would decide.
LEAST_PIXELS = 256
# Of FLIP over the pixels.
PERCENTILE = 99.0
FRAME = "frame"


@dataclass(frozen=True)
class Stage:
    """A scene and the size at which it is measured."""

    maker: SceneMaker
    setting: Setting
    size: tuple[int, int]

    @cached_property
    def scene(self):
        return self.maker.make(self.setting)

    def plan(self, layout: Layout) -> Plan:
        """Return the plan that draws the stage with a layout, with exact light."""
        return Plan(self.size, 1, layout, LIGHT_BUFFERS["rgba32f"], 1, True, 1.0)


class Exact:
    """The exact image of a stage, with which other images are compared. Its rendering is closed with the stack."""

    def __init__(self, device: Device, stack: ExitStack, stage: Stage):
        self.stage, self._device = stage, device
        self._made: Rendering = stack.enter_context(
            rendering(device, PIPELINES[PIPELINE], stage.scene, stage.plan(EXACT))
        )
        self._textures = self._made.surfaces()
        linear = self._made.lit(self._textures)
        normal, colour, material, light = self._textures
        self.covered = np.linalg.norm(normal[..., :3], axis=-1) > 0.5
        exposure = stage.maker.exposure
        self.display = Display(
            measured_exposure(linear[self.covered]) if exposure is None else exposure, stage.maker.tone_mapping
        )
        self.shown = self.display.image(linear)
        self._flip = Flip(self.shown)
        metallic, f0, roughness, ao = (material[..., i] for i in range(4))
        self.surfaces = Surfaces(normal[..., :3], colour[..., :3], roughness, metallic, f0, ao, light[..., :3])
        self.classes = self._masks(light[..., :3].max(axis=-1) > 0)

    def _masks(self, gives_light: np.ndarray) -> dict[str, np.ndarray]:
        """Return a mask for each class of surfaces with enough pixels, and a mask of all covered pixels (FRAME)."""
        roughness, masks, low = self.surfaces.roughness, {FRAME: self.covered}, -np.inf
        for name, high in UP_TO.items():
            masks[name] = self.covered & ~gives_light & (roughness > low) & (roughness <= high)
            low = high
        masks[EMISSIVE] = self.covered & gives_light
        return {name: mask for name, mask in masks.items() if mask.sum() >= LEAST_PIXELS}

    @cached_property
    def key(self) -> str:
        """A digest that identifies the exact image: the program and inputs that compute it, and its pixels."""
        digest = hashlib.sha256(f"{sources()} {jax.__version__} {self._device.renderer}".encode())
        for array in (*self._textures, self.shown):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()

    def errors(self, shown: np.ndarray) -> dict[str, float]:
        """Return the mean squared error of each class in a displayed image, (height, width, 3) in [0, 1]; values that
        are not finite count as an error of 1."""
        apart = np.where(np.isfinite(shown), shown - self.shown, 1.0) ** 2
        return {name: float(apart[mask].mean()) for name, mask in self.classes.items()}

    def of(self, trip: Callable[[Surfaces], Surfaces]) -> dict[str, float]:
        """Return the mean squared error that `trip`, a round trip of the surfaces, causes in each class."""
        return self.errors(self.display.image(self._made.lit(self._texels(trip(self.surfaces)))))

    def of_layout(self, layout: Layout) -> ImageErrors:
        """Return the errors of the image drawn with a layout. Raises ShaderError, FormatError and LayoutError."""
        is_known = is_in_catalogue(layout.encoding)
        key = cache.key_of("budget layout", self.key, layout.summary) if is_known else ""
        figures = cache.figures(key, lambda: self._drawn(layout))
        return ImageErrors(figures["errors"], figures["flip"])

    def _drawn(self, layout: Layout) -> dict[str, object]:
        stage = self.stage
        with rendering(self._device, PIPELINES[PIPELINE], stage.scene, stage.plan(layout)) as drawing:
            drawing.draw()
            shown = self.display.image(drawing.image())
        return {"errors": self.errors(shown), "flip": self._flip_p99(shown)}

    def _flip_p99(self, shown: np.ndarray) -> float:
        return float(np.percentile(self._flip.of(shown)[self.covered], PERCENTILE))

    def _texels(self, given: Surfaces) -> Sequence[np.ndarray]:
        normal, colour, material, light = (texture.copy() for texture in self._textures)
        where = self.covered
        normal[where, :3], colour[where, :3] = given.normal[where], given.base_color[where]
        light[where, :3] = given.emissive[where]
        numbers = (given.metallic, given.f0, given.roughness, given.ao)
        material[where] = np.stack([channel[where] for channel in numbers], axis=-1)
        return normal, colour, material, light


@dataclass(frozen=True)
class ImageErrors:
    """The errors of the image that is drawn with a layout: the mean squared error of each class, and the 99th
    percentile of FLIP over covered pixels."""

    errors: Mapping[str, float]
    flip: float


def rates_of_pair(exact: Exact, first: Code, second: Code) -> Mapping[str, float]:
    """Return the mean squared error that two encodings cause together in each class. Cached."""
    trips = [code.trip for code in (first, second) if code.trip]
    key = cache.key_of("budget pair", exact.key, str(first.key), str(second.key))
    return cache.figures(key, lambda: exact.of(lambda seen: trips[1](trips[0](seen))))


Rates = Mapping[str, Mapping[str, float]]


def rates(exact: Exact, codes: Sequence[Code], tick: Callable[[str], None]) -> Rates:
    """Return the mean squared error that each encoding causes in each class, by name of the encoding and then of the
    class. Encodings that no image shows are left out. Cached by everything that the image is made from."""
    key, errors = exact.key, {}
    for code in codes:
        if code.trip is not None:
            name, trip = f"{code.attribute} {code.name}", code.trip
            errors[code.name] = cache.figures(cache.key_of("budget", key, name), lambda trip=trip: exact.of(trip))
            tick(name)
    return errors
