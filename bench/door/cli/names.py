"""Names for a shell to complete."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

# By option, what `normalbench list` calls them, and the kind of row that has them.
NAMES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "encoding": ("encodings", "encoding"),
        "against": ("encodings", "encoding"),
        "storage": ("storages", "storage"),
        "normals": ("normals", "normals"),
        "layout": ("layouts", "layout"),
        "pipeline": ("pipelines", "pipeline"),
        "effect": ("effects", "effect"),
        "effects": ("effects", "effect"),
        "scene": ("scenes", "scene"),
        "light_buffer": ("lights", "light buffer"),
        "depth": ("depths", "depth"),
    }
)


def completion_of(option: str) -> Callable[[str], list[str]]:
    """Return a function that completes the last of comma-separated names of an option."""
    what, kind = NAMES[option]

    def complete(incomplete: str) -> list[str]:
        from ...subjects.names.listing import listing

        before, comma, begun = incomplete.rpartition(",")
        names = [str(row["name"]) for row in listing((what,)) if row["kind"] == kind]
        return [f"{before}{comma}{name}" for name in names if name.startswith(begun)]

    return complete
