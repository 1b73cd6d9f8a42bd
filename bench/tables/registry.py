"""The tables, in the order of a run and of its page. Adding one is its folder, and one line here."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from .table import Table

FOLDERS = (
    "pick",
    "budget",
    "quality",
    "render",
    "mix",
    "maps",
    "cost",
    "roofline",
    "effects",
    "motion",
    "roughness",
    "lights",
    "depth",
    "tangent_frames",
    "vectors",
    "curves",
    "sweep",
    "tune",
    "devices",
)
TABLES: Mapping[str, Table] = MappingProxyType(
    {table.name: table for table in (import_module(f".{folder}.table", __package__).TABLE for folder in FOLDERS)}
)
