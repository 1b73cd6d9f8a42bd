"""Skin under light that is written by hand, and the result of subsurface scattering."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from drawing import FP32

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import chosen
from normalbench.gbuffer.frame.contract import Pass
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resources import LIGHT
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import plane
from normalbench.gbuffer.scenes.scene import Light, Material, Scene, ScenePart, View, placed

SIZE = (97, 73)
SUBSURFACE = EFFECTS["subsurface"]
SKIN, STONE = Material("skin", albedo=(0.75, 0.5, 0.4)), Material(albedo=(0.4, 0.4, 0.4))
FACING = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, -1.0, 0)])
# Where SIZE's height shows one metre at a distance of one.
FOV = float(np.degrees(2 * np.arctan(0.5)))
# A scene needs a light; this one reaches nothing.
DARK = Light("point", (1.0, 1.0, 1.0), (0.0, 0.0, 50.0), 1.0)


def facing(*planes: tuple[float, float, float, float, int], distance: float = 1.0, lights=(DARK,)) -> Scene:
    """Return planes that face an eye, `distance` from z = 0: width, height, x and z of the middle, material."""
    parts = tuple(
        ScenePart(
            plane(width, height).placed(FACING, (0, 0, 0)), placed((x, 0.0, z)), np.array([material]), casts=False
        )
        for width, height, x, z, material in planes
    )
    view = View((0.0, 0.0, distance), (0.0, 0.0, 0.0), FOV, 0.01, 20.0)
    return Scene(parts, (SKIN, STONE), tuple(lights), (0.0, 0.0, 0.0), view, view)


WALL = (9.0, 9.0, 0.0, 0.0, 0)


def lit_by_hand(light: np.ndarray) -> Pass:
    """Return a pass that writes diffuse light, (height, width, 3), top row first, in place of the lights' result."""

    def build(canvas):
        texels = np.zeros((*light.shape[:2], 4), np.float32)
        texels[..., :3] = light[::-1]
        return lambda: canvas.textures(LIGHT)[0].write(texels.tobytes())

    return Pass("hand", (LIGHT,), (LIGHT,), build, after=("lights",))


def plan_of(size=SIZE, layout=FP32, light="rgba32f", samples=1, shadows=False, scale=1.0) -> Plan:
    return Plan(size, samples, layout, LIGHT_BUFFERS[light], 2, shadows, scale)


def passes(given: Mapping[str, object]) -> tuple[Pass, ...]:
    return chosen(SUBSURFACE, {name: str(value) for name, value in given.items()}).passes()


def scattered(gl, scene: Scene, light: np.ndarray | None = None, pipeline="hybrid", plan=None, **given) -> np.ndarray:
    """Return the skin's light and its depth, (height, width, 4)."""
    hand = () if light is None else (lit_by_hand(light),)
    scattering = PIPELINES[pipeline].with_effect((*hand, *passes(given)))
    with rendering(gl, scattering, scene, plan or plan_of()) as r:
        r.draw()
        return r.read(SUBSURFACE.result)[0]
