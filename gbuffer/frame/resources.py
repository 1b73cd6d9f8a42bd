"""Resources that the pipelines' own passes share, and the possible contents of a light buffer."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .resource import AS_MANY, DEPTH_STENCIL, SURFACES, Resource

SHADOW_SIZE = 1024

SHADOW_MAP = Resource("shadow_map", "shadows", (SHADOW_SIZE, SHADOW_SIZE))
GBUFFER = Resource("gbuffer", "the layout's", follows=SURFACES, samples=AS_MANY)
# Depth and stencil of the G-buffer; without one, of the image.
DEPTH = Resource("native_depth", DEPTH_STENCIL, follows=SURFACES, samples=AS_MANY)
# Not there where the layout keeps a depth of its own.
LINEAR_DEPTH = Resource("linear_depth", "linear depth", follows=SURFACES, samples=AS_MANY)
# What `gbuffer.glsl` reads.
SURFACE = (GBUFFER, LINEAR_DEPTH)
LIGHT = Resource("light_texels", "the light buffer's", follows=SURFACES, samples=AS_MANY)
# What light is added in where its code cannot be blended; not there where it can.
NEXT_LIGHT = Resource("next_light", "the light buffer's, where it is read", follows=SURFACES, samples=AS_MANY)
FINAL = Resource("final", "rgba32f", samples=AS_MANY, copies=2)
# Depth and stencil of the image where the G-buffer has a size of its own.
FINAL_DEPTH = Resource("final_depth", DEPTH_STENCIL, samples=AS_MANY, shares=DEPTH)

# Components of a layout that finished colour is made of.
SHADING = frozenset({"base_color.r", "base_color.g", "base_color.b", "f0.r", "f0.g", "f0.b", "power"})

# What LIGHT_HOLDS counts: light for a second geometry pass, colour that is finished, or colour of general materials and
# light of special ones.
TERMS, COLOURS, BY_KIND = range(3)
LIGHT_HOLDS: Mapping[str, int] = MappingProxyType({"TERMS": TERMS, "COLOURS": COLOURS, "BY_KIND": BY_KIND})
