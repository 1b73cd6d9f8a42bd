"""Frames rendered, timed and counted."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..encodings.shared.position import position_from_linear_depth
from ..encodings.vec import Vec2
from .frame.canvas import built
from .frame.contract import Pass, Pipeline, Run
from .frame.frame import Frame
from .frame.plan import Plan
from .frame.resource import Resource
from .frame.resources import FINAL, GBUFFER, LIGHT, TERMS
from .gl.device import Device, read_pixels
from .layouts.words import LayoutError
from .pipelines import PIPELINES
from .readback.resolve import RESOLVE, RESOLVED
from .readback.unpack import UNPACK, UNPACKED
from .scenes.scene import Scene

# From view positions and unit normals, (pixels, 3), to other normals.
Keeps = Callable[[np.ndarray, np.ndarray], np.ndarray]
GEOMETRY = "geometry"
WALL, QUERY = "wall clock after each pass", "GL timer query"


@dataclass(frozen=True)
class Timing:
    """Times of repeated frames in milliseconds: the median, the interquartile range, and each sample."""

    median: float
    spread: float
    samples: tuple[float, ...]


@dataclass(frozen=True)
class Clock:
    """A clock: its name, and a function that runs a given function and returns the elapsed milliseconds."""

    name: str
    measure: Callable[[Callable[[], object]], float]


def clock_of(device: Device) -> Clock:
    """Return a clock that uses a device's timer queries, or a wall clock for a software rasteriser.

    Timer queries of a software rasteriser are not reliable.
    """

    def by_wall_clock(run: Callable[[], object]) -> float:
        start = time.perf_counter()
        run()
        device.context.finish()
        return (time.perf_counter() - start) * 1e3

    def by_query(run: Callable[[], object]) -> float:
        query = device.context.query(time=True)
        with query:
            run()
        return query.elapsed * 1e-6

    return Clock(WALL, by_wall_clock) if device.is_software else Clock(QUERY, by_query)


class Covered(NamedTuple):
    """The pixels that surfaces cover: a mask, row 0 at the bottom; and view positions and normals, (pixels, 3)."""

    pixels: np.ndarray
    position: np.ndarray
    normals: np.ndarray

    def with_normals(self, surfaces: Sequence[np.ndarray], normals: np.ndarray) -> list[np.ndarray]:
        """Return the surfaces with `normals`, (pixels, 3), in the covered pixels; the inputs are not changed."""
        first, *others = surfaces
        texels = first[::-1].copy()
        texels[self.pixels, :3] = normals
        return [texels[::-1], *others]


class Rendering:
    """A pipeline whose passes are compiled for a scene. Create it with `rendering`."""

    def __init__(self, frame: Frame, passes: dict[str, Run]):
        self.frame, self.passes = frame, passes
        self._device = frame.device
        self._more: dict[Pass, Run] = {}
        self._is_warm = False

    def draw(
        self,
        scene: Scene | None = None,
        keeps: Keeps | None = None,
        given: tuple[Resource, np.ndarray] | None = None,
        only: Resource | None = None,
    ) -> None:
        """Draw one frame, all passes in order.

        Args:
            scene: the scene at a different moment; None for no change.
            keeps: function that replaces the normals in the G-buffer; only for layout fp32, one sample per pixel.
            given: a resource of one texture and its texels, as `read` returns them, instead of what the pass that
                writes it alone would draw.
            only: a resource; passes that it does not need are left out. None for all passes.
        """
        if scene:
            self.frame.show(scene)
        self.frame.advance()
        if given:
            (texture,) = self.frame.textures(given[0])
            texture.write(np.ascontiguousarray(given[1][::-1], np.float32).tobytes())
        names = self._needed(only, given[:1] if given else ()) if given or only else self.passes
        for name, run in self.passes.items():
            if name not in names:
                continue
            run()
            if keeps and name == GEOMETRY:
                self._exchange(keeps)
        self._is_warm = True

    def _needed(self, only: Resource | None, given: tuple[Resource, ...]) -> set[str]:
        """Return the names of the passes that `only` needs, or all, except those that write nothing but `given`."""
        names: set[str] = set()
        wanted = {only} if only else set(self.frame.pipeline.resources.values())
        for stage in reversed(self.frame.pipeline.stages):
            if stage.writes != given and not wanted.isdisjoint(stage.writes):
                names.add(stage.name)
                wanted.update(stage.reads)
        return names

    def _exchange(self, keeps: Keeps) -> None:
        texture = self.frame.textures(GBUFFER)[0]
        texels = read_pixels(texture).copy()
        covered, position = self._covered(texels)
        texels[covered, :3] = keeps(position, texels[covered, :3])
        texture.write(texels.tobytes())

    def _covered(self, texels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return which texels of layout fp32's first target, row 0 at the bottom, surfaces cover, (height, width),
        and the view positions of these texels, (pixels, 3)."""
        height, width, _ = texels.shape
        rays, depth = self.frame.scene.view.rays((width, height)), texels[..., 3]
        # (x + 1/2) 2 / width - 1 at the middle of pixel x
        x, y = ((np.arange(size, dtype=np.float32) + 0.5) * 2 / size - 1 for size in (width, height))
        planes = position_from_linear_depth(Vec2(x, y[:, None]), depth, Vec2(*rays[:2]))
        position = np.stack(planes, axis=-1).astype(np.float32)
        covered = depth > 0
        return covered, position[covered]

    def surfaces(self) -> list[np.ndarray]:
        """Run the passes up to the geometry pass and return their output: the textures of the G-buffer, then the
        textures of emitted light; float32, (height, width, channels) each, row 0 on top.

        Only at one sample per pixel, with a layout and a light buffer in 32-bit floats.
        """
        self.frame.advance()
        for name, run in self.passes.items():
            run()
            if name == GEOMETRY:
                break
        return [read_pixels(texture)[::-1].copy() for texture in self._textures_of_surfaces()]

    def covered(self, surfaces: Sequence[np.ndarray]) -> Covered:
        """Return the pixels covered by surfaces that the method `surfaces` returned with layout fp32."""
        texels = surfaces[0][::-1]
        covered, position = self._covered(texels)
        return Covered(covered, position, texels[covered, :3])

    def lit(self, surfaces: Sequence[np.ndarray], upto: str = "") -> np.ndarray:
        """Return the image that the passes after the geometry pass make from surfaces, as returned by `surfaces`.

        Args:
            upto: the first pass to skip, with all later passes; empty to skip no pass.
        """
        for texture, texels in zip(self._textures_of_surfaces(), surfaces, strict=True):
            texture.write(np.ascontiguousarray(texels[::-1], np.float32).tobytes())
        return self.light(upto)

    def light(self, upto: str = "") -> np.ndarray:
        """Run the passes after the geometry pass on the surfaces in the textures; return the image, as `lit` does."""
        names = list(self.passes)
        for name in names[names.index(GEOMETRY) + 1 : names.index(upto) if upto else None]:
            self.passes[name]()
        return self.image()

    def _textures_of_surfaces(self) -> list[Any]:
        return [*self.frame.textures(GBUFFER), *self.frame.textures(LIGHT)]

    def image(self) -> np.ndarray:
        """Return the final image of the last frame drawn: linear light, float32 (height, width, 3), row 0 on top."""
        return self.read(FINAL if self.frame.plan.samples == 1 else RESOLVED, RESOLVE)[0][..., :3]

    def gbuffer(self) -> list[np.ndarray]:
        """Return the contents of the last frame's G-buffer, in the order of `unpack.UNPACKED`; row 0 on top, 0 in
        pixels that no surface covers. Only at one sample per pixel."""
        return [self.read(resource, UNPACK)[0] for resource in UNPACKED]

    def read(self, resource: Resource, by: Pass | None = None) -> list[np.ndarray]:
        """Return a resource's textures in 32-bit floats, row 0 on top; `by` runs first if it writes the resource."""
        if by and resource in by.writes:
            if by not in self._more:
                self._more[by] = built(self.frame, by)
            self._more[by]()
        return [read_pixels(texture)[::-1] for texture in self.frame.textures(resource)]

    def timings(self, repeats: int) -> tuple[dict[str, Timing], str]:
        """Return the times of each pass, by name, and of the whole frame, as "frame", over `repeats` frames after at
        least one other frame; and the clock's name."""
        clock = clock_of(self._device)
        if not self._is_warm:
            self.draw()
        self._device.context.finish()
        taken: dict[str, list[float]] = {name: [] for name in (*self.passes, "frame")}
        for _ in range(repeats):
            self.frame.advance()
            for name, run in self.passes.items():
                taken[name].append(clock.measure(run))
            taken["frame"].append(clock.measure(self.draw))
        quartiles = {name: np.percentile(times, [25, 50, 75]) for name, times in taken.items()}
        timings = {n: Timing(float(q[1]), float(q[2] - q[0]), tuple(taken[n])) for n, q in quartiles.items()}
        return timings, clock.name

    def triangles(self) -> dict[str, int]:
        """Return the number of triangles that each pass sends to the rasteriser, by pass name; the device counts."""
        counted = {}
        self.frame.advance()
        for name, run in self.passes.items():
            query = self._device.context.query(primitives=True)
            with query:
                run()
            counted[name] = query.primitives
        return counted


@contextmanager
def rendering(device: Device, pipeline: Pipeline, scene: Scene, plan: Plan) -> Iterator[Rendering]:
    """Yield a pipeline that is ready to draw, and release its resources on the device at the end.

    Raises:
        LayoutError: the layout lacks what the pipeline needs, or has more targets than the device supports.
        FormatError: the device cannot render to a format.
        ShaderError: an encoding does not compile.
    """
    check(device, pipeline, plan, scene.is_metal_rough)
    with Frame(device, scene, pipeline, plan) as frame:
        yield Rendering(frame, {stage.name: built(frame, stage) for stage in pipeline.stages})


def check(device: Device, pipeline: Pipeline, plan: Plan, is_metal_rough: bool = False) -> None:
    """Raise LayoutError, with a one-line message, if a plan does not suit a pipeline, the materials or the device."""
    layout, light = plan.layout, plan.light_buffer
    if is_metal_rough:
        check_metal_rough(pipeline)
    components = layout.metal_rough_components if is_metal_rough else layout.components
    if missing := sorted(pipeline.needs - components):
        without = [other.name for other in PIPELINES.values() if other.needs and other.needs <= components]
        does = f"; --pipeline {','.join(without)} does not need it" if without else ""
        needed = ", ".join(missing)
        raise LayoutError(f"{pipeline.name} needs {needed}, which layout {layout.name} does not store{does}")
    if not pipeline.has_gbuffer:
        return
    if plan.light_targets not in pipeline.light_targets:
        known = " or ".join(map(str, pipeline.light_targets))
        raise LayoutError(f"{pipeline.name} has {known} light target{'s' * (known != '1')}, not {plan.light_targets}")
    if max(pipeline.light_targets) > 1 and plan.light_targets == 1 and not light.has_alpha:
        raise LayoutError(f"one light target needs an alpha channel, which {light.name} does not have")
    beside = int(pipeline.starts_light)
    if len(layout.targets) + beside > device.max_targets:
        more = ", plus a light buffer" if beside else ""
        raise LayoutError(
            f"layout {layout.name} has {len(layout.targets)} targets{more}; "
            f"{device.renderer} supports {device.max_targets}"
        )


def check_metal_rough(pipeline: Pipeline) -> None:
    """Raise LayoutError, with a one-line message, if a pipeline does not support metallic-roughness materials."""
    if pipeline.told.get("LIGHT_HOLDS") == TERMS:
        raise LayoutError(
            f"{pipeline.name} cannot be used with metallic-roughness materials: its light buffer stores no light "
            "weighted by Fresnel's term; "
            "use forward, forward_multipass, deferred or hybrid"
        )


def bytes_per_pixel(pipeline: Pipeline, plan: Plan) -> float:
    """Return the bytes per image pixel, over all samples, that a pipeline keeps: all resources that its passes write,
    except the image itself and resources with their own size in pixels. Each resource counts once, but with all its
    copies if the next frame reads it."""
    kept = (resource for resource in pipeline.resources.values() if resource != FINAL)
    return float(sum(resource.bytes_per_pixel(pipeline.planned(plan)) for resource in kept))
