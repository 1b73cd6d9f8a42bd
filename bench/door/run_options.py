"""The options of `run`: the tables, and what several of them take. Imports nothing heavy."""

from __future__ import annotations

from dataclasses import field, make_dataclass
from typing import Annotated, Any

from ..ground.options.option import Field, Option, Options, fields_of
from ..ground.options.words import Names
from ..tables.registry import TABLES


def _shared() -> dict[str, Field]:
    """The options that `run` takes, by their names in Python; of several tables' the first says what they are."""
    found: dict[str, Field] = {}
    for table in TABLES.values():
        for name, one in fields_of(table.options).items():
            if one.option.in_run:
                found.setdefault(name, one)
    return found


def _options_class() -> type:
    others = ", ".join(name for name, table in TABLES.items() if not table.in_all)
    said = f"{', '.join(TABLES)}; comma-separated, or all, which is all but {others}."
    tables = Annotated[Names, Option("--tables", said)]
    typed: list[tuple[str, Any, Any]] = [("tables", tables, field(default=("all",)))]
    for name, one in _shared().items():
        typed.append((name, Annotated[one.type | None, one.option], field(default=None)))
    return make_dataclass("RunOptions", typed, bases=(Options,), frozen=True, kw_only=True)


RunOptions = _options_class()
