"""The passes of water: wave maps, caustics, mirror image, depth behind the water, surface and overlay on the
image."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ...frame.canvas import NEAREST, Canvas
from ...frame.contract import Pass, Run
from ...frame.resources import DEPTH, FINAL, SHADOW_MAP
from ...gl.device import ADD
from ...gl.handles import Program, VertexArray
from ...passes.forward_surfaces import ForwardSurfaces
from ...scenes.scene import Water
from .grid import Grid, centre_under, reach
from .mirror import MirrorSight, mirrored_view
from .resources import BEHIND, CELLS, CONSTANTS, MARGIN, MIRROR, MIRROR_DEPTH, WATER, Maps
from .water_waves import WAVES, Waves, shortest, waves_of

# Where the image of opaque surfaces is finished: the last of these that a pipeline has.
AFTER = ("screen", "material", "forward", "lights")


@dataclass(frozen=True)
class Look:
    """Settings that the passes share.

    Attributes:
        maps: the wave maps.
        seed: seed of the waves' random numbers.
        strength: factor on the slope of the waves.
        grid: the grid to draw.
        defines: macros for the shaders.
    """

    maps: Maps
    seed: int
    strength: float
    grid: Grid
    defines: dict[str, object] = field(default_factory=dict)

    def waves(self, canvas: Canvas) -> Waves:
        """Return the waves of the scene's water at its moment. Raises ValueError if the scene has no water."""
        return waves_of(self.water(canvas), self.maps.octaves, self.seed, self.strength)

    @staticmethod
    def water(canvas: Canvas) -> Water:
        """Return the scene's water. Raises ValueError if it has none."""
        if canvas.frame.scene.water is None:
            raise ValueError("it has no water")
        return canvas.frame.scene.water

    def place(self, canvas: Canvas, program: Program) -> None:
        """Set the uniforms of `water_map.glsl` that depend on the scene."""
        water = self.water(canvas)
        least = shortest(water.patch, self.maps.octaves)
        tell(program, patch_size=water.patch, shortest=least, level=water.level)


def tell(program: Program, **values: object) -> None:
    """Set a program's uniforms by name; skip names that the compiled program does not have."""
    for name, value in values.items():
        if name in program:
            program[name] = value


def passes(look: Look) -> tuple[Pass, ...]:
    """Return all passes, in order."""
    maps = look.maps
    sheets = (maps.heights, maps.bends)
    reads = (*sheets, maps.caustics, MIRROR, MIRROR_DEPTH, BEHIND, FINAL, DEPTH, SHADOW_MAP)
    return (
        Pass("water_waves", (), sheets, partial(WaveMaps, look), AFTER),
        Pass("water_caustics", sheets, (maps.caustics,), partial(_caustics, look), AFTER),
        Pass("water_mirror", (SHADOW_MAP,), (MIRROR, MIRROR_DEPTH), _mirror, AFTER),
        Pass("water_behind", (DEPTH,), (BEHIND,), lambda canvas: canvas.over("water_behind.frag", BEHIND), AFTER),
        Pass("water_surface", reads, (WATER, DEPTH), partial(Surface, look), AFTER),
        Pass("water_over", (WATER, FINAL), (FINAL,), lambda canvas: canvas.over("water_over.frag", FINAL), AFTER),
    )


class WaveMaps:
    """The pass that sums the waves, slice by slice; each slice leaves out one more octave of the shortest waves."""

    def __init__(self, look: Look, canvas: Canvas):
        self._look, self._canvas = look, canvas
        self._target = canvas.target(look.maps.heights, look.maps.bends)
        self._sum = canvas.fullscreen("water_waves.frag", **look.defines)

    def __call__(self) -> None:
        waves, program, octaves = self._look.waves(self._canvas), self._sum.program, self._look.maps.octaves
        self._canvas.device.state(None)
        tell(program, waves=[tuple(row) for row in waves.table.tolist()])
        self._look.place(self._canvas, program)
        for slice_ in range(octaves):
            self._target.use(at=slice_)
            if slice_ == 0:
                self._canvas.prepare(program)
            program["count"] = WAVES * (octaves - slice_)
            self._sum.render(vertices=3)


def _caustics(look: Look, canvas: Canvas) -> Run:
    """Return a function that adds up sunlight at each slice's depth, triangle by triangle, if there is a sun."""
    target = canvas.target(look.maps.caustics)
    program = canvas.program("water_caustics.vert", "water_caustics.frag", **look.defines)
    lattice, corners = canvas.frame.array(program, []), 6 * (CELLS + 2 * MARGIN) ** 2

    def run() -> None:
        sun = canvas.frame.scene.sun
        if sun is None:
            return
        canvas.device.state(None, ADD)
        look.place(canvas, program)
        tell(program, sun=sun.direction)
        for slice_ in range(CONSTANTS["CAUSTIC_SLICES"]):
            target.use(at=slice_)
            if slice_ == 0:
                canvas.prepare(program)
            program["depth"] = slice_ * CONSTANTS["CAUSTIC_STEP"]
            lattice.render(vertices=corners)

    return run


def _mirror_sight(canvas: Canvas) -> MirrorSight:
    level = Look.water(canvas).level
    return MirrorSight(mirrored_view(canvas.frame.scene.view, level), level)


def _mirror(canvas: Canvas) -> Run:
    """Return a function that draws the opaque surfaces above the water, with all lights, from the mirrored camera."""
    target = canvas.target(MIRROR, depth=MIRROR_DEPTH)
    surfaces = ForwardSurfaces(canvas, bool(canvas.frame.scene_buffers.first_lamp))

    def run() -> None:
        target.use(view=_mirror_sight(canvas))
        canvas.device.state(NEAREST)
        surfaces.prepare(base=1.0)
        surfaces.draw("opaque", *surfaces.lamps)

    return run


class Surface:
    """The pass that draws the grid, with a depth test, so that waves hide the waves behind them."""

    def __init__(self, look: Look, canvas: Canvas):
        self._look, self._canvas, frame = look, canvas, canvas.frame
        self._target = canvas.target(WATER, depth=DEPTH)
        by_sun = {"LIT_BY_SUN": int(bool(frame.scene_buffers.first_lamp)), "SPOKES": look.grid.spokes}
        self._program = canvas.program("water_surface.vert", "water_surface.frag", **look.defines, **by_sun)
        self._grid = self._uploaded_grid(look.grid)

    def _uploaded_grid(self, grid: Grid) -> VertexArray:
        frame = self._canvas.frame
        own = (
            frame.device.owned(frame.stack, frame.context.buffer(d.tobytes())) for d in (grid.vertices, grid.triangles)
        )
        vertices, triangles = own
        return frame.array(self._program, [(vertices, "3f", "in_ring")], triangles)

    def __call__(self) -> None:
        self._target.use()
        self._canvas.device.state(NEAREST)
        self._canvas.prepare(self._program)
        self._look.place(self._canvas, self._program)
        self._tell_scene()
        self._grid.render()

    def _tell_scene(self) -> None:
        canvas, program = self._canvas, self._program
        scene, water, waves = canvas.frame.scene, self._look.water(canvas), self._look.waves(canvas)
        aspect = canvas.plan.size[0] / canvas.plan.size[1]
        outer, to_view = reach(scene.view, aspect), np.linalg.inv(_mirror_sight(canvas).projection(aspect))
        tell(program, centre=centre_under(scene.view), curve=self._look.grid.curve(outer))
        tell(program, deep=water.deep, crests=water.crests, extinction=water.extinction)
        tell(
            program,
            deviation=waves.deviation,
            sun_drift=sun_drift(scene.sun.direction) if scene.sun else (0.0, 0.0, 0.0),
        )
        tell(program, mirror_to_view=tuple(to_view.T.ravel()), slopes=tuple(waves.slopes.tolist()))


def sun_drift(direction: tuple[float, float, float]) -> tuple[float, float, float]:
    """Return the world-space shift of refracted sunlight, (x, 0, z), per metre of depth under still water."""
    # Snell: the part along the surface shrinks by the index.
    x, z = direction[0] / CONSTANTS["INDEX"], direction[2] / CONSTANTS["INDEX"]
    down = float(np.sqrt(1 - x * x - z * z))
    return x / down, 0.0, z / down
