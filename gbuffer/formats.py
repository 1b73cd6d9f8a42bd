"""Render target formats beyond those that normals are measured in."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ..encodings.storage import STORAGES, Storage

R32F = Storage("r32f", "R32F", "float", (32,), 0x822E)

FORMATS: Mapping[str, Storage] = MappingProxyType(
    {
        **STORAGES,
        "r8": Storage("r8", "R8", "unorm", (8,), 0x8229),
        "r32f": R32F,
        "r11g11b10f": Storage("r11g11b10f", "R11F G11F B10F", "float", (11, 11, 10), 0x8C3A),
    }
)
