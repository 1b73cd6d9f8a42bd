"""Drawing tools for a pass: targets that it writes, programs compiled for the frame, and inputs bound by name."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..gl.handles import Program, Query, VertexArray
from .contract import Pass, PipelineError, Run
from .frame import Frame
from .meshes import Geometry
from .resource import Resource
from .scene_buffers import Sight

# Of surfaces that meet in one depth, as the two faces of a silhouette do, the first wins: passes that write the depth
# keep it, passes over that depth change each sample once. Every pass leaves the stencil at 0.
NEAREST, AGAIN = "<", "<="
# What covers the target lies at the far plane: it is in front of nothing but the background.
COVERED = ">"


# What the sampler of targets of whole numbers ends in.
WORDS = "_words"


class Canvas:
    """A frame as one pass sees it.

    Attributes:
        frame, device, plan: the frame, its device and its plan.
        told: macros that this pass and earlier passes set.

    Raises:
        PipelineError: the pass uses a resource that it does not declare.
    """

    def __init__(self, frame: Frame, render_pass: Pass):
        self.frame, self.device, self.plan, self._pass = frame, frame.device, frame.plan, render_pass
        earlier = frame.pipeline.upto(render_pass)
        self.told = {name: value for stage in (*earlier, render_pass) for name, value in stage.tells.items()}
        offered = {resource for stage in earlier for resource in stage.offers}
        self._samplers = _samplers((*render_pass.reads, *offered), render_pass.writes)
        self._size, self._view = frame.plan.size, None

    def begin(self) -> None:
        """Clear the resources that the pass writes but does not read."""
        for resource in self._pass.begins:
            self.frame.clear(resource)

    def textures(self, resource: Resource, copy: int = 0) -> list[Any]:
        """Return a resource's textures in the current copy, or `copy` copies before it; [] if the plan has none."""
        return self.frame.textures(self._declared_resource(resource, (*self._pass.reads, *self._pass.writes)), copy)

    def swap(self, resource: Resource) -> None:
        """Write to the next copy from now on; the current copy becomes the previous copy."""
        self.frame.held(self._declared_resource(resource, self._pass.writes)).move_on()

    def target(self, *colours: Resource, depth: Resource | None = None, most: int | None = None) -> Target:
        """Return the target to draw into.

        Args:
            colours: resources that the pass writes, in the order of the shader's outputs.
            depth: depth and stencil to test against; written if the pass writes it.
            most: maximum number of colour textures; None for all.
        """
        for resource in colours:
            self._declared_resource(resource, self._pass.writes)
        if depth:
            self._declared_resource(depth, (*self._pass.reads, *self._pass.writes))
        return Target(self, colours, depth, most, depth in self._pass.writes)

    def at(self, size: tuple[int, int], view: Sight | None) -> None:
        """Set the target size and the view for the programs that follow; a view of None is the scene's own camera."""
        self._size, self._view = size, view

    def program(self, vertex: str | Path, fragment: str | Path, **defines: object) -> Program:
        """Return a program of a vertex and a fragment shader, compiled for the frame's layout with the macros in
        `told` and `defines`. Raises ShaderError, and PipelineError if it samples a resource that the pass does not
        read."""
        program = self.frame.program(vertex, fragment, **{**self.told, **defines})
        for name in program:
            if (
                name.removesuffix("_before").removesuffix(WORDS) in self.frame.pipeline.resources
                and name.removesuffix(WORDS) not in self._samplers
            ):
                raise PipelineError(f"pass {self._pass.name} samples {name}, which it does not read")
        return program

    def fullscreen(self, fragment: str | Path, **defines: object) -> VertexArray:
        """Return a vertex array that runs a fragment shader over a whole target: `render(vertices=3)`."""
        return self.frame.array(self.program("fullscreen.vert", fragment, **defines), [])

    def geometry(self, vertex: str | Path, fragment: str | Path, **defines: object) -> Geometry:
        """Compile a pair of shaders as `program` does; return an object that draws the scene's meshes with them."""
        return Geometry(self.frame, self.program(vertex, fragment, **defines))

    def over(
        self,
        fragment: str | Path,
        *colours: Resource,
        depth: Resource | None = None,
        blend: tuple[int, int] | None = None,
        **defines: object,
    ) -> Run:
        """Return a function that runs a shader over whole targets, or over covered pixels if `depth` is given."""
        target, covers = self.target(*colours, depth=depth), self.fullscreen(fragment, **defines)

        return lambda: self.cover(target, covers, blend)

    def cover(self, target: Target, covers: VertexArray, blend: tuple[int, int] | None = None) -> None:
        """Run what `fullscreen` returned over a target, over covered pixels if the target has a depth."""
        target.use()
        self.device.state(COVERED if target.depth else None, blend)
        self.prepare(covers.program)
        covers.render(vertices=3)

    def prepare(self, program: Program, **textures: Any) -> None:
        """Bind the inputs of a draw: the frame, the scene, tables and, by name, the resources that the pass reads."""
        read = {
            name: self.frame.textures(*source) for name, source in self._samplers.items() if _is_read(name, program)
        }
        there = {name: several for name, several in read.items() if several}
        self.frame.bind(program, self._size, self._view, {**there, **textures})

    def _declared_resource(self, resource: Resource, known: tuple[Resource, ...]) -> Resource:
        if resource not in known:
            raise PipelineError(f"pass {self._pass.name} uses {resource.name}, which it does not declare")
        return resource


def _is_read(name: str, program: Program) -> bool:
    """Whether a program samples the resource `name`; integer targets have a separate sampler."""
    return name in program or f"{name}{WORDS}" in program


def _samplers(reads: tuple[Resource, ...], writes: tuple[Resource, ...]) -> dict[str, tuple[Resource, int]]:
    """Return the resource and the copy for each sampler name: the current copy for a resource's own name and, for
    resources with several copies, the previous copy for the name with `_before`."""
    samplers = {resource.name: (resource, 0) for resource in reads}
    return samplers | {f"{r.name}_before": (r, 1) for r in (*reads, *writes) if r.copies > 1}


@contextmanager
def counted(context: Any, queries: list[Query] | None) -> Iterator[None]:
    """Count the samples drawn, with a new query that is added to `queries`; do nothing if `queries` is None."""
    if queries is None:
        yield
        return
    queries.append(context.query(samples=True))
    with queries[-1]:
        yield


@dataclass(frozen=True)
class Target:
    """Textures to draw into, looked up at each use because the current copy changes."""

    canvas: Canvas
    colours: tuple[Resource, ...]
    depth: Resource | None
    most: int | None
    writes_depth: bool

    def use(self, view: Sight | None = None, at: int | None = None) -> None:
        """Bind the target for the draws that follow.

        Args:
            view: view to draw from; the scene's camera if None.
            at: index of the slice of volumes to draw into; all slices, by `gl_Layer`, if None.
        """
        frame = self.canvas.frame
        colours = [texture for resource in self.colours for texture in frame.textures(resource)]
        framebuffer = frame.framebuffer(colours[: self.most], self.depth, self.writes_depth, at)
        framebuffer.use()
        self.canvas.at(framebuffer.size, view)


@dataclass(frozen=True)
class Built:
    """A pass compiled for a frame: its canvas and the function to run."""

    canvas: Canvas
    run: Run

    def __call__(self) -> None:
        self.canvas.begin()
        self.run()


def built(frame: Frame, render_pass: Pass) -> Run:
    """Return a pass compiled for a frame; it does nothing if none of the resources that it writes exist.

    Raises:
        PipelineError, ShaderError, FormatError: the pass cannot be built.
    """
    if not any(resource.texels(frame.plan) for resource in render_pass.writes):
        return lambda: None
    canvas = Canvas(frame, render_pass)
    return Built(canvas, render_pass.build(canvas))
