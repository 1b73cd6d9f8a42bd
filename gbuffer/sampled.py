"""Lighting of pixels sampled from a frame, for many sets of normals in one pass.

The passes of deferred shading run over an image in which each column is one pixel of the frame, and each row a set
of normals. Passes that filter, trace or mix pixels cannot be sampled.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import numpy as np

from ..encodings.catalogue import LIGHT_BUFFERS
from .codecs.light.light_passes import BLEND_OF
from .frame.canvas import Canvas
from .frame.contract import Pass, Pipeline, Run
from .frame.plan import Plan
from .frame.resource import SURFACES, Resource
from .frame.resources import COLOURS, DEPTH, GBUFFER, LIGHT, SHADOW_MAP, SURFACE
from .gl.device import Device
from .gl.handles import VertexArray
from .layouts.presets import LAYOUTS
from .passes.linear_depth import linear_depth
from .passes.screen import screen
from .passes.shadow_map import shadow_map
from .render import GEOMETRY, Rendering, rendering
from .scenes.scene import Scene

# Where each column's pixel is on the screen, from -1 to 1.
PLACES = Resource("places", "rg32f", follows=SURFACES)
# Columns of one light that are closer than this are drawn together.
GAP = 16


class SampledScene:
    """Sampled pixels of a scene; their resources are released with the stack.

    Args:
        device: the device that renders.
        scene: the scene, for its lights and its environment.
        size: width and height of the frame that contains the pixels.
        pixels: rows and columns of the pixels in the frame, row 0 on top, (count, 2).
        positions: view positions of the pixels, (count, 3).
        rows: maximum number of sets of normals lit at once.
    """

    def __init__(
        self,
        device: Device,
        stack: ExitStack,
        scene: Scene,
        size: tuple[int, int],
        pixels: np.ndarray,
        positions: np.ndarray,
        rows: int,
    ):
        self._rows, count = rows, len(pixels)
        plan = Plan((count, rows), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, True, 1.0, sampled_from=size)
        self._made: Rendering = stack.enter_context(rendering(device, _pipeline(positions), scene, plan))
        self._made.draw()
        # (x + 1/2) 2 / width - 1 at the middle of pixel x, y from the bottom
        places = np.stack([pixels[:, 1], size[1] - 1 - pixels[:, 0]], axis=1).astype(np.float32) + np.float32(0.5)
        places = places / np.array(size, np.float32) * np.float32(2) - np.float32(1)
        self._upload(self._made.frame.textures(PLACES), [places])
        self._surfaces: Sequence[np.ndarray] = ()

    def lit(self, scene: Scene, surfaces: Sequence[np.ndarray], normals: np.ndarray) -> np.ndarray:
        """Return the light that surfaces with each set of normals reflect: linear, float32 of shape (sets, count, 3).

        Args:
            scene: the scene, at one moment.
            surfaces: surfaces of the scene's pixels, as returned by `Rendering.surfaces` with layout fp32, (count,
                channels) each.
            normals: view-space normals, (sets, count, 3), at most as many sets as there are rows.
        """
        if self._made.frame.scene is not scene:
            self._made.frame.show(scene)
        first, *others = self._made.frame.textures(GBUFFER)
        if surfaces is not self._surfaces:
            self._upload(others, surfaces[1 : 1 + len(others)])
            self._surfaces = surfaces
        texels = np.broadcast_to(surfaces[0], (self._rows, *surfaces[0].shape)).astype(np.float32)
        texels[: len(normals), :, :3] = normals
        first.write(texels.tobytes())
        # Lights are added to what surfaces give off, which is in the first of a light buffer's targets.
        self._upload(self._made.frame.textures(LIGHT), surfaces[1 + len(others) :][:1])
        return self._made.light()[::-1][: len(normals)]

    def _upload(self, textures: Sequence[Any], columns: Sequence[np.ndarray]) -> None:
        """Write each array of numbers, (count, channels), into every row of its texture."""
        for texture, numbers in zip(textures, columns, strict=True):
            texture.write(np.broadcast_to(numbers, (self._rows, *numbers.shape)).astype(np.float32).tobytes())


def _pipeline(positions: np.ndarray) -> Pipeline:
    """Return a deferred-shading pipeline for pixels at these positions, whose surfaces are given instead of drawn."""
    given = Pass(
        GEOMETRY, (), (GBUFFER, DEPTH, LIGHT, PLACES), _build_given, tells={"LIGHT_HOLDS": COLOURS, "FILTERS": 0}
    )

    def lights(canvas: Canvas) -> Run:
        return LightsOnColumns(canvas, positions)

    unlit = screen()
    passes = (
        shadow_map(),
        given,
        linear_depth(),
        Pass("lights", (*SURFACE, SHADOW_MAP, PLACES, LIGHT), (LIGHT,), lights, needs=unlit.needs),
        replace(unlit, reads=(*unlit.reads, PLACES)),
    )
    return Pipeline("sampled", "pixels of a frame, lit several times", "this project", passes, usual_layout="fp32")


def _build_given(canvas: Canvas) -> Run:
    target = canvas.target(depth=DEPTH)

    def run() -> None:
        target.use()
        # All is covered.
        canvas.device.context.clear(depth=0.0)

    return run


class LightsOnColumns:
    """A pass that draws each light on the columns whose pixels it reaches, and the sun on all columns."""

    def __init__(self, canvas: Canvas, positions: np.ndarray):
        self._canvas, self._blend = canvas, BLEND_OF[canvas.plan.light_buffer.blend]
        self._target = canvas.target(LIGHT)
        self._sun = canvas.fullscreen("lights.frag", LIT_BY_SUN=1)
        self._program = canvas.program("columns.vert", "lights.frag", LIT_BY_SUN=0)
        buffers, frame = canvas.frame.scene_buffers, canvas.frame
        self._lamps: list[tuple[int, VertexArray]] = []
        for index in range(buffers.first_lamp, len(buffers.lights)):
            light = buffers.lights[index]
            centre = (buffers.view @ np.append(light.position, 1.0))[:3]
            (reached,) = np.nonzero(np.linalg.norm(positions - centre, axis=1) < light.radius)
            if len(reached):
                corners = _rectangles(reached, len(positions))
                vertices = frame.device.owned(frame.stack, frame.context.buffer(corners.tobytes()))
                self._lamps.append((index, frame.array(self._program, [(vertices, "2f", "in_position")])))

    def __call__(self) -> None:
        self._target.use()
        self._canvas.device.state(None, self._blend)
        if self._canvas.frame.scene_buffers.first_lamp:
            self._canvas.prepare(self._sun.program)
            self._sun.render(vertices=3)
        self._canvas.prepare(self._program)
        for index, drawn in self._lamps:
            self._program["light"] = index
            drawn.render()


def _rectangles(columns: np.ndarray, count: int) -> np.ndarray:
    """Return triangles, in clip space, over each run of sorted pixel columns whose neighbours are at most GAP apart:
    float32 of shape (corners, 2)."""
    (breaks,) = np.nonzero(np.diff(columns) > GAP)
    begins, ends = columns[np.append(0, breaks + 1)], columns[np.append(breaks, len(columns) - 1)] + 1
    left, right = (edges * 2 / count - 1 for edges in (begins, ends))
    low, high = np.full(len(left), -1.0), np.full(len(left), 1.0)
    corners = [(left, low), (right, low), (right, high), (left, low), (right, high), (left, high)]
    return np.stack([np.stack(corner, axis=1) for corner in corners], axis=1).reshape(-1, 2).astype(np.float32)
