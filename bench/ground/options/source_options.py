"""Options for reading users' files. They become part of the files' names, which are passed on everywhere.

Every run of pytest imports this module; therefore modules that read names are imported only when needed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ..output.errors import UsageError
from ..user_files import is_a_users_file, with_settings
from .option import Sources

# The options whose names may be users' files.
NAMED = ("encoding", "against", "codec", "depth", "light_buffer")
NO_FILE = "--{} applies only to your own shader files; name one, or write mine.hlsl:{}=... in a layout"


def in_names(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return option values by name, with the values of Sources moved into the names of the files.

    Raises:
        UsageError: no file is named, or a value is invalid.
    """
    given = {field.name: value for field in fields(Sources) if (value := values.get(field.name))}
    settings = {
        name: value if isinstance(value, tuple) else ("yes" if value is True else value,)
        for name, value in given.items()
    }
    if not settings:
        return dict(values)
    if not names_files(values):
        option = next(iter(settings))
        raise UsageError(NO_FILE.format(option.replace("_", "-"), option))
    named = {name: with_settings(value, **settings) for name in NAMED if (value := values.get(name))}
    return {**values, **{field.name: field.default for field in fields(Sources) if field.name in settings}, **named}


def names_files(values: Mapping[str, Any]) -> bool:
    """Whether any option's value names a user's file."""
    return any(is_a_users_file(word) for name in NAMED for word in values.get(name) or ())


@dataclass(frozen=True, kw_only=True)
class SourceOptions(Sources):
    """Options of a table that measures users' files; the files' names include the settings for reading them."""

    def __post_init__(self) -> None:
        super().__post_init__()
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        for name, value in in_names(values).items():
            object.__setattr__(self, name, value)
