"""A user's file in another language as a file of GLSL, kept in the cache."""

from __future__ import annotations

import json
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ...ground.machine import children
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError, UsageError
from ..translator import tree
from . import tools
from .language import also_read_by, language_of
from .source import Source
from .words import file_of, functions_of

# Of one file: a hundred times what it takes.
TIME_LIMIT = 60.0
TEXTS = ("", "-unit")


@dataclass(frozen=True)
class Translated:
    """A user's encoder in GLSL.

    Attributes:
        name: what rows call it.
        prefix: what the names of its GLSL functions begin with.
        components: how many numbers its code has.
        notes: what is to be said of it, lines.
        texts: its GLSL; and its GLSL where codes in [0, 1] become [-1, 1] on their way out, and come back.
        functions: encoder and decoder: the name of each in the user's file, and whether it takes the view.
    """

    name: str
    prefix: str
    components: int
    notes: list[str]
    texts: list[str]
    functions: list[tuple[str, bool]]

    def glsl(self, is_unit: bool) -> Path:
        """A file with one of the texts, that other processes find as well."""
        return glsl_file(self.prefix, self.texts[is_unit], TEXTS[is_unit])


def translated(word: str | Path, by: str = "") -> Translated:
    """The encoder that a word names: FILE, or FILE:ENCODE:DECODE.

    Args:
        by: another language whose compiler reads the file; empty for its own.

    Raises:
        UsageError: it cannot be read or translated; one line with the user's file, and line and column if known.
        MissingError: what to install.
    """
    path, asked = file_of(word), functions_of(word)
    source = Source(path)
    key = kept.key_of("translated", source.text, str(path), *(asked or ()), by, *_stamps(path, by), own())
    found = _whole(kept.read(key))
    if found is None:
        found = _whole(made := _by_child(path, asked, by))
        if found is None:
            raise UsageError(f"{path}: its translation ended without a result")
        kept.write(key, made)
    return found


def _stamps(path: Path, by: str) -> list[str]:
    other = also_read_by(path)
    also = [_stamp_if_there(tool) for tool in language_of(path, other).tools] if other else []
    try:
        return [*also, *(tools.stamp(tool) for tool in language_of(path, by).tools)]
    except MissingError as error:
        raise MissingError(f"{path}: {error}") from error


def _stamp_if_there(tool: str) -> str:
    try:
        return tools.stamp(tool)
    except MissingError:
        return ""


@cache
def own() -> str:
    """A hash of what makes the translation: this folder, and the reader and the writer of WGSL."""
    folders = Path(__file__).parent, Path(tree.__file__).parent
    files = sorted(file for folder in folders for file in folder.iterdir() if file.is_file())
    return kept.key_of(*(file.read_bytes() for file in files))


def _whole(value: dict[str, Any] | None) -> Translated | None:
    """What was kept or said; None where it is anything else."""
    try:
        return Translated(**(value or {}))
    except TypeError:
        return None


def _by_child(path: Path, asked: tuple[str, str] | None, by: str) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        command = children.python("normalbench.bench.shaders.languages.child", folder, str(path), by, *(asked or ()))
        try:
            done = children.finished(command, TIME_LIMIT)
        except subprocess.TimeoutExpired as error:
            raise UsageError(f"{path}: its translation did not end within {TIME_LIMIT:g} s") from error
    try:
        found = json.loads(done.stdout)
    except ValueError:
        raise UsageError(f"{path}: its translation {children.how_it_ended(done)}") from None
    if "missing" in found:
        raise MissingError(found["missing"])
    if "error" in found:
        raise UsageError(found["error"])
    return found


def glsl_file(name: str, text: str, mark: str = "") -> Path:
    """A file of GLSL that other processes find as well, in the cache."""
    return _file(f"{name[:40]}-{kept.key_of(text)[:16]}{mark}.glsl", text)


def _file(name: str, text: str) -> Path:
    """A file of this name and text in the cache; where that cannot be written, in a folder of this process."""
    for folder in (kept.folder() / "translated", None):
        path = (folder or kept.folder_of_this_process()) / name
        try:
            if not kept.is_private(path) or path.read_text(encoding="utf-8") != text:
                _write(path, text)
            return path
        except (OSError, ValueError):
            continue
    raise UsageError(f"{name}: neither the cache nor a temporary folder can be written")


def _write(path: Path, text: str) -> None:
    """Readers see the old file or the new one."""
    kept.make_folder(path.parent)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, encoding="utf-8", delete=False) as file:
        try:
            file.write(text)
            file.close()
            Path(file.name).replace(path)
        finally:
            Path(file.name).unlink(missing_ok=True)
