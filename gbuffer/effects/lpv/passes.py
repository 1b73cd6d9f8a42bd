"""The passes of light propagation volumes: injection, propagation, lookup."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from ...frame.canvas import NEAREST, Canvas
from ...frame.contract import Pass, Run
from ...frame.resource import Resource
from ...frame.resources import SURFACE
from ...frame.scene_buffers import Sight
from ...gl.device import ADD, POINTS
from ...gl.handles import Program
from .cascades import Cascade, box_of, cascades_of, finest_cell, spot_sight, sun_sight
from .volumes import INDIRECT, Volumes


class Lattice:
    """The cascades of a frame: their sizes follow from the initial scene, their positions from the current view."""

    def __init__(self, canvas: Canvas, volumes: Volumes, extent: float):
        self._canvas, self._volumes, self.box = canvas, volumes, box_of(canvas.frame.scene)
        self.cell = finest_cell(self.box, extent, volumes.cells, volumes.cascades)

    @property
    def cascades(self) -> tuple[Cascade, ...]:
        """The cascades, the finest first."""
        view = self._canvas.frame.scene.view
        return cascades_of(view, self.box, self.cell, self._volumes.cells, self._volumes.cascades)

    def place(self, *programs: Program) -> None:
        """Set the uniform `origins` of programs to the cascades' origins in cells, the finest first."""
        first, *others = (cascade.origin for cascade in self.cascades)
        for program in programs:
            program["origins"] = [first, *others] if others else first


def inject(volumes: Volumes, extent: float, blocks: bool) -> Pass:
    """Return the pass that draws a reflective shadow map for each spot and, for a sun, for each cascade, and adds
    VPLs from it. If `blocks`, it also adds surfels, which block light, from these maps and the camera's G-buffer."""
    maps = (*volumes.reflective, volumes.reflective_depth)
    writes = (*maps, *volumes.injected, volumes.blockers)
    build = partial(Injection, volumes, extent, blocks)
    return Pass("lpv_inject", SURFACE, writes, build, after=("linear_depth",))


class Injection:
    """The injection pass, which draws the reflective shadow maps one by one and adds their texels to the volumes."""

    def __init__(self, volumes: Volumes, extent: float, blocks: bool, canvas: Canvas):
        self._canvas, self._volumes, self._blocks = canvas, volumes, blocks
        self._lattice = Lattice(canvas, volumes, extent)
        defines = volumes.defines(self._lattice.cell)
        _, *seen = volumes.reflective
        self._map = canvas.target(*volumes.reflective, depth=volumes.reflective_depth)
        self._seen, self._light = canvas.target(*seen), canvas.target(*volumes.injected)
        self._potential = canvas.target(volumes.blockers)
        self._surfaces = canvas.geometry("geometry.vert", "lpv_reflect.frag", **defines)
        self._camera = canvas.fullscreen("lpv_seen.frag", **defines)
        points = (("lpv_inject.vert", "lpv_inject.frag"), ("lpv_block.vert", "lpv_block.frag"))
        self._vpls, self._surfels = (canvas.frame.array(canvas.program(*pair, **defines), []) for pair in points)

    def __call__(self) -> None:
        self._lattice.place(self._vpls.program, self._surfels.program)
        if self._blocks:
            self._look()
            self._add_surfels(None, range(self._volumes.cascades))
        for light, view, cascades in self._views():
            self._reflect(light, view)
            self._add_vpls(view, cascades)
            if self._blocks:
                self._add_surfels(view, cascades)

    def _views(self) -> Iterator[tuple[int, Sight, range]]:
        """Yield the index of each sun and spot, its view, and the cascades that it lights from there: one cascade per
        view of a sun, all cascades for a spot."""
        number, all_of_them = self._volumes.texels, range(self._volumes.cascades)
        for index, light in enumerate(self._canvas.frame.scene_buffers.lights):
            if light.kind == "sun":
                for cascade_index, cascade in enumerate(self._lattice.cascades):
                    yield (
                        index,
                        sun_sight(light, cascade, self._lattice.box, number),
                        range(cascade_index, cascade_index + 1),
                    )
            elif light.kind == "spot":
                yield index, spot_sight(light), all_of_them

    def _reflect(self, light: int, view: Sight) -> None:
        for resource in (*self._volumes.reflective, self._volumes.reflective_depth):
            self._canvas.frame.clear(resource)
        self._map.use(view=view)
        self._canvas.device.state(NEAREST)
        self._surfaces.program["light"] = light
        self._canvas.prepare(self._surfaces.program)
        self._surfaces.draw("opaque")

    def _look(self) -> None:
        self._seen.use()
        self._canvas.device.state(None)
        self._canvas.prepare(self._camera.program)
        self._camera.render(vertices=3)

    def _add_vpls(self, view: Sight, cascades: range) -> None:
        self._light.use(view=view)
        flux, normal, position = map(self._canvas.textures, self._volumes.reflective)
        texels = {"flux_texels": flux, "normal_texels": normal, "position_texels": position}
        self._add(self._vpls, cascades, **texels)

    def _add_surfels(self, view: Sight | None, cascades: range) -> None:
        self._potential.use(view=view)
        _, normal, position = map(self._canvas.textures, self._volumes.reflective)
        self._add(self._surfels, cascades, normal_texels=normal, position_texels=position)

    def _add(self, points, cascades: range, **texels) -> None:
        """Draw a point per texel in each cascade, added to the cell that contains the texel."""
        self._canvas.device.state(None, ADD)
        self._canvas.prepare(points.program, **texels)
        for cascade in cascades:
            points.program["cascade"] = cascade
            points.render(mode=POINTS, vertices=self._volumes.texels**2)


def propagate(volumes: Volumes, iterations: int, amplifier: float) -> Pass:
    """Return the pass that adds up the injected light and `iterations` steps of its propagation."""
    build = partial(Propagation, volumes, iterations, amplifier)
    reads = (*volumes.injected, volumes.blockers)
    return Pass("lpv_propagate", reads, (*volumes.wave, *volumes.light), build, after=("linear_depth",))


class Propagation:
    """The propagation pass, which draws the volumes slice by slice: this needs neither compute shaders nor layered
    rendering."""

    def __init__(self, volumes: Volumes, iterations: int, amplifier: float, canvas: Canvas):
        self._canvas, self._iterations, self._slices = canvas, iterations, volumes.cells * volumes.cascades
        self._turns = (*volumes.wave, *volumes.light)
        self._target = canvas.target(*self._turns)
        # The first step is of light that has just left its surface, which does not block it.
        makes = (("lpv_begin.frag", 0), ("lpv_propagate.frag", 0), ("lpv_propagate.frag", int(amplifier > 0)))
        defines = {**volumes.defines(1.0), "AMPLIFIER": float(amplifier)}
        self._begin, self._first, self._further = (canvas.fullscreen(f, BLOCKS=b, **defines) for f, b in makes)
        for resource in self._turns:
            canvas.textures(resource)

    def __call__(self) -> None:
        self._draw(self._begin)
        for step in range(self._iterations):
            for resource in self._turns:
                self._canvas.swap(resource)
            self._draw(self._further if step else self._first)

    def _draw(self, covers) -> None:
        self._canvas.device.state(None)
        for slice_index in range(self._slices):
            self._target.use(at=slice_index)
            if slice_index == 0:
                self._canvas.prepare(covers.program)
            covers.program["slice"] = slice_index
            covers.render(vertices=3)


def lookup(volumes: Volumes, extent: float, blend: float) -> Pass:
    """Return the pass that writes the indirect light arriving at each pixel of the G-buffer."""
    build = partial(_lookup, volumes, extent, blend)
    reads: tuple[Resource, ...] = (*SURFACE, *volumes.light)
    return Pass("lpv_lookup", reads, (INDIRECT,), build, after=("linear_depth",), tells={"HAS_INDIRECT": 1})


def _lookup(volumes: Volumes, extent: float, blend: float, canvas: Canvas) -> Run:
    lattice, target = Lattice(canvas, volumes, extent), canvas.target(INDIRECT)
    # A thousandth of a cell is a hard edge.
    border = max(blend * volumes.cells, 0.001)
    covers = canvas.fullscreen("lpv_lookup.frag", BLEND_CELLS=border, **volumes.defines(lattice.cell))

    def run() -> None:
        target.use()
        canvas.device.state(None)
        lattice.place(covers.program)
        canvas.prepare(covers.program)
        covers.render(vertices=3)

    return run
