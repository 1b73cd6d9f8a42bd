"""Options that say how users' files are read: they become a part of the files' names, which go everywhere.

Every run of pytest imports this module: what reads names is imported where it is needed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ...ground.options.option import Sources
from ...ground.output.errors import UsageError

# The options whose names may be users' files.
NAMED = ("encoding", "against", "codec", "depth", "light_buffer")
NO_FILE = "--{} is of users' shader files, and none is named; a layout has it in its file: mine.hlsl:{}=..."


def in_names(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values of options by name, those of Sources in the names of the files instead.

    Raises:
        UsageError: there is no such file, or a value cannot be.
    """
    given = {field.name: value for field in fields(Sources) if (value := values.get(field.name))}
    said = {name: "yes" if value is True else value for name, value in given.items()}
    if not said:
        return dict(values)
    from .words import with_settings

    if not names_files(values):
        option = next(iter(said))
        raise UsageError(NO_FILE.format(option.replace("_", "-"), option))
    named = {name: with_settings(value, **said) for name in NAMED if (value := values.get(name))}
    return {**values, **{field.name: field.default for field in fields(Sources) if field.name in said}, **named}


def names_files(values: Mapping[str, Any]) -> bool:
    """Whether a value of an option names a user's file."""
    from .words import names_a_users_file

    return any(names_a_users_file(str(values.get(name) or "")) for name in NAMED)


@dataclass(frozen=True, kw_only=True)
class SourceOptions(Sources):
    """Options of a table that measures users' files; the names have how they are read."""

    def __post_init__(self) -> None:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        for name, value in in_names(values).items():
            object.__setattr__(self, name, value)
