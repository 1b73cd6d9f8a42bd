"""Lookup of values by their names, as people type them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from .options.words import Given, Word
from .output.errors import UsageError
from .spelling import meant, spelled

T = TypeVar("T")
# Behind the name of a mesh file: mesh.glb#vertices is the normals of its vertices.
PART, VERTICES = "#", "vertices"


def choose(what: str, names: Iterable[Word], known: Mapping[str, T]) -> list[T]:
    """Return the values with these names, in any accepted spelling; for "all", every known value. The caller's own
    values are returned unchanged.

    Raises:
        UsageError: an unknown name; the message suggests a similar name, and lists the known names.
    """
    asked = list(names)
    if not asked:
        raise UsageError(f"no {what} named; known: all, {', '.join(known)}")
    known = {**known, **{word.name: word.value for word in asked if isinstance(word, Given)}}
    keys = {word: spelled(what, word, known) for word in map(str, asked) if word != "all"}
    unknown = [word for word, key in keys.items() if key is None]
    if unknown:
        raise unknown_name(what, unknown, known, f"all, {', '.join(known)}")
    chosen = known if "all" in asked else dict.fromkeys(key for key in keys.values() if key is not None)
    return [known[name] for name in chosen]


def choose_one(what: str, name: str, known: Collection[str]) -> str:
    """Return the known name that matches a word in any accepted spelling. Raises UsageError for an unknown name, and
    for several names."""
    key = spelled(what, name.strip(), known)
    if key is None and "," in name:
        raise UsageError(f"one {what} at a time, not {name}; known: {', '.join(known)}")
    if key is None:
        raise unknown_name(what, [name], known)
    return key


def unknown_name(what: str, names: Iterable[str], known: Collection[str], listed: str = "") -> UsageError:
    """Return the error for unknown names, with similar names as suggestions.

    Args:
        listed: text that lists what is known; empty to list the names in `known`.
    """
    listed = listed or ", ".join(known)
    guess = "".join(f" {hint}" for name in names if (hint := meant(name, known, what)))
    return UsageError(f"unknown {what} {quoted(names)};{guess} known: {listed}")


def choose_or_read(
    what: str, names: Iterable[Word], known: Mapping[str, T], endings: Collection[str], read: Callable[[Path], T]
) -> list[T]:
    """Return the values with these names, and the contents of files, which are recognised by their extensions.

    Raises:
        UsageError: an unknown name, or two files with the same name, whose rows could not be told apart; also errors
            of `read`.
    """
    words = list(names)
    files = [Path(word) for word in words if isinstance(word, str) and Path(word).suffix.lower() in endings]
    called = [file.name for file in files]
    twice = [name for name in called if called.count(name) > 1]
    if twice:
        raise UsageError(f"two files have the same name, {twice[0]}, so their rows could not be told apart; rename one")
    others = [word for word in words if Path(str(word)).suffix.lower() not in endings or isinstance(word, Given)]
    try:
        chosen = choose(what, others, known) if others or not files else []
    except UsageError as error:
        raise UsageError(f"{error}; or a file ending in {', '.join(endings)}") from None
    return chosen + [read(file) for file in files]


def whole_file_of(word: str) -> str:
    """Return the file in a word that names a part of it, such as mesh.glb for mesh.glb#vertices; other words
    unchanged."""
    return word.removesuffix(f"{PART}{VERTICES}")


def names_a_file(word: str) -> bool:
    """Whether a file of this name exists; False for a name that no file can have."""
    with suppress(OSError, ValueError):
        return Path(word).is_file()
    return False


def names_a_folder(word: str) -> bool:
    """Whether a folder of this name exists; False for an empty name, and for a name that no folder can have."""
    with suppress(OSError, ValueError):
        return bool(word) and Path(word).is_dir()
    return False


def quoted(names: Iterable[str]) -> str:
    return ", ".join(repr(name) for name in names)
