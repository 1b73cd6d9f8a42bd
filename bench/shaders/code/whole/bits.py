"""Words in bits of a target's channels, as text: where their parts are shifted to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .....encodings.storages.storage import Storage
from .....gbuffer.layouts.words import Word


@dataclass(frozen=True)
class WordPart:
    """The part of a word in a channel. The word's integer is shifted left by `shift`, or right if that is negative.
    Bits above the channel are masked off if `is_cut`; `is_masked` means that other bits are above the part."""

    word: Word
    shift: int
    is_cut: bool
    is_masked: bool


def parts_of(words: Sequence[Word], channel: int, storage: Storage) -> Iterator[WordPart]:
    """Yield the parts of words in a channel. Bits count from the first channel's highest, and a channel of another
    size than the first has no parts."""
    size = storage.bits[0]
    if storage.bits[channel] != size:
        return
    begin, end = size * channel, size * (channel + 1)
    for word in words:
        last = word.first + word.bits
        if word.bits and word.first < end and last > begin:
            yield WordPart(word, end - last, word.first < begin and size < 32, word.first > begin)


def packed_texts(parts: Sequence[tuple[WordPart, str]], size: int) -> list[str]:
    """Return the GLSL terms that, joined with |, form a channel's integer, one for each part, from its word's name.

    Args:
        size: the number of bits of the channel."""
    return [_put_text(part, name, size, len(parts) > 1) for part, name in parts]


def _put_text(part: WordPart, name: str, size: int, is_one_of_many: bool) -> str:
    text = _shifted(name, part.shift)
    if part.is_cut:
        text = f"({text}) & {2**size - 1}u" if part.shift else f"{text} & {2**size - 1}u"
    return f"({text})" if is_one_of_many and text != name else text


def taken_text(parts: Sequence[tuple[WordPart, str]], bits: int) -> str:
    """Return the GLSL expression of a word's integer, from the text of the channel that holds each part."""
    return " | ".join(_take_text(part, name, bits, len(parts) > 1) for part, name in parts)


def _take_text(part: WordPart, name: str, bits: int, is_one_of_many: bool) -> str:
    text = _shifted(name, -part.shift)
    if part.is_masked:
        text = f"({text}) & {2**bits - 1}u" if part.shift else f"{text} & {2**bits - 1}u"
    return f"({text})" if is_one_of_many and text != name else text


def _shifted(name: str, shift: int) -> str:
    if shift == 0:
        return name
    return f"{name} << {shift}" if shift > 0 else f"{name} >> {-shift}"
