"""The scenes there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..display import Display, measured_exposure
from .built_in import gloss, head, lake, objects, playground, ramps, room, studio
from .scene import Scene
from .setting import Setting

# How metal/rough scenes are shown: their lights are a hundred times as bright as their shadows.
FILMIC = "aces"


@dataclass(frozen=True)
class SceneMaker:
    """A scene.

    Attributes:
        name, title: what it is called, and what it shows.
        make: it, at a moment.
        frames: over how many moments a figure is averaged.
        exposure: in stops; None to have it measured, of a scene whose light nobody has set.
        is_metal_rough: whether its materials are metal/rough, which have no specular power.
        sides: width and height of the picture that it is; None where it can be drawn at any size.
    """

    name: str
    title: str
    make: Callable[[Setting], Scene]
    frames: int
    exposure: float | None = 0.0
    is_metal_rough: bool = False
    sides: tuple[int, int] | None = None

    @property
    def tone_mapping(self) -> str:
        """How its light beyond 1 is shown, one of TONE_MAPPINGS."""
        return FILMIC if self.is_metal_rough else "none"

    def within(self, size: tuple[int, int]) -> tuple[int, int]:
        """The size that it is drawn at where `size` is asked for: of a picture its own shape, in no more pixels."""
        if self.sides is None:
            return size
        share = min(1.0, (size[0] * size[1] / (self.sides[0] * self.sides[1])) ** 0.5)
        return max(1, round(self.sides[0] * share)), max(1, round(self.sides[1] * share))

    def display(self, linear: np.ndarray) -> Display:
        """How its images are shown; an exposure that nobody has set is measured of linear light, (..., 3)."""
        exposure = measured_exposure(linear.reshape(-1, 3)) if self.exposure is None else self.exposure
        return Display(exposure, self.tone_mapping)


SCENES: Mapping[str, SceneMaker] = MappingProxyType(
    {
        "playground": SceneMaker("playground", playground.TITLE, playground.lit_playground, playground.FRAMES),
        "objects": SceneMaker("objects", objects.TITLE, objects.objects, objects.FRAMES),
        "gloss": SceneMaker("gloss", gloss.TITLE, gloss.gloss, gloss.FRAMES),
        "studio": SceneMaker(
            "studio", studio.TITLE, studio.studio, studio.FRAMES, studio.EXPOSURE, is_metal_rough=True
        ),
        "ramps": SceneMaker("ramps", ramps.TITLE, ramps.ramps, ramps.FRAMES, ramps.EXPOSURE, is_metal_rough=True),
        "room": SceneMaker("room", room.TITLE, room.room, room.FRAMES),
        "head": SceneMaker("head", head.TITLE, head.head, head.FRAMES),
        "lake": SceneMaker("lake", lake.TITLE, lake.lake, lake.FRAMES),
    }
)
