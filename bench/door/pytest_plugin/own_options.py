"""The plugin's own options on pytest's command line. Imports nothing heavy."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from ...ground.options.option import Field, fields_of
from ...tables.registry import TABLES

if TYPE_CHECKING:
    from .session import Session  # noqa: F401 # named in a text

REQUIRE_GL, BASELINE, WRITE_BASELINE = "require_gl", "baseline", "write_baseline"
SESSION = pytest.StashKey["Session"]()


def mirrored() -> dict[str, list[Field]]:
    """Return the options of all tables: for each name a list of fields, because several tables may have the same
    option."""
    options: dict[str, list[Field]] = {}
    for table in TABLES.values():
        for name, field in fields_of(table.options).items():
            options.setdefault(name, []).append(field)
    return options


def flag(name: str) -> str:
    """Return an option's flag on pytest's command line, such as --normalbench-write-baseline for `write_baseline`."""
    return f"--{destination(name)}".replace("_", "-")


def destination(name: str) -> str:
    """Return the name under which pytest stores an option, such as normalbench_write_baseline for
    `write_baseline`."""
    return f"normalbench_{name}"


def baseline_path(config: pytest.Config) -> Path | None:
    """Return the path of the file that rows are compared with; None if no file is named."""
    named = config.getoption(destination(BASELINE))
    return config.invocation_params.dir / named if named else None
