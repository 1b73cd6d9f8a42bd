"""Small frames of the renderer, read back for tests."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resources import LIGHT, SHADOW_MAP, SHADOW_SIZE
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import Light, Scene
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (160, 120)
FP32 = LAYOUTS["fp32"]
# Those that every pipeline draws.
BLINN_PHONG = [name for name, maker in SCENES.items() if not maker.is_metal_rough]
EXACT = ("forward", "forward_multipass", "deferred", "prepass", "hybrid", "inferred")


@dataclass(frozen=True)
class Drawn:
    """A frame read back: image, light targets and unpacked G-buffer, top row first; shadow map, row 0 first."""

    image: np.ndarray
    light: list[np.ndarray]
    gbuffer: list[np.ndarray]
    shadow_map: np.ndarray | None


def draw(gl, pipeline: str, scene: Scene, layout=FP32, shadows=False, targets=2, scale=1.0, **more) -> Drawn:
    chosen = PIPELINES[pipeline]
    targets = min(targets, max(chosen.light_targets, default=1))
    plan = Plan(SIZE, 1, layout, LIGHT_BUFFERS["rgba32f"], targets, shadows, scale, **more)
    with rendering(gl, chosen, scene, plan) as r:
        r.draw()
        deferred = chosen.has_gbuffer
        light = r.read(LIGHT) if deferred else []
        depths = np.frombuffer(r.frame.textures(SHADOW_MAP)[0].read(), np.float32) if r.frame.plan.shadows else None
        return Drawn(
            r.image(),
            light,
            r.gbuffer() if deferred else [],
            None if depths is None else depths.reshape(SHADOW_SIZE, SHADOW_SIZE),
        )


@cache
def scene_of(name: str) -> Scene:
    return SCENES[name].make(Setting(objects=60, lights=16))


@cache
def drawn(gl, pipeline: str, scene: str, shadows: bool) -> Drawn:
    return draw(gl, pipeline, scene_of(scene), shadows=shadows)


def psnr(error: np.ndarray, peak: float = 1.0) -> float:
    mean = np.mean(np.square(error, dtype=np.float64))
    return float(10 * np.log10(peak**2 / mean)) if mean > 0 else np.inf


def lamps(scene: Scene) -> list[Light]:
    return [light for light in scene.lights if light.kind != "sun"]


def towards(*way: float) -> tuple[float, ...]:
    return tuple(np.array(way) / np.linalg.norm(way))


def apart(a: np.ndarray, b: np.ndarray) -> float:
    """Return the PSNR in dB between two linear images as they are displayed."""
    return psnr(displayed(a) - displayed(b))


def covered_by_glass(gl, name: str) -> np.ndarray:
    """Return which pixels transparent surfaces cover, found by making these surfaces glow."""
    scene = scene_of(name)
    glowing = tuple(replace(m, emissive=(1e4,) * 3) if m.alpha < 1 else m for m in scene.materials)
    if glowing == scene.materials:
        return np.zeros(SIZE[::-1], bool)
    return draw(gl, "forward", replace(scene, materials=glowing, lights=())).image[..., 0] > 1e3
