"""Layouts as they are named: presets, or TOML files."""

from __future__ import annotations

from pathlib import Path

from ...gbuffer.layouts.layout import Layout, read_layout
from ...gbuffer.layouts.presets import LAYOUTS
from ...gbuffer.layouts.words import LayoutError
from ..output.errors import UsageError, pick


def layouts_named(names: str) -> list[Layout]:
    """The layouts that comma-separated names stand for.

    Raises:
        UsageError: an unknown name, or a file that is not a layout.
    """
    words = dict.fromkeys(name.strip() for name in names.split(","))
    known = {**LAYOUTS, **{name: _read(Path(name)) for name in words if name.endswith(".toml")}}
    chosen = pick("layout", names, known) if "all" not in words else list(known.values())
    called = [layout.name for layout in chosen]
    for name in called:
        if called.count(name) > 1:
            raise UsageError(f"two layouts are called {name}, which is a file's name without .toml; rename one")
    return chosen


def _read(path: Path) -> Layout:
    try:
        return read_layout(path)
    except LayoutError as error:
        raise UsageError(str(error)) from error
