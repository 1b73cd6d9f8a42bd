"""Effects by name: `gtao`, or with settings `gtao:size=half:slices=4`."""

from __future__ import annotations

from collections.abc import Iterable

from ....gbuffer.effects.catalogue import EFFECTS
from ....gbuffer.effects.effect import ChosenEffect, EffectError, chosen
from ....gbuffer.frame.contract import Pipeline, PipelineError
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.scenes.scene import Scene
from ...ground.choose import choose
from ...ground.options.words import Names
from ...ground.output.errors import UsageError


def effects_named(names: Names) -> list[ChosenEffect]:
    """Return the effects with these names, each with its settings.

    Raises:
        UsageError: an effect or a setting is unknown, or a value is out of range.
    """
    effects: dict[str, ChosenEffect] = {}
    for word in map(str, names or ("",)):
        name, *settings = word.split(":")
        for known in choose("effect", filter(None, [name]), EFFECTS):
            effect = _chosen(known.name, word, settings)
            effects[effect.name] = effect
    return list(effects.values())


def name_of(effects: Iterable[ChosenEffect]) -> str | None:
    """Return the names of an image's effects, joined by commas; None without effects."""
    return ",".join(effect.name for effect in effects) or None


def pipeline_with(pipeline: Pipeline, effects: Iterable[ChosenEffect], complaints: list[str]) -> Pipeline | None:
    """Return a pipeline with the passes of effects added. If two effects produce the same result, or if an effect
    does not fit the pipeline, append a line to `complaints` and return None."""
    makers: dict[str, str] = {}
    for effect in effects:
        twin = makers.setdefault(effect.effect.result.name, effect.name)
        if twin != effect.name:
            complaints.append(f"{twin} and {effect.name} both produce {effect.effect.result.name}; name only one")
            return None
        try:
            pipeline = pipeline.with_effect(effect.passes())
        except PipelineError:
            others = ", ".join(name for name, other in PIPELINES.items() if _fits(other, effect))
            complaints.append(f"{effect.name} cannot be used in pipeline {pipeline.name}; use {others}")
            return None
    return pipeline


def _fits(pipeline: Pipeline, effect: ChosenEffect) -> bool:
    try:
        pipeline.with_effect(effect.passes())
    except PipelineError:
        return False
    return True


def lacking(effects: Iterable[ChosenEffect], name: str, scene: Scene) -> str | None:
    """Return in words the first effect that lacks an input in a scene, and why; None if no effect lacks any.

    Args:
        name: the scene's name in the message."""
    reasons = ((effect.name, effect.effect.lacks(scene)) for effect in effects)
    return next((f"{effect} on {name}: {why}" for effect, why in reasons if why), None)


def _chosen(name: str, word: str, settings: list[str]) -> ChosenEffect:
    given: dict[str, str] = {}
    for setting in settings:
        key, is_there, value = (part.strip() for part in setting.partition("="))
        if not is_there or not key or not value:
            raise UsageError(f"effect {word}: {setting!r} is not a setting; write it as name=value, after a colon")
        if key in given:
            raise UsageError(f"effect {word}: {key} is set twice")
        given[key] = value
    try:
        return chosen(EFFECTS[name], given)
    except EffectError as error:
        raise UsageError(str(error)) from None
