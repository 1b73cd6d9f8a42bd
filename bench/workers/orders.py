"""What travels to a worker: a table's options as text, and the users' files that they name, as bytes."""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from ..languages.words import file_of
from ..options.words import given_in
from ..output.errors import UsageError
from ..results.measuring import Asked, companions, words_of
from ..results.plain import key_text
from ..tables.table import Row, Step

# Where a worker keeps files that do not lie below the folder in which the command was typed.
ELSEWHERE = ".elsewhere"
# The output whose files are written while steps are measured, and come back with their rows.
PICTURES = "images"


@dataclass(frozen=True)
class Order:
    """What a worker makes a table's steps of.

    Attributes:
        table: the table's name.
        options: sets of options, each the typed values by name.
        pictures: whether pictures are wanted.
        files: users' files, by their place in the worker's folder.
        typed: by a folder that the worker has under another name, how the user typed it.
    """

    table: str
    options: tuple[Mapping[str, Any], ...]
    pictures: bool = False
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    typed: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def id(self) -> str:
        """The same for the same work."""
        said = [self.table, self.options, self.pictures, sorted(self.files.items()), sorted(self.typed.items())]
        return hashlib.sha256(pickle.dumps(said)).hexdigest()[:16]

    def as_typed(self, value: Any) -> Any:
        """A value of a row or a key with files as the user named them."""
        if isinstance(value, str):
            for own, typed in self.typed.items():
                value = value.replace(own, typed)
            return value
        if isinstance(value, dict):
            return {self.as_typed(name): self.as_typed(one) for name, one in value.items()}
        return [self.as_typed(one) for one in value] if isinstance(value, list) else value

    def name_of(self, step: Step) -> str:
        """What a step is known by, the same here and on every worker."""
        return step_name(self.table, self.as_typed(step.key))


def step_name(table: str, key: Row) -> str:
    """What a step is known by where its key would be long."""
    return hashlib.sha256(key_text(table, key).encode()).hexdigest()[:24]


class Packing:
    """The users' files of a command, as they are collected."""

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.typed: dict[str, str] = {}

    def packed(self, word: str) -> str:
        """A word as a worker is to read it; the file that it names is collected, with its companions."""
        path = _file_in(word)
        if path is None:
            return word
        folder = self._place(path)
        for one in (path, *companions(path)):
            self.files[os.path.normpath(folder / os.path.relpath(one, path.parent))] = one.read_bytes()
        return word.replace(str(path), str(folder / path.name), 1)

    def _place(self, path: Path) -> Path:
        """The folder of a worker that stands for a file's."""
        if not path.is_absolute() and ".." not in path.parts:
            return path.parent
        own = Path(ELSEWHERE) / hashlib.sha256(os.fsencode(path.parent.absolute())).hexdigest()[:12]
        self.typed[str(own)] = str(path.parent)
        return own


def _file_in(word: str) -> Path | None:
    """The file that a word names, alone or as a parameter: `mine.glsl`, `best_fit:table=scales.npy`."""
    for path in (file_of(word), Path(word.rpartition("=")[2])):
        try:
            # As typed: a path that pathlib would shorten is not found in the word again.
            if path.is_file() and str(path) in word:
                return path
        except (OSError, ValueError):
            continue
    return None


def order_of(ask: Asked) -> Order:
    """What is asked, as it travels. Raises UsageError for values and files that cannot."""
    packing = Packing()
    try:
        options = tuple(_packed(one, packing) for one in (ask.options, *ask.others))
    except OSError as error:
        raise UsageError(f"cannot read {error.filename}: {error.strerror or error}") from error
    pictures = getattr(ask.outputs, PICTURES, None) is not None
    return Order(ask.table.name, options, pictures, packing.files, packing.typed)


def _packed(options: Any, packing: Packing) -> dict[str, Any]:
    values = {one.name: getattr(options, one.name) for one in fields(options)}
    for name, value in values.items():
        if own := given_in(value):
            raise UsageError(f"{name}: {', '.join(own)} is a value of this process; workers measure names and files")
    for name, words in words_of(options).items():
        packed = [packing.packed(word) if word else word for word in words]
        # A text without files stays as it is, to the last blank.
        if packed != words:
            values[name] = ",".join(packed)
    return values


def check_paths(names: Iterable[str]) -> None:
    """Raises UsageError for a file that would lie outside the worker's folder."""
    for name in names:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise UsageError(f"{name}: a file of an order lies below the worker's folder")
