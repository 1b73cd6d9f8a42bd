"""The catalogue of effects. To add an effect, add its files to this folder and its name to NAMES.

An effect's module holds EFFECT; each of its passes names the pass that it follows. Effects do not import each other:
an effect reads another effect's resource by name, if the macro that belongs to the resource is defined.

The pipelines' own passes read these resources of effects, if the macro next to the name is defined:
    visibility      HAS_VISIBILITY    the fraction of ambient light that arrives at a pixel, in x
    indirect        HAS_INDIRECT      light that arrives from other surfaces, times 1 / pi
    scattered       HAS_SCATTERED     diffuse light of skin after scattering, and the skin's depth; 0 elsewhere
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
    "denoise",
)

EFFECTS: Mapping[str, Effect] = MappingProxyType(
    {name: import_module(f".{name}", __package__).EFFECT for name in NAMES}
)
