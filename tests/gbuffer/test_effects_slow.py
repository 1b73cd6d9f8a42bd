"""Passes and resources: invalid pipelines, the kinds of resources, and adding an effect."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawing import scene_of
from test_effects import PLAN

from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import Scene
from normalbench.gbuffer.scenes.setting import Setting

ROOT = Path(__file__).parents[2]


def stepped_aside(scene: Scene, by: float) -> Scene:
    """Return the scene from another viewpoint, in more ambient light."""
    x, y, z = scene.view.eye
    return replace(scene, view=replace(scene.view, eye=(x + by, y, z)), ambient=(by, by, by))


@pytest.mark.parametrize("pipeline", ["hybrid", "inferred", "forward_multipass"])
def test_a_scene_may_move_between_frames(gl, pipeline):
    """Frames drawn in sequence with a moving camera equal the same frames drawn alone, bit for bit. Another scene is
    refused."""
    moments = [stepped_aside(SCENES["room"].make(Setting(lights=4, time=time)), time) for time in (0.0, 0.3, 0.6)]
    plan, alone = replace(PLAN, shadows=True), []
    for moment in moments:
        with rendering(gl, PIPELINES[pipeline], moment, plan) as drawing:
            drawing.draw()
            alone.append(drawing.image())
    with rendering(gl, PIPELINES[pipeline], moments[0], plan) as drawing:
        for number, moment in enumerate(moments):
            drawing.draw(moment)
            differ = np.mean(drawing.image() != alone[number])
            assert differ == 0, f"{differ:.1%} of moment {number} differs"
        with pytest.raises(ValueError, match="another moment of a scene must have the same meshes"):
            drawing.draw(scene_of("objects"))
    assert np.mean(alone[0] != alone[1]) > 0.3, "the scene stands still"


EFFECT = '''"""The image, darker with distance, by a target of half the size."""

from functools import partial

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resource import Resource
from ..frame.resources import FINAL, SURFACE
from ..gl.device import MULTIPLY
from .effect import Effect, Number

NEARNESS = Resource("nearness", "r32f", scale=0.5)


def _measure(canvas: Canvas) -> Run:
    return canvas.over("dusk.frag", NEARNESS, TINTS=0)


def _tint(strength: float, canvas: Canvas) -> Run:
    return canvas.over("dusk.frag", FINAL, blend=MULTIPLY, TINTS=1, STRENGTH=strength)


def _passes(strength: float) -> tuple[Pass, ...]:
    return (
        Pass("nearness", SURFACE, (NEARNESS,), _measure, after=("linear_depth",), tells={"HAS_NEARNESS": 1}),
        Pass("dusk", (FINAL,), (FINAL,), partial(_tint, strength), after=("transparent",)),
    )


SETTINGS = {"strength": Number(1.0, 0.0, 4.0, "How much darker.")}
EFFECT = Effect("dusk", "darker with distance", "a test", NEARNESS, _passes, SETTINGS)
'''


SHADER = """#version 430
// How near each surface is, and the image times that.
#include "gbuffer.glsl"

#if TINTS
layout(location = 0) out vec4 colour;
#ifdef HAS_NEARNESS
uniform sampler2D nearness;
void main() { colour = vec4(pow(texelFetch(nearness, ivec2(gl_FragCoord.xy) / 2, 0).x, STRENGTH)); }
#endif
#else
layout(location = 0) out float nearness;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy / target_size.xy * size.xy);
    nearness = 1.0 / (1.0 - read_gbuffer(pixel).position.z);
}
#endif
"""


RENDERS = """
import sys
import numpy as np
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import chosen
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.gl.device import device
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import Scene
from normalbench.gbuffer.scenes.setting import Setting

plain, found = PIPELINES["deferred"], {}
plan = Plan((48, 36), 1, LAYOUTS["hybrid"], LIGHT_BUFFERS["rgba16f"], 1, True, 1.0)
dusk = chosen(EFFECTS["dusk"], {"strength": "2"})
for name, pipeline in (("plain", plain), ("dusk", plain.with_effect(dusk.passes()))):
    with rendering(device(), pipeline, SCENES["room"].make(Setting(lights=4)), plan) as made:
        made.draw()
        found |= {name: made.image(), f"{name}_depth": -made.gbuffer()[0][..., 2]}
np.savez(sys.argv[1], **found)
"""


def copied_tree(folder: Path) -> Path:
    """Copy the renderer's folders into a separate package and return its path."""
    package = folder / "normalbench"
    for room in ("encodings", "gbuffer"):
        shutil.copytree(ROOT / room, package / room, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "__init__.py").touch()
    return package


@pytest.mark.usefixtures("gl")
def test_adding_an_effect_takes_two_files_and_one_line(tmp_path):
    """In a copy of the tree, the effect scales the image by a factor that depends on the depth and its setting."""
    effects = copied_tree(tmp_path) / "gbuffer" / "effects"
    (effects / "dusk.py").write_text(EFFECT)
    (effects / "dusk.frag").write_text(SHADER)
    registry = effects / "catalogue.py"
    registry.write_text(
        registry.read_text().replace("NAMES: tuple[str, ...] = (\n", 'NAMES: tuple[str, ...] = (\n    "dusk",\n')
    )
    command = [sys.executable, "-c", RENDERS, str(tmp_path / "found.npz")]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    arrays = np.load(tmp_path / "found.npz")
    # Rows are counted from the top here, and from the bottom where the half-size target reads every odd one.
    depth = arrays["plain_depth"][::-1][1::2, 1::2].repeat(2, axis=0).repeat(2, axis=1)[::-1]
    expected = arrays["plain"] / (1 + depth[..., None]) ** 2
    error = np.abs(arrays["dusk"] - expected).max() / expected.max()
    assert error < 1e-6, f"{error:.2g} of the brightest pixel"
    changed = np.mean(np.abs(arrays["dusk"] - arrays["plain"]).max(axis=2) > 0.01)
    assert changed > 0.5, f"{changed:.0%} of the pixels changed"
