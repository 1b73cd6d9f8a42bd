"""GLSL translations of users' files in other languages, kept in the cache."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ....encodings import kinds
from ....encodings.kinds import Kind
from ...ground.compilers import tools
from ...ground.machine import children
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError, SeveralEncodersError, UsageError
from ...ground.user_files import UserFile
from ..translator import tree
from .language import language_of
from .source import Part, Source

# Of one file: a hundred times what it takes.
TIME_LIMIT = 60.0
TEXTS = ("", "-unit")
# How a process ends that a text kills, and not a limit.
CRASHES = tuple(-number for number in (signal.SIGABRT, signal.SIGSEGV, signal.SIGILL))


@dataclass(frozen=True)
class Translated:
    """A user's encoder in GLSL.

    Attributes:
        name: its name in rows.
        prefix: the prefix of its GLSL functions' names.
        components: the number of components of its code.
        packed: the type of its code if this is a single 32-bit value, whose halves are the numbers; otherwise empty.
        notes: lines to report about it.
        texts: its GLSL, and a version with codes in [0, 1] converted to [-1, 1] on output and back on input.
        text: the part of the user's file that was compiled.
        functions: the names of the encoder and the decoder in the user's file, each with whether it takes the view.
        named: the two functions as a user names them, ENCODE:DECODE.
        read_by: the compiler that read the file, if not its language's own (see `BY_NAME`).
        shaped: for an encoding of something other than normals: `template`, the file around it; `settings`, the
            other inputs of its functions; and `parts`, the number of components of each part that the functions take
            and return (see `shapes.py`).
    """

    name: str
    prefix: str
    components: int
    packed: str
    notes: list[str]
    texts: list[str]
    text: str
    functions: list[tuple[str, bool]]
    read_by: str
    named: str
    shaped: dict[str, Any]

    def glsl(self, is_unit: bool) -> Path:
        """Return the path of a file with one of the GLSL texts, which other processes can find; `is_unit` selects the
        version with converted codes."""
        return glsl_file(self.prefix, self.texts[is_unit], TEXTS[is_unit])


class AloneError(UsageError):
    """A file with an encoder or a decoder, but not both.

    Attributes:
        made: the translation of the file, in which the missing function returns 0.
    """

    def __init__(self, message: str, translation: Translated):
        super().__init__(message)
        self.made = translation


def translated(file: UserFile, by: str = "", kind: Kind = kinds.NORMAL) -> Translated:
    """Return a user's encoder, translated to GLSL; from the cache if nothing has changed.

    Args:
        by: the compiler that reads the file, if not its language's own (see `BY_NAME`).
        kind: the kind of the encoded values.

    Raises:
        UsageError: the file cannot be read or translated; the one-line message names the user's file, and the line
            and column if known.
        SeveralEncodersError: the file has several encoders, and none is requested.
        MissingError: a compiler is missing; the message states what to install.
    """
    source = Source(file)
    read = [str(path) for path in source.files.values()]
    key = kept.key_of("translated", source.text, file.word, *read, by, kind.name, *_tool_stamps(file, by), own())
    encoder = _translated_or_none(kept.read(key))
    if encoder is None:
        encoder = _translated_or_none(answer := _by_child(file, by, kind))
        if encoder is None:
            raise UsageError(f"{source.path}: its translation ended without a result")
        kept.write(key, answer)
    return encoder


def _tool_stamps(file: UserFile, by: str) -> list[str]:
    language = language_of(file, by)
    try:
        return [*map(tools.stamp, language.tools), *map(tools.stamp_or_empty, language.others)]
    except MissingError as error:
        raise MissingError(f"{file.path}: {error}") from error


@cache
def own() -> str:
    """Return a hash of the sources that affect translations: this folder, the translator and the compiler tools."""
    return kept.key_of(*(file.read_bytes() for file in sources_of_this()))


def sources_of_this() -> list[Path]:
    """Return the sorted paths of the source files that `own` hashes."""
    folders = (Path(file).parent for file in (__file__, tree.__file__, tools.__file__))
    return sorted([Path(kinds.__file__), *(file for folder in folders for file in folder.iterdir() if file.is_file())])


def _translated_or_none(value: Any) -> Translated | None:
    """Return the encoder in a cached or reported value with the fields of `Translated`; None if the value is
    malformed, because a file could have misled the process that reports it."""
    try:
        encoder = Translated(**(value or {}))
    except TypeError:
        return None
    is_sound = all(isinstance(getattr(encoder, name), kind) for name, kind in _KINDS.items())
    is_sound = is_sound and len(encoder.texts) == len(TEXTS) and all(isinstance(text, str) for text in encoder.texts)
    return encoder if is_sound and re.fullmatch(r"\w+", encoder.prefix) else None


_KINDS = dict.fromkeys(("name", "prefix", "packed", "text", "read_by", "named"), str)
_KINDS |= {"components": int, "notes": list, "texts": list, "functions": list, "shaped": dict}


def _by_child(file: UserFile, by: str, kind: Kind) -> dict[str, Any]:
    """Translate a file in a child process, and return the fields of `Translated` as JSON values. Raises UsageError,
    SeveralEncodersError and MissingError."""
    done = _ended_child(file, by, kind)
    answer = _answer(done)
    if answer is None and done.returncode in CRASHES:
        answer = _answer_without_killer(file, by, kind)
    if answer is None:
        raise UsageError(f"{file.path}: its translation {children.how_it_ended(done)}")
    if "missing" in answer:
        raise MissingError(_one_line(answer["missing"]))
    single = _translated_or_none(answer.get("alone"))
    if isinstance(pairs := answer.get("pairs"), list):
        raise SeveralEncodersError(_one_line(answer.get("error")), [*map(_one_line, pairs)], single)
    if "error" in answer:
        raise AloneError(_one_line(answer["error"]), single) if single else UsageError(_one_line(answer["error"]))
    return answer


def _ended_child(file: UserFile, by: str, kind: Kind, part: Part = (0, 0)) -> subprocess.CompletedProcess[str]:
    with tempfile.TemporaryDirectory() as folder:
        words = (folder, file.word, by, kind.name, ":".join(map(str, part)))
        try:
            return children.finished(children.python("normalbench.bench.shaders.languages.child", *words), TIME_LIMIT)
        except subprocess.TimeoutExpired as error:
            raise UsageError(f"{file.path}: its translation did not end within {TIME_LIMIT:g} s") from error


def _answer(done: subprocess.CompletedProcess[str]) -> dict[str, Any] | None:
    """Return the dictionary that a child printed as JSON; empty for any other JSON value, None for other output."""
    try:
        answer = json.loads(done.stdout)
    except (ValueError, RecursionError):
        return None
    return answer if isinstance(answer, dict) else {}


def _answer_without_killer(file: UserFile, by: str, kind: Kind) -> dict[str, Any] | None:
    """Return the answer without the declaration that crashes the compiler and that its notes or its error name; None
    if leaving out a single declaration does not help."""
    number, count = 0, 1
    while True:
        halves = [(2 * number, 2 * count), (2 * number + 1, 2 * count)]
        answers = ((half, _answer(_ended_child(file, by, kind, half))) for half in halves)
        (number, count), answer = next(((half, reply) for half, reply in answers if reply is not None), ((0, 0), None))
        left_out = answer.get("left_out") if answer else None
        if not answer or not isinstance(left_out, list) or not left_out:
            return None
        if len(left_out) == 1:
            reason = f"{_one_line(left_out[0])} crashes the compiler"
            more = {"error": f"{reason}; without it: {answer['error']}"} if "error" in answer else {}
            notes = {"notes": [f"{reason} and is left out", *answer["notes"]]} if "notes" in answer else {}
            return {name: value for name, value in answer.items() if name not in ("left_out", "alone")} | more | notes


def _one_line(message: Any) -> str:
    return "".join(letter if letter.isprintable() else " " for letter in str(message))


def glsl_file(name: str, text: str, mark: str = "") -> Path:
    """Return the path of a cached file with this GLSL text, for other processes too; write the file if necessary."""
    return _cached_file(f"{name[:40]}-{kept.key_of(text)[:16]}{mark}.glsl", text)


def _cached_file(name: str, text: str) -> Path:
    """Return the path of a file with this name and text, in the cache or, if the cache is not writable, in a folder
    of this process; write the file if necessary. Raises UsageError."""
    for folder in (kept.folder() / "translated", None):
        path = (folder or kept.folder_of_this_process()) / name
        try:
            if not kept.is_private(path) or path.read_text(encoding="utf-8") != text:
                kept.put(path, text.encode())
            return path
        except (OSError, ValueError):
            continue
    raise UsageError(f"{name}: neither the cache folder nor a temporary folder is writable")
