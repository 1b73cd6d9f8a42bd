"""The tables, in the order of a run and of its page. To add a table, add its folder and one line here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module

from .table import Table

NAMES = (
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
    "frames",
    "vectors",
    "curves",
    "sweep",
    "tune",
    "devices",
)


class Tables(Mapping[str, Table]):
    """The tables by name. A table is imported on access, so that a command imports only the tables it needs."""

    def __getitem__(self, name: str) -> Table:
        if name not in NAMES:
            raise KeyError(name)
        return import_module(f".{name}.table", __package__).TABLE

    def __contains__(self, name: object) -> bool:
        return name in NAMES

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return len(NAMES)


TABLES = Tables()
