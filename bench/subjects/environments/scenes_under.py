"""Scenes under a requested environment."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ....gbuffer.environment.environment import Environment
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting
from ...ground.output.errors import UsageError
from .environment_names import environment_named


def scenes_under(word: str | None, makers: Iterable[SceneMaker]) -> Iterator[SceneMaker]:
    """Yield scenes under the environment that a word names, with its sun as a light; unchanged if the word is None.

    Raises:
        UsageError: the environment is unknown, or a scene does not use the metallic-roughness workflow.
    """
    if word is None:
        yield from makers
        return
    around = environment_named(word)
    for maker in makers:
        if not maker.make(Setting(objects=1, lights=0)).is_metal_rough:
            raise UsageError(f"--environment: {maker.name} has no metallic-roughness materials to reflect it")
        yield replace(maker, make=Under(maker, around))


class Under:
    """Makes a scene under an environment."""

    def __init__(self, maker: SceneMaker, environment: Environment):
        self._maker, self._environment = maker, environment

    def __call__(self, setting: Setting) -> Scene:
        return self._maker.make(setting).under(self._environment)
