"""The tables, in the order of a run and of its page. Adding one is its folder, and one line here."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from .table import Table

FOLDERS = (
    "pick",
    "quality",
    "render",
    "mix",
    "maps",
    "cost",
    "roofline",
    "effects",
    "motion",
    "lights",
    "depth",
    "tangent_frames",
    "vectors",
    "sweep",
    "tune",
    "published",
    "devices",
)
TABLES: Mapping[str, Table] = MappingProxyType(
    {table.name: table for table in (import_module(f".{folder}.table", __package__).TABLE for folder in FOLDERS)}
)


def table_of_run(name: str) -> Table | None:
    """The table that a run calls so, whatever version wrote it; None where this version has none."""
    return next((table for table in TABLES.values() if name in (table.name, *table.old_names)), None)
