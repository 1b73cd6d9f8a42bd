"""The volumes' sizes and resources, which follow from the settings, and the macros that describe them to shaders."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ...frame.resource import DEPTH_STENCIL, SURFACES, Resource
from .lpv_harmonics import CONSTANTS
from .lpv_packed import PACKED_CONSTANTS

CHANNELS = ("red", "green", "blue")
# What a codec does to an image is compared here: light that arrives from other surfaces, times 1 / pi.
INDIRECT = Resource("indirect", "rgba32f", follows=SURFACES)
# Half a cell, less a thousandth: a wall right between two planes of the lattice would else fall to either side of it
# by rounding, texel by texel. Walls at round numbers do lie there.
SHIFT = 0.5 - 2.0**-10
# Farther than this part of the far plane is no surface; a stored depth is off by less.
COVERED_SHARE = 0.999
# What volumes can be kept in, and in which format of texels.
FORMATS: Mapping[str, str] = MappingProxyType({"rgba32f": "rgba32f", "rgba16f": "rgba16f", "shared": "rgba8"})
# What VPLs and surfels can be added up in by blending. Packed codes do not add.
SUMS = ("rgba32f", "rgba16f")


@dataclass(frozen=True)
class Volumes:
    """The resources of `cascades` volumes of cells x cells x cells, stacked along z.

    Attributes:
        cells, cascades: number of cells along each side of a volume, and number of volumes.
        format: format of the volumes, a key of FORMATS.
        sums: format in which VPLs and surfels are added up, one of SUMS.
        texels: width and height of a reflective shadow map, in texels.
    """

    cells: int
    cascades: int
    format: str
    sums: str
    texels: int

    @property
    def corners(self) -> int:
        """The number of cell corners along an axis, at which blockers of light are stored."""
        return self.cells + 1

    @property
    def injected(self) -> tuple[Resource, ...]:
        """The injected light, before propagation, with slices side by side so that one draw adds to all slices."""
        return tuple(self._flat_resource(f"lpv_injected_{channel}", self.cells) for channel in CHANNELS)

    @property
    def blockers(self) -> Resource:
        """The blockers of light at the cells' corners, with slices side by side."""
        return self._flat_resource("lpv_blockers", self.corners)

    @property
    def wave(self) -> tuple[Resource, ...]:
        """The light that is being propagated, one volume per channel."""
        return tuple(self._volume_resource(f"lpv_wave_{channel}") for channel in CHANNELS)

    @property
    def light(self) -> tuple[Resource, ...]:
        """The sum over all steps, one volume per channel."""
        return tuple(self._volume_resource(f"lpv_light_{channel}") for channel in CHANNELS)

    @property
    def reflective(self) -> tuple[Resource, ...]:
        """The textures of a reflective shadow map: flux, normal and position. Each map replaces the previous one."""
        return tuple(self._map_resource(f"lpv_{what}", "rgba32f") for what in ("flux", "normal", "position"))

    @property
    def reflective_depth(self) -> Resource:
        """The depth and stencil attachment for drawing a reflective shadow map."""
        return self._map_resource("lpv_depth", DEPTH_STENCIL)

    def defines(self, cell: float) -> dict[str, object]:
        """Return the macros for the volumes' shaders; `cell` is the finest cascade's cell size in metres."""
        marks = {"SHIFT": SHIFT, "COVERED_SHARE": COVERED_SHARE}
        own = {"CELLS": self.cells, "CORNERS": self.corners, "CASCADES": self.cascades, "TEXELS": self.texels}
        packs = {"PACKS": int(self.format == "shared"), "CELL": float(cell)}
        return {**CONSTANTS, **PACKED_CONSTANTS, **marks, **own, **packs}

    def _map_resource(self, name: str, form: str) -> Resource:
        return Resource(name, form, (self.texels, self.texels))

    def _flat_resource(self, name: str, side: int) -> Resource:
        return Resource(name, self.sums, (side * side, side * self.cascades))

    def _volume_resource(self, name: str) -> Resource:
        size = (self.cells, self.cells)
        return Resource(name, FORMATS[self.format], size, copies=2, depth=self.cells * self.cascades)
