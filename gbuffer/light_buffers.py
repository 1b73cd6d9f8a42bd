"""Light buffers: the format that light is added up in, and the most it holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ..encodings.storage import Storage
from .formats import FORMATS


@dataclass(frozen=True)
class LightBuffer:
    """A light buffer's code: linear, added up by the blending hardware.

    Attributes:
        name: of the format as well.
        title: what a reader calls it.
        range: what a fixed-point format's 1 stands for; 1 for floats.
    """

    name: str
    title: str
    range: float

    @property
    def storage(self) -> Storage:
        return FORMATS[self.name]

    @property
    def has_alpha(self) -> bool:
        """Whether one target can hold the specular light beside the diffuse."""
        return self.storage.channels == 4


LIGHT_BUFFERS: Mapping[str, LightBuffer] = MappingProxyType(
    {
        "rgba32f": LightBuffer("rgba32f", "RGBA32F: the reference", 1.0),
        "rgba16f": LightBuffer("rgba16f", "RGBA16F", 1.0),
        "rgba8": LightBuffer("rgba8", "RGBA8, linear, scaled to [0, 2] (seed 003)", 2.0),
        "r11g11b10f": LightBuffer("r11g11b10f", "R11F G11F B10F, no alpha: two targets only", 1.0),
    }
)
