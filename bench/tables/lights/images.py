"""What a light buffer does to images: antialiasing resolved in a code, and frames lit through one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.codecs.light_codec import LightCodec
from ....encodings.vec import Vec4, light_or_none
from ....gbuffer.codecs.light.light_passes import Resolved, read_samples, resolved
from ....gbuffer.display import displayed
from ....gbuffer.frame.plan import Plan
from ....gbuffer.frame.resources import FINAL, LIGHT
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.metal_rough import MetalRough
from ....gbuffer.scenes.scene import Colour, Material, Scene
from ...ground.output.errors import UsageError
from ...measures.metrics.images import squared_error
from ...measures.metrics.totals import psnr_db

Row = dict[str, Any]
# Lamps and sun this much brighter: highlights then reach several times what a display shows.
EXPOSURE = 2.0
# What counts as visibly wrong: more than this in any channel as displayed.
VISIBLE = 8 / 255
REFERENCE = LIGHT_BUFFERS["rgba32f"]


@dataclass(frozen=True)
class Shot:
    """A scene, by name, at one size, and the seed that it was made with."""

    name: str
    scene: Scene
    size: tuple[int, int]
    seed: int

    def plan(self, samples: int = 1) -> Plan:
        """Everything exact."""
        return Plan(self.size, samples, LAYOUTS["fp32"], REFERENCE, 2, True, 1.0)


@partial(jax.jit, static_argnames="encoding")
def _by_model(encoding: LightCodec, samples) -> tuple[Any, Any]:
    """Light of shape (samples, pixels, 3) resolved in the code and in light: (pixels, 3) each."""
    r, g, b = (samples[..., i] for i in range(3))
    texels = encoding.store(encoding.encode(light_or_none(Vec4(r, g, b, jnp.zeros_like(r)))))
    averaged = encoding.store(Vec4(*(jnp.mean(c, axis=0) for c in texels)))
    by_code, by_light = encoding.decode(averaged), Vec4(*(jnp.mean(c, axis=0) for c in encoding.decode(texels)))
    return jnp.stack(by_code[:3], axis=-1), jnp.stack(by_light[:3], axis=-1)


class Resolves:
    """A bright scene at some samples a pixel, resolved in each of several codes: by the device and by the model.

    Args:
        device: where.
        shot: the scene.
        samples: of each pixel, as the device has them.

    Attributes:
        right: the image resolved in light without any code, as displayed.
        failed: why the device cannot keep some of the codes.
    """

    def __init__(self, device: Device, shot: Shot, encodings: Sequence[LightCodec], samples: int):
        plan, scene = shot.plan(samples), brighter(shot.scene, EXPOSURE)
        with rendering(device, PIPELINES["forward"], scene, plan) as made:
            made.draw()
            colours = made.frame.textures(FINAL)[0]
            self._light = read_samples(device, colours, samples)
            self._device: dict[LightCodec, Resolved] = {}
            self._model: dict[LightCodec, Resolved] = {}
            self.failed: dict[LightCodec, str] = {}
            for encoding in encodings:
                try:
                    self._device[encoding] = resolved(device, encoding, colours, samples)
                except (FormatError, ShaderError) as error:
                    self.failed[encoding] = str(error)
        self.right = displayed(self._light.mean(axis=0, dtype=np.float64))

    def device(self, encoding: LightCodec) -> Resolved:
        """By the device's own resolve, as displayed."""
        found = self._device[encoding]
        return Resolved(displayed(found.by_code), displayed(found.by_light))

    def model(self, encoding: LightCodec) -> Resolved:
        """By the model, of the same samples, as displayed."""
        if encoding not in self._model:
            self._model[encoding] = self._model_images(encoding)
        return self._model[encoding]

    def _model_images(self, encoding: LightCodec) -> Resolved:
        flat = jnp.asarray(self._light.reshape(len(self._light), -1, 3))
        found = (np.asarray(a).reshape(self._light.shape[1:]) for a in _by_model(encoding, flat))
        return Resolved(*map(displayed, found))

    def compared(self, found: Resolved, aliased: Resolved) -> Row:
        """Figures of a resolve, `aliased` being the same code's at one sample a pixel."""
        apart = np.abs(found.by_code - self.right).max(axis=-1)
        return {
            "code_psnr_db": psnr_db(squared_error(found.by_code, self.right)[0]),
            "light_psnr_db": psnr_db(squared_error(found.by_light, self.right)[0]),
            "aliased_psnr_db": psnr_db(squared_error(found.by_code, aliased.by_code)[0]),
            "wrong_percent": 100 * float(np.mean(apart > VISIBLE)),
        }


def brighter(scene: Scene, exposure: float) -> Scene:
    """A scene under lights, and light of its own, so many times as bright."""

    def times(colour: Colour) -> Colour:
        r, g, b = (channel * exposure for channel in colour)
        return r, g, b

    def glowing(material: Material | MetalRough) -> Material | MetalRough:
        if isinstance(material, MetalRough):
            return replace(material, emission=times(material.emission))
        return replace(material, emissive=times(material.emissive))

    around = scene.environment
    return replace(
        scene,
        ambient=times(scene.ambient),
        lights=tuple(replace(light, colour=times(light.colour)) for light in scene.lights),
        materials=tuple(glowing(material) for material in scene.materials),
        environment=around and replace(around, radiance=around.radiance * np.float32(exposure)),
    )


def with_power(shot: Shot, power: float) -> Shot:
    """A shot in which every material has one specular power."""
    return replace(shot, scene=shot.scene.with_power(power))


class Lit:
    """Frames of one pipeline and shot, lit through light buffers.

    Attributes:
        reference: by two light targets, where the pipeline may have them, in 32-bit floats; as displayed.
    """

    def __init__(self, device: Device, pipeline: Pipeline, shot: Shot):
        self._device, self._pipeline, self._shot = device, pipeline, shot
        with self._open_rendering(REFERENCE, max(pipeline.light_targets)) as made:
            self.reference = displayed(made.image())
            # The most light that any target keeps in a pixel.
            self._brightest = np.max([light[..., :3].max(axis=-1) for light in made.read(LIGHT)], axis=0)
        if not self._brightest.any():
            raise UsageError(f"{shot.name}: no light reaches what its camera sees; every light buffer would be exact")

    @contextmanager
    def _open_rendering(self, encoding: LightCodec, targets: int) -> Iterator[Rendering]:
        plan = replace(self._shot.plan(), light_buffer=encoding, light_targets=targets)
        with rendering(self._device, self._pipeline, self._shot.scene, plan) as made:
            made.draw()
            yield made

    def measure(self, encoding: LightCodec, targets: int) -> tuple[Row, np.ndarray]:
        """Figures of a frame, and the frame as displayed. Raises FormatError and ShaderError."""
        with self._open_rendering(encoding, targets) as made:
            image = displayed(made.image())
        mse, broken = squared_error(image, self.reference)
        held = self._brightest <= encoding.limit
        row: Row = {
            "mse": mse,
            "psnr_db": psnr_db(mse),
            "invalid": broken,
            "beyond_percent": 100 * float(np.mean(~held)),
        }
        if held.any():
            row["held_psnr_db"] = psnr_db(squared_error(image[held], self.reference[held])[0])
        return row, image


def targets_of(pipeline: Pipeline, encoding: LightCodec, asked: Sequence[int]) -> Iterator[int]:
    """How many of the light targets asked for a pipeline may have in this code, two first.

    Of one target the fourth number is needed, by whoever may have two; who may only have one has it without asking.
    """
    only_one = max(pipeline.light_targets) == 1
    for targets in sorted(pipeline.light_targets, reverse=True):
        if only_one or (targets in asked and (targets > 1 or encoding.has_alpha)):
            yield targets
