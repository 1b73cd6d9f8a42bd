"""Layouts by name: presets, or TOML files, which may name a user's own encoder."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.files import file_toml
from ....encodings.codecs.variants import MARK, TABLE
from ....gbuffer.layouts.layout import Layout, read_layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.layouts.words import LayoutError
from ...ground.choose import choose
from ...ground.options.words import Names
from ...ground.output.errors import MissingError, UsageError
from ...ground.user_files import (
    UserFile,
    files_in,
    lacks_a_function,
    names_an_encoder,
    with_files,
)
from .encoding_names import encodings_named
from .names import check_twin

# The file of a look-up table: scales.npy of best_fit:table=scales.npy.
_TABLE_FILE = re.compile(rf"(?<={MARK}{TABLE}=)(?:[^{MARK}]|{MARK}(?=[\\/]))+")


def layouts_named(names: Names) -> list[Layout]:
    """Return the layouts with these names: layouts in the catalogue, or files that end in .toml.

    Raises:
        UsageError: a name is unknown or not unique, a file is not a layout, or an encoder cannot be measured.
        MissingError: the compiler of an encoder's language is not installed.
    """
    # The first look at an encoder takes seconds: layouts that name the same one share it.
    shared = cache(_encoding_named)
    files = {name: _layout_from_file(Path(name), shared) for name in map(str, names) if name.endswith(".toml")}
    chosen = choose("layout", names, {**LAYOUTS, **files})
    called = [layout.name for layout in chosen]
    for name in called:
        if called.count(name) > 1:
            raise UsageError(f"two layouts are named {name} (the file name without .toml); rename one")
    _check_encodings(chosen)
    return chosen


def _check_encodings(layouts: Sequence[Layout]) -> None:
    """Raise UsageError if two different encodings have the same name, because rows could not tell them apart."""
    files: dict[str, set[tuple[Path | None, Path]]] = {}
    for encoding in (layout.encoding for layout in layouts):
        files.setdefault(encoding.name, set()).add((encoding.source, encoding.glsl))
        if len(files[encoding.name]) > 1:
            raise UsageError(f"two layouts each have their own encoding named {encoding.name}; rename one")


def _layout_from_file(path: Path, encoding_named: Callable[[str], Encoding]) -> Layout:
    try:
        return read_layout(path, lambda word: encoding_named(_from_here(path, word)))
    except LayoutError as error:
        raise UsageError(str(error)) from error
    except (UsageError, MissingError) as error:
        # Of an encoder's file, which does not say that it was a layout that named it.
        raise type(error)(f"{path}: {error}") from error


def _encoding_named(word: str) -> Encoding:
    """Return the encoding that --encoding would select by this name; "all" is not accepted. Raises UsageError and
    MissingError."""
    if word == "all":
        raise UsageError(f"encoding {word!r}: a layout has one encoding")
    (encoding,) = encodings_named((word,))
    check_twin(encoding)
    return encoding


def _from_here(path: Path, word: str) -> str:
    """Return the name of the encoding in the layout at `path`, with its files relative to the working folder; a name
    without files is unchanged.

    Raises:
        LayoutError: a file is outside the layout's folder, so workers would not receive it with the layout.
    """
    if names_an_encoder(word) or lacks_a_function(word):
        named_file = UserFile(word)
        settings = named_file.settings
        for file in (*map(str, named_file.paths), *settings.preludes, *(root for _, root in settings.roots)):
            _check_inside(path.parent, file)
        named = files_in(word, path.parent)
        return with_files(word, {file: str(path.parent / file) for file in named}) if named else str(path.parent / word)
    table = _TABLE_FILE.search(word)
    if not table:
        return word
    _check_inside(path.parent, table[0])
    return f"{word[: table.start()]}{path.parent / table[0]}{word[table.end() :]}"


def _check_inside(folder: Path, file: str) -> None:
    """Raise LayoutError if a file is outside a folder, by its path or through a link; an encoder's includes have the
    same restriction."""
    place = Path(os.path.normpath(file))
    if place.is_absolute() or place.parts[:1] == (os.pardir,) or not _leads_inside(folder, place):
        raise LayoutError(f"{file} is not in the layout's folder or below it; copy it there")


def _leads_inside(folder: Path, place: Path) -> bool:
    try:
        return (folder / place).absolute().resolve().is_relative_to(folder.absolute().resolve())
    except ValueError:  # no file can have this name, which its reader says
        return True


def files_of_layout(path: Path) -> list[Path]:
    """Return the paths of the files that define a layout's encoding; empty if the layout has no such files or cannot
    be read."""
    try:
        word = _from_here(path, str(file_toml(path).get("encoding", "")))
    except (OSError, ValueError, LayoutError):
        return []
    return [Path(file) for file in files_in(word)]
