"""The built-in environments, which are computed without a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import numpy as np

from . import bright_edges, sky, studio
from .environment import Environment


@dataclass(frozen=True)
class EnvironmentMaker:
    """An environment that is computed from a formula.

    Attributes:
        name, title: its name and its description.
        radiance: function that returns its image, (height, 2 height, 3), float32.
        has_sun: whether it contains a sun, which scenes use as a light.
    """

    name: str
    title: str
    radiance: Callable[[], np.ndarray]
    has_sun: bool = False

    def make(self) -> Environment:
        """Return the environment: always the same object, so that a device can keep its levels."""
        return _made(self)


@cache
def _made(maker: EnvironmentMaker) -> Environment:
    return Environment(maker.name, maker.radiance())


ENVIRONMENTS: Mapping[str, EnvironmentMaker] = MappingProxyType(
    {
        "studio": EnvironmentMaker("studio", studio.TITLE, studio.studio),
        "sky": EnvironmentMaker("sky", sky.TITLE, sky.sky, has_sun=True),
        "strips": EnvironmentMaker("strips", bright_edges.STRIPS, bright_edges.strips),
        "lamp": EnvironmentMaker("lamp", bright_edges.LAMP, bright_edges.lamp),
    }
)
