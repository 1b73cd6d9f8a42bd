"""The scenes there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from . import gloss, head, lake, objects, playground, room
from .scene import Scene
from .setting import Setting


@dataclass(frozen=True)
class SceneMaker:
    """A scene.

    Attributes:
        name, title: what it is called, and what it shows.
        make: it, at a moment.
        frames: over how many moments a figure is averaged.
        exposure: in stops; None to have it measured, of a scene whose light nobody has set.
    """

    name: str
    title: str
    make: Callable[[Setting], Scene]
    frames: int
    exposure: float | None = 0.0


SCENES: Mapping[str, SceneMaker] = MappingProxyType(
    {
        "playground": SceneMaker("playground", playground.TITLE, playground.lit_playground, playground.FRAMES),
        "objects": SceneMaker("objects", objects.TITLE, objects.objects, objects.FRAMES),
        "gloss": SceneMaker("gloss", gloss.TITLE, gloss.gloss, gloss.FRAMES),
        "room": SceneMaker("room", room.TITLE, room.room, room.FRAMES),
        "head": SceneMaker("head", head.TITLE, head.head, head.FRAMES),
        "lake": SceneMaker("lake", lake.TITLE, lake.lake, lake.FRAMES),
    }
)
