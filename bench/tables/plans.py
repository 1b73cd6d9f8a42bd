"""Settings for rendering frames: layouts with codecs in them, and plans that suit a pipeline."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TypeVar

from ...encodings.catalogue import LIGHT_BUFFERS
from ...encodings.codecs.codec import Codec
from ...gbuffer.frame.plan import LEAST_ROUGHNESS, Plan
from ...gbuffer.gl.device import Device
from ...gbuffer.layouts.layout import Layout
from ...gbuffer.layouts.presets import LAYOUTS
from ...gbuffer.layouts.words import LayoutError
from ...gbuffer.pipelines import Pipeline
from ...gbuffer.render import check
from ..ground.output.errors import by_reason
from ..subjects.codecs.names import check_twin

T = TypeVar("T")


def with_codecs(chosen: Iterable[Layout], codecs: Sequence[Codec], complaints: list[str]) -> list[Layout]:
    """Return each layout with every codec that fits in it; append to `complaints` why other codecs do not fit."""
    for encoding in dict.fromkeys(codec.encoding for codec in codecs):
        check_twin(encoding)
    complaints += by_reason((codec.name, codec.misfit) for codec in codecs if not codec.fits)
    layouts: list[Layout] = []
    for layout in chosen:
        for codec in (codec for codec in codecs if codec.fits):
            attempt(lambda layout=layout, codec=codec: layout.with_codec(codec), layouts, complaints)
    return layouts


def suited(
    device: Device, pipeline: Pipeline, plans: list[Plan], complaints: list[str], is_metal_rough: bool = False
) -> list[Plan]:
    """Return the plans that suit a pipeline, each once, with the settings that do not affect the pipeline at their
    defaults; append to `complaints` why other plans do not suit it.

    Args:
        is_metal_rough: whether the scene's materials use the metallic-roughness workflow.
    """
    suited_plans: dict[Plan, None] = {}
    for plan in plans:
        own = replace(plan, scale=plan.scale if pipeline.scaled else 1.0)
        if not is_metal_rough:
            own = replace(own, antialiased=True, least_roughness=LEAST_ROUGHNESS)
        if not pipeline.has_gbuffer:
            # Neither layouts nor light buffers reach it: one row for all of them.
            own = replace(own, layout=LAYOUTS["fp32"], light_buffer=LIGHT_BUFFERS["rgba32f"], light_targets=1)
        elif len(pipeline.light_targets) == 1:
            own = replace(own, light_targets=pipeline.light_targets[0])
        try:
            check(device, pipeline, own, is_metal_rough)
        except LayoutError as error:
            complaints.append(str(error))
        else:
            suited_plans[own] = None
    return list(suited_plans)


def attempt(make: Callable[[], T], usable: list[T], complaints: list[str]) -> None:
    """Append the result of `make` to `usable`, or the message of its LayoutError to `complaints`."""
    try:
        usable.append(make())
    except LayoutError as error:
        complaints.append(str(error))
