"""The contract between passes: the resources that each pass reads and writes. Checked when a pipeline is created."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from .plan import Plan
from .resource import Resource
from .resources import COLOURS, GBUFFER, LIGHT

if TYPE_CHECKING:
    from .canvas import Canvas

Run = Callable[[], None]


class PipelineError(Exception):
    """Passes that do not fit together; the message is one line that names the pass and the resource."""


@dataclass(frozen=True, eq=False)
class Pass:
    """One pass over a frame.

    Attributes:
        name: its name in tables, unique in a pipeline.
        reads: resources that earlier passes have written, or that the previous frame has kept.
        writes: resources that later passes may read. Resources that the pass does not also read are cleared before it
            runs.
        build: function that compiles the pass for a canvas and returns the function to run for each frame. It is not
            called if none of the resources that the pass writes exist.
        after: for a pass of an effect: the passes that it may follow; it follows the last of these in the pipeline.
        tells: macros for itself and every later pass. An effect with macros lets later passes read what it writes.
        expects: macro values that the pass can work with; an earlier pass must have set one of them.
        needs: components that the pass requires in the G-buffer.
    """

    name: str
    reads: tuple[Resource, ...]
    writes: tuple[Resource, ...]
    build: Callable[[Canvas], Run]
    after: tuple[str, ...] = ()
    tells: Mapping[str, int] = field(default_factory=dict)
    expects: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    needs: frozenset[str] = frozenset()

    @property
    def begins(self) -> tuple[Resource, ...]:
        """Resources that the pass writes but does not read; they are cleared before it runs."""
        return tuple(resource for resource in self.writes if resource not in self.reads)

    @property
    def offers(self) -> tuple[Resource, ...]:
        """Resources that later passes may read without declaring them: all that the pass writes if it belongs to an
        effect and sets macros; otherwise empty."""
        return self.writes if self.after and self.tells else ()


@dataclass(frozen=True)
class Pipeline:
    """An ordered list of passes.

    Attributes:
        name, title, source: its name, its description and its origin.
        stages: the passes, in order.
        usual_layout: the layout with which it was published.

    Raises:
        PipelineError: the passes do not fit together.
    """

    name: str
    title: str
    source: str
    stages: tuple[Pass, ...]
    usual_layout: str = "hybrid"

    def __post_init__(self):
        for index, stage in enumerate(self.stages):
            reason = next(_misfits(stage, self.stages[:index], self.stages), None)
            if reason:
                raise PipelineError(f"pipeline {self.name}: pass {stage.name} {reason}")

    @cached_property
    def resources(self) -> Mapping[str, Resource]:
        """All resources that the pipeline's passes write, by name."""
        return {resource.name: resource for stage in self.stages for resource in stage.writes}

    @cached_property
    def told(self) -> Mapping[str, int]:
        """Values of all macros that the pipeline's passes set, by name."""
        return {name: value for stage in self.stages for name, value in stage.tells.items()}

    @property
    def needs(self) -> frozenset[str]:
        """Components that the pipeline requires in the G-buffer, besides the normal."""
        return frozenset().union(*(stage.needs for stage in self.stages))

    @property
    def has_gbuffer(self) -> bool:
        """Whether any pass writes the G-buffer, so that the layout makes a difference."""
        return GBUFFER.name in self.resources

    @property
    def light_targets(self) -> tuple[int, ...]:
        """Possible numbers of targets in the light buffer: (1,) if it holds finished colours, else (1, 2); empty
        without a light buffer."""
        if LIGHT.name not in self.resources:
            return ()
        return (1,) if self.told["LIGHT_HOLDS"] == COLOURS else (1, 2)

    @property
    def scaled(self) -> bool:
        """Whether the G-buffer and the light buffer may be smaller than the image."""
        return bool(self.told.get("FILTERS"))

    @property
    def starts_light(self) -> bool:
        """Whether one pass writes the G-buffer and, in one more target, the light buffer."""
        return any({GBUFFER, LIGHT} <= set(stage.writes) for stage in self.stages)

    def planned(self, plan: Plan) -> Plan:
        """Return the plan with `apart` set to this pipeline's `scaled`."""
        return replace(plan, apart=self.scaled)

    def upto(self, stage: Pass) -> tuple[Pass, ...]:
        """Return the passes before `stage`; all passes if the pipeline does not contain `stage`."""
        return self.stages[: self.stages.index(stage)] if stage in self.stages else self.stages

    def with_effect(self, passes: Iterable[Pass]) -> Pipeline:
        """Return the pipeline with an effect's passes, each after the pass that it names and any effect passes there.

        Raises:
            PipelineError: a pass to follow does not exist, or the passes do not fit together.
        """
        stages = list(self.stages)
        for stage in passes:
            stages.insert(_index_after(self.name, stage, stages), stage)
        return replace(self, stages=tuple(stages))


def _index_after(pipeline: str, render_pass: Pass, stages: list[Pass]) -> int:
    places = [index for index, stage in enumerate(stages) if stage.name in render_pass.after]
    if not places:
        known = ", ".join(stage.name for stage in stages)
        raise PipelineError(
            f"pipeline {pipeline}: pass {render_pass.name} must come after {' or '.join(render_pass.after)}; "
            f"known: {known}"
        )
    behind = (index for index in range(places[-1] + 1, len(stages)) if not stages[index].after)
    return next(behind, len(stages))


def _misfits(render_pass: Pass, earlier: Sequence[Pass], stages: Sequence[Pass]) -> Iterator[str]:
    """Yield each reason why a pass cannot follow `earlier` in a pipeline of `stages`, as a predicate such as "writes
    nothing"; nothing if the pass fits."""
    if render_pass.name in [other.name for other in earlier]:
        yield "has the same name as another pass"
    if not render_pass.writes:
        yield "writes nothing"
    for resource in (*render_pass.reads, *render_pass.writes):
        yield from _resource_misfits(resource, earlier)
    for resource in render_pass.reads:
        if resource.name not in _written(stages if resource.kept else earlier):
            yield f"reads {resource.name}, which no {'' if resource.kept else 'earlier '}pass writes"
        if taker := next((other for other in _written(earlier).values() if other.shares == resource), None):
            yield f"reads {resource.name}, which {taker.name} has replaced"
    yield from _macro_misfits(render_pass, {name: value for other in earlier for name, value in other.tells.items()})


def _written(stages: Sequence[Pass]) -> dict[str, Resource]:
    """Return the resources that passes write, by name."""
    return {resource.name: resource for stage in stages for resource in stage.writes}


def _resource_misfits(resource: Resource, earlier: Sequence[Pass]) -> Iterator[str]:
    """Yield each reason why a pass cannot use a resource, as a predicate of the pass ("has the resource NAME, which
    ..."): the resource is invalid, or differs from an earlier pass's resource of the same name."""
    if resource.misfit:
        yield f"has the resource {resource.name}, which {resource.misfit}"
    if _written(earlier).get(resource.name, resource) != resource:
        yield f"has a resource {resource.name} that differs from that of an earlier pass"


def _macro_misfits(render_pass: Pass, told: Mapping[str, int]) -> Iterator[str]:
    """Yield each reason why a pass cannot work with the macros of earlier passes, as a predicate.

    Args:
        told: the values of those macros, by name."""
    for macro, value in render_pass.tells.items():
        if told.get(macro, value) != value:
            yield f"defines {macro} as {value}, but an earlier pass defines it as {told[macro]}"
    for macro, values in render_pass.expects.items():
        if told.get(macro) not in values:
            yield f"expects {macro} {' or '.join(map(str, values))}, but has {told.get(macro, 'nothing')}"
