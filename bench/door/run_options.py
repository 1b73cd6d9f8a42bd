"""The options of `run`: the tables, and options of the tables themselves. Imports nothing heavy."""

from __future__ import annotations

from dataclasses import field, make_dataclass
from typing import Annotated, Any

from ..ground.options.option import Field, Option, Options, fields_of
from ..ground.options.words import Names
from ..tables.registry import TABLES


def _shared() -> dict[str, Field]:
    """Return the options that `run` takes, by Python name; if several tables have an option, the first defines it."""
    options: dict[str, Field] = {}
    for table in TABLES.values():
        for name, option_field in fields_of(table.options).items():
            if option_field.option.in_run:
                options.setdefault(name, option_field)
    return options


def _options_class() -> type:
    others = ", ".join(name for name, table in TABLES.items() if not table.in_all)
    help_text = f"Tables to measure, comma-separated: {', '.join(TABLES)}; or all, which leaves out {others}."
    tables = Annotated[Names, Option("--tables", help_text)]
    typed: list[tuple[str, Any, Any]] = [("tables", tables, field(default=("all",)))]
    for name, option_field in _shared().items():
        typed.append((name, Annotated[option_field.type | None, option_field.option], field(default=None)))
    return make_dataclass("RunOptions", typed, bases=(Options,), frozen=True, kw_only=True)


RunOptions = _options_class()
