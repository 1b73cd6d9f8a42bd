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
    """A scene and the settings with which it is shown.

    Attributes:
        name, title: its name and its description.
        make: function that returns the scene for a setting, such as a moment.
        frames: number of moments over which a figure is averaged.
        exposure: exposure in stops; None to measure it, for a scene without a given exposure.
        is_metal_rough: whether its materials are metallic-roughness, which have no specular power.
        sides: width and height of the image if the scene is an image; None if it can be drawn at any size.
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
        """The tone mapping for light above 1, one of TONE_MAPPINGS."""
        return FILMIC if self.is_metal_rough else "none"

    def within(self, size: tuple[int, int]) -> tuple[int, int]:
        """Return the size to draw at if `size` is requested: `size` itself or, for a scene that is an image, a size
        with the image's aspect ratio and no more pixels than `size` or the image has."""
        if self.sides is None:
            return size
        share = min(1.0, (size[0] * size[1] / (self.sides[0] * self.sides[1])) ** 0.5)
        return max(1, round(self.sides[0] * share)), max(1, round(self.sides[1] * share))

    def display(self, linear: np.ndarray) -> Display:
        """Return the `Display` of the scene's images: exposure and tone mapping. If `exposure` is None, measure it on
        linear light, (..., 3)."""
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
