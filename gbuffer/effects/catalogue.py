"""The effects there are. Adding one is its pair of files in this folder, and one line here.

An effect's module holds PASSES; each names the pass that it follows. Effects do not import each other: what one writes
others read by its name, where the macro that it tells is defined. `Pipeline.with_effect` takes an effect's passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from ..frame.contract import Pass

NAMES: tuple[str, ...] = (
    # The name of an effect's module, in quotes.
)

EFFECTS: Mapping[str, tuple[Pass, ...]] = MappingProxyType(
    {name: import_module(f".{name}", __package__).PASSES for name in NAMES}
)
