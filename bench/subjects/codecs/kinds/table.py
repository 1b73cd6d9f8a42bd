"""The kinds of users' own encodings. Kinds with words that other kinds' names also contain come last."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .....encodings.kinds import Kind
from . import curve, depth, frame, light, motion
from .own import OwnKind

OWN: Mapping[Kind, OwnKind] = MappingProxyType(
    {own.KIND.kind: own.KIND for own in (frame, motion, depth, curve, light)}
)
