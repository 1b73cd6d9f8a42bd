"""The data sent to a worker: a table's options as text, and the users' files that the options name, as bytes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from ...ground.options.words import Given
from ...ground.output.errors import UsageError
from ...ground.user_files import file_of, files_in, parts_of, with_files
from ...keep.plain import key_text
from ...tables.table import Row
from ..measuring import Asked, companions, words_of

# Where a worker keeps files that do not lie below the folder in which the command was typed.
ELSEWHERE = ".elsewhere"
# The output whose files are written while steps are measured, and come back with their rows.
PICTURES = "images"


@dataclass(frozen=True)
class Order:
    """The data from which a worker makes a table's steps.

    Attributes:
        id: an identifier, the same for the same work of any user.
        table: the table's name.
        options: sets of options, each with the typed values by name.
        pictures: whether images are wanted.
        files: users' files, by their path in the worker's folder.
        typed: for each folder that has a different name on the worker, the name that the user typed.
    """

    id: str
    table: str
    options: tuple[Mapping[str, Any], ...]
    pictures: bool = False
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    typed: Mapping[str, str] = field(default_factory=dict)

    def as_typed(self, line: str) -> str:
        """Return a line with the worker's folders replaced by the names that the user typed."""
        for own, typed in sorted(self.typed.items(), key=lambda place: -len(place[0])):
            line = line.replace(own, typed)
        return line


def step_name(table: str, key: Row) -> str:
    """Return a 24-character hash of a table's name and a step's key, for use where the key would be too long."""
    return hashlib.sha256(key_text(table, key).encode()).hexdigest()[:24]


class Packing:
    """A collection of the users' files that a command reads."""

    def __init__(self) -> None:
        self.files: dict[str, Path] = {}
        self.typed: dict[str, str] = {}

    def packed(self, word: str) -> str:
        """Return a word with the paths that a worker needs, and collect the files that the word names, with their
        companions."""
        others: dict[str, str] = {}
        for part in parts_of(word):
            path = file_of(part)
            read, named = [path, *companions(part)], files_in(part)
            folder = self._place(path, [*read, *map(Path, named)])
            self.files |= {os.path.normpath(folder / os.path.relpath(file, path.parent)): file for file in read}
            # What else it names lies as far from it as here.
            moved = {name: os.path.normpath(folder / os.path.relpath(name, path.parent)) for name in named}
            if folder != path.parent:
                others |= moved
                self.typed |= {place: name for name, place in moved.items()}
        return with_files(word, others)

    def _place(self, path: Path, read: Sequence[Path]) -> Path:
        """Return the folder on a worker that stands for the folder of the file `path`: the same folder if all files
        are below the current folder, else a folder below ELSEWHERE.

        Args:
            read: the files read with it; on the worker, they must not be above the worker's folders.
        """
        if os.pardir not in path.parts and all(map(_is_below, read)):
            return path.parent
        above = os.path.commonpath(
            [os.path.normpath((source.parent if source.is_file() else source).absolute()) for source in read]
        )
        own = Path(ELSEWHERE) / hashlib.sha256(os.fsencode(path.parent.absolute())).hexdigest()[:12]
        own /= os.path.relpath(path.parent.absolute(), above)
        self.typed[str(own)] = str(path.parent)
        return own


def _is_below(path: Path) -> bool:
    """Whether a file's path, as written, is in the current folder or below it."""
    return not path.is_absolute() and os.pardir not in Path(os.path.normpath(path)).parts


def order_of(ask: Asked) -> Order:
    """Return a request as an order that can be sent. Raises UsageError for values and files that cannot be sent."""
    packing = Packing()
    try:
        options = tuple(_packed(values, packing) for values in (ask.options, *ask.others))
        files = {place: path.read_bytes() for place, path in sorted(packing.files.items())}
    except OSError as error:
        raise UsageError(f"cannot read {error.filename}: {error.strerror or error}") from error
    pictures = getattr(ask.outputs, PICTURES, None) is not None
    digests = {place: hashlib.sha256(data).hexdigest() for place, data in files.items()}
    identity = [ask.table.name, options, pictures, digests, sorted(packing.typed.items())]
    digest = hashlib.sha256(repr(identity).encode()).hexdigest()[:16]
    return Order(digest, ask.table.name, options, pictures, files, packing.typed)


def _packed(options: Any, packing: Packing) -> dict[str, Any]:
    values = {option.name: getattr(options, option.name) for option in fields(options)}
    for name, value in values.items():
        if own := [word.name for word in value if isinstance(word, Given)] if isinstance(value, tuple) else []:
            raise UsageError(f"{name}: {', '.join(own)} exists only in this process; with --on use names and files")
    for name, words in words_of(options).items():
        packed = tuple(map(packing.packed, words))
        values[name] = packed if isinstance(values[name], tuple) else "".join(packed) or values[name]
    return values
