"""How a user's encoder is named: a file, and where it has several pairs of functions, the two that are meant.

Imports nothing heavy: gates read these names before anything is measured.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

GLSL = ".glsl"
# The languages that are translated, by what their files end in. A new one is a line here and one in `language.py`.
TRANSLATED: Mapping[str, str] = MappingProxyType(
    {**dict.fromkeys((".hlsl", ".hlsli", ".fx"), "HLSL"), ".slang": "Slang", ".wgsl": "WGSL"}
)
ENDINGS = (GLSL, *TRANSLATED)
# FILE:ENCODE:DECODE.
_PAIR = re.compile(
    rf"(?P<file>.*(?:{'|'.join(map(re.escape, TRANSLATED))})):(?P<encode>\w+):(?P<decode>\w+)", re.I | re.S
)


def names_an_encoder(word: str) -> bool:
    """Whether a word is the file of a user's encoder, by its ending."""
    return Path(file_of(word)).suffix.lower() in ENDINGS and not _is_only_an_ending(word)


def _is_only_an_ending(word: str) -> bool:
    return Path(word).name.lower() in ENDINGS


def file_of(word: str | Path) -> Path:
    """The file of a word: mine.hlsl of mine.hlsl:EncodeNormal:DecodeNormal."""
    match = _PAIR.fullmatch(str(word))
    return Path(match["file"] if match else word)


def files_in(word: str, folder: Path = Path()) -> list[Path]:
    """The files that a word names, as it has them: `mine.hlsl` of mine.hlsl:EncodeNormal:DecodeNormal, and both of
    mine.glsl/rg8+best_fit:table=scales.npy.

    Args:
        folder: where they are looked for.
    """
    if _is_file_in(word, file_of(word), folder):
        return [file_of(word)]
    found = dict.fromkeys(path for path in _parts_of(word) if _is_file_in(word, path, folder))
    return list(found)


def _parts_of(word: str) -> Iterator[Path]:
    """What may be a file in a word: a codec of a chain is ENCODING/STORAGE."""
    for part in word.split("+"):
        for encoding in (part, part.rpartition("/")[0]):
            yield file_of(encoding)
            yield from (Path(setting.partition("=")[2]) for setting in encoding.split(":"))


def _is_file_in(word: str, path: Path, folder: Path) -> bool:
    try:
        # As typed: a path that pathlib would shorten is not found in the word again.
        return str(path) in word and (folder / path).is_file()
    except (OSError, ValueError):  # no name that a file could have
        return False


def lacks_a_function(word: str) -> bool:
    """Whether a word names a file, and not both of the functions in it: mine.hlsl:EncodeNormal."""
    head, mark, _ = word.partition(":")
    return bool(mark) and Path(head).suffix.lower() in ENDINGS and not names_an_encoder(word)


def functions_of(word: str | Path) -> tuple[str, str] | None:
    """The two functions that a word names; None where it names none."""
    match = _PAIR.fullmatch(str(word))
    return (match["encode"], match["decode"]) if match else None


def twin_of(word: str | Path) -> Path:
    """The Python file that may lie next to an encoder."""
    return file_of(word).with_suffix(".py")


def is_translated(word: str | Path) -> bool:
    """Whether a word's file is in another language than GLSL."""
    return file_of(word).suffix.lower() in TRANSLATED
