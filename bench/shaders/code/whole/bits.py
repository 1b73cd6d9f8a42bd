"""Words that are stored in bits of a target's channels, as text: the positions to which their parts are shifted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .....encodings.storages.storage import Storage
from .....gbuffer.layouts.words import Word


@dataclass(frozen=True)
class WordPart:
    """The part of a word that is in one channel. The word's integer is shifted left by `shift`, or right if that is
    negative. Bits above the channel are masked off if `is_cut`; `is_masked` means that other bits are above the
    part."""

    word: Word
    shift: int
    is_cut: bool
    is_masked: bool


def parts_of(words: Sequence[Word], channel: int, storage: Storage) -> Iterator[WordPart]:
    """Yield the parts of words in a channel. Bits are counted from the highest bit of the first channel. A channel
    of a different size has no parts."""
    size = storage.bits[0]
    if storage.bits[channel] != size:
        return
    begin, end = size * channel, size * (channel + 1)
    for word in words:
        last = word.first + word.bits
        if word.bits and word.first < end and last > begin:
            yield WordPart(word, end - last, word.first < begin and size < 32, word.first > begin)


def packed_texts(parts: Sequence[tuple[WordPart, str]], size: int) -> list[str]:
    """Return one GLSL term per part, from the name of the part's word. Joined with |, the terms form a channel's
    integer.

    Args:
        size: the number of bits in the channel."""
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
