"""How a user's encoder is named: a file, and where it has several pairs of functions, the two that are meant.

Imports nothing heavy: gates read these names before anything is measured.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

GLSL = ".glsl"
# The languages that are translated, by what their files end in. A new one is a line here and one in `language.py`.
TRANSLATED: Mapping[str, str] = MappingProxyType(
    {**dict.fromkeys((".hlsl", ".hlsli", ".fx"), "HLSL"), ".slang": "Slang", ".wgsl": "WGSL"}
)
ENDINGS = (GLSL, *TRANSLATED)
# Between a codec and the encoding of what comes back from it.
CHAIN = "+"
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


def files_in(word: str, folder: Path = Path()) -> list[str]:
    """The files that a word names, as it has them: `mine.hlsl` of mine.hlsl:EncodeNormal:DecodeNormal, and both of
    mine.glsl/rg8+best_fit:table=scales.npy.

    Args:
        folder: where they are looked for.
    """
    match = _PAIR.fullmatch(word)
    whole = match["file"] if match else word
    if _is_file(folder, whole):
        return [whole]
    found = [value for setting in word.split(":") if _is_file(folder, value := setting.partition("=")[2])]
    # A chain is ENCODING/STORAGE+ENCODING.
    before, is_chain, then = word.rpartition(CHAIN)
    parts = (before.rpartition("/")[0], then) if is_chain else ()
    return list(dict.fromkeys([*found, *(one for part in parts for one in files_in(part, folder))]))


def _is_file(folder: Path, text: str) -> bool:
    try:
        return bool(text) and (folder / text).is_file()
    except (OSError, ValueError):  # no name that a file could have
        return False


def with_files(word: str, others: Mapping[str, str]) -> str:
    """A word with other files in place of those that `files_in` found in it."""
    if not others:
        return word
    known = "|".join(map(re.escape, sorted(others, key=len, reverse=True)))
    return re.sub(rf"(?<![^+=])(?:{known})(?![^:/+])", lambda match: others[match[0]], word)


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
