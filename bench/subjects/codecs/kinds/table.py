"""The kinds that users' own codes may be of, by their names in the catalogue."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from . import curve, depth, frame, light, motion
from .own import OwnKind

OWN: Mapping[str, OwnKind] = MappingProxyType(
    {one.KIND.kind.name: one.KIND for one in (motion, depth, curve, light, frame)}
)
