"""The effects there are. Adding one is its pair of files in this folder, and one line here.

An effect's module holds EFFECT; each of its passes names the pass that it follows. Effects do not import each other:
what one writes others read by its name, where the macro that it tells is defined.

What the pipelines' own passes read of effects, where the macro next to it is told:
    visibility      HAS_VISIBILITY    the share of ambient light that arrives at a pixel, in x
    indirect        HAS_INDIRECT      light that arrives from other surfaces, times 1 / pi
    scattered       HAS_SCATTERED     diffuse light of skin after it went through it, and its depth; 0 elsewhere
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from .effect import Effect

NAMES: tuple[str, ...] = (
    "ssao",
    "hbao",
    "sao",
    "gtao",
    "lpv",
    "subsurface",
    "water",
    "ssr",
)

EFFECTS: Mapping[str, Effect] = MappingProxyType(
    {name: import_module(f".{name}", __package__).EFFECT for name in NAMES}
)
