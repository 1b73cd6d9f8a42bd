"""What travels to a worker: a table's options as text, and the users' files that they name, as bytes."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ...ground.options.words import given_in
from ...ground.output.errors import UsageError, noting_what_is_left_out
from ...keep.plain import key_text
from ...shaders.languages.words import file_of, files_in, parts_of, with_files
from ...tables.table import Row, Step
from ..measuring import Asked, companions, file_digest, words_of

# Where a worker keeps files that do not lie below the folder in which the command was typed.
ELSEWHERE = ".elsewhere"
# Bytes of files from which on each travels with the steps that read it, and not all with all.
APART = 1 << 23
# The output whose files are written while steps are measured, and come back with their rows.
PICTURES = "images"


@dataclass(frozen=True)
class Order:
    """What a worker makes a table's steps of.

    Attributes:
        id: the same for the same work, whoever asks.
        table: the table's name.
        options: sets of options, each the typed values by name.
        pictures: whether pictures are wanted.
        files: users' files, by their place in the worker's folder.
        typed: by a folder that the worker has under another name, how the user typed it.
        known: fingerprints of all files of the command, as typed; a worker has those of its order.
    """

    id: str
    table: str
    options: tuple[Mapping[str, Any], ...]
    pictures: bool = False
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    typed: Mapping[str, str] = field(default_factory=dict)
    known: Mapping[str, str] = field(default_factory=dict)

    def as_typed(self, value: Any) -> Any:
        """A value of a row or a key with files as the user named them."""
        if isinstance(value, str):
            for own, typed in sorted(self.typed.items(), key=lambda one: -len(one[0])):
                value = value.replace(own, typed)
            return value
        if isinstance(value, dict):
            return {self.as_typed(name): self.as_typed(one) for name, one in value.items()}
        return [self.as_typed(one) for one in value] if isinstance(value, list) else value

    def name_of(self, step: Step) -> str:
        """What a step is known by, the same here and on every worker that has the same files."""
        key = self.as_typed(step.key)
        is_same = key.get("files", {}).items() <= self.known.items()
        return step_name(self.table, key | {"files": dict(self.known)} if self.known and is_same else key)


def step_name(table: str, key: Row) -> str:
    """What a step is known by where its key would be long."""
    return hashlib.sha256(key_text(table, key).encode()).hexdigest()[:24]


class Packing:
    """The users' files of a command, as they are collected."""

    def __init__(self) -> None:
        self.files: dict[str, Path] = {}
        self.typed: dict[str, str] = {}

    def packed(self, word: str) -> str:
        """A word as a worker is to read it; the files that it names are collected, with their companions."""
        others: dict[str, str] = {}
        for part in parts_of(word):
            path = file_of(part)
            read, named = [path, *companions(part)], files_in(part)
            folder = self._place(path, [*read, *map(Path, named)])
            self.files |= {os.path.normpath(folder / os.path.relpath(one, path.parent)): one for one in read}
            # What else it names lies as far from it as here.
            moved = {one: os.path.normpath(folder / os.path.relpath(one, path.parent)) for one in named}
            if folder != path.parent:
                others |= moved
                self.typed |= {place: one for one, place in moved.items()}
        return with_files(word, others)

    def _place(self, path: Path, read: Sequence[Path]) -> Path:
        """The folder of a worker that stands for a file's.

        Args:
            read: what is read with it: none of that may lie above the folders of a worker.
        """
        if os.pardir not in path.parts and all(map(_is_below, read)):
            return path.parent
        above = os.path.commonpath(
            [os.path.normpath((one.parent if one.is_file() else one).absolute()) for one in read]
        )
        own = Path(ELSEWHERE) / hashlib.sha256(os.fsencode(path.parent.absolute())).hexdigest()[:12]
        own /= os.path.relpath(path.parent.absolute(), above)
        self.typed[str(own)] = str(path.parent)
        return own


def _is_below(path: Path) -> bool:
    """Whether a file lies in this folder or below it, as it is named."""
    return not path.is_absolute() and os.pardir not in Path(os.path.normpath(path)).parts


@dataclass(frozen=True, eq=False)
class Parcel:
    """An order that has yet to be packed: files are read when a worker is sent it.

    Attributes:
        id: that of the order.
        steps: the steps that workers make of it.
    """

    id: str
    steps: Sequence[Step]
    table: str
    options: tuple[Mapping[str, Any], ...]
    pictures: bool
    packing: Packing
    known: Mapping[str, str]

    def order(self) -> Order:
        """With the files as they are now. Raises UsageError where one cannot be read."""
        try:
            files = {place: path.read_bytes() for place, path in self.packing.files.items()}
        except OSError as error:
            raise UsageError(f"cannot read {error.filename}: {error.strerror or error}") from error
        return Order(self.id, self.table, self.options, self.pictures, files, self.packing.typed, self.known)


def parcels_of(ask: Asked, steps: Sequence[Step]) -> list[Parcel]:
    """What is asked, as it travels: one parcel, or one for each file where there are many large ones.

    Raises:
        UsageError: for values and files that cannot travel.
    """
    parts = _parts(ask.options) if not ask.others else []
    if len(parts) > 1:
        divided = _divided(ask, steps, parts)
        if sum(len(one.steps) for one in divided) == len(steps):
            return divided
    return [_parcel(ask, steps, (ask.options, *ask.others))]


def _parts(options: Any) -> list[Any]:
    """Options for one file each, of the option that names most files; none where all files together are small."""
    named = {name: [word for word in words if files_in(word)] for name, words in words_of(options).items()}
    name = max(named, key=lambda name: len(named[name]), default="")
    files = named.get(name, [])
    if sum(Path(path).stat().st_size for word in files for path in files_in(word)) < APART:
        return []
    others = [word for word in words_of(options)[name] if word and word not in files]
    return [replace(options, **{name: word}) for word in (*files, *([",".join(others)] if others else []))]


def _divided(ask: Asked, steps: Sequence[Step], parts: Sequence[Any]) -> list[Parcel]:
    """A parcel for each part, with those of the steps that are made of it."""
    known = _known(steps)
    wanted = {step_name(ask.table.name, step.key): step for step in steps}
    found: list[Parcel] = []
    for options in parts:
        keys = [step.key | ({"files": dict(known)} if known else {}) for step in _quietly_made(ask, options)]
        own = [wanted.pop(name) for key in keys if (name := step_name(ask.table.name, key)) in wanted]
        if own:
            found.append(_parcel(ask, own, (options,)))
    return found


def _quietly_made(ask: Asked, options: Any) -> Sequence[Step]:
    """Steps; what there is to say of them has been said."""
    with contextlib.redirect_stderr(io.StringIO()), noting_what_is_left_out():
        try:
            return ask.table.work.steps(options, ask.outputs)
        except UsageError:
            return []


def _known(steps: Sequence[Step]) -> Mapping[str, str]:
    return next((step.key["files"] for step in steps if "files" in step.key), {})


def _parcel(ask: Asked, steps: Sequence[Step], several: Sequence[Any]) -> Parcel:
    packing, known = Packing(), _known(steps)
    try:
        options = tuple(_packed(one, packing) for one in several)
        digests = [(place, file_digest(path)) for place, path in sorted(packing.files.items())]
    except OSError as error:
        raise UsageError(f"cannot read {error.filename}: {error.strerror or error}") from error
    pictures = getattr(ask.outputs, PICTURES, None) is not None
    said = [ask.table.name, options, pictures, digests, sorted(packing.typed.items()), sorted(known.items())]
    identity = hashlib.sha256(repr(said).encode()).hexdigest()[:16]
    return Parcel(identity, steps, ask.table.name, options, pictures, packing, known)


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
