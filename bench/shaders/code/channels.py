"""The position of each number of a code in a storage, as text for the functions of storage.glsl.j2."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ....encodings.storages.storage import FloatForm
from .kinds.code_kind import Numbers
from .kinds.table import kind_of

TEMPLATE = Path(__file__).with_name("storage.glsl.j2")
FIELDS, PARTS, WORD = "xyzw", "rgba", 32
RULES: Mapping[str, str] = MappingProxyType(
    {
        "nearest": "{x} * {scale}, rounded to the nearest integer, ties to even",
        "truncate": "{x} * {scale}, truncated toward zero",
        "truncate_half": "{x} * ({scale} + 1/2), truncated toward zero, at most {scale}",
    }
)


@dataclass(frozen=True)
class Piece:
    """Neighbouring bits of a number that are in one channel of a target.

    Attributes:
        part: the index of the channel.
        above: the number of higher bits of the same number.
        below: the number of lower bits of the same number.
        left: the position in the channel of the piece's lowest bit.
        bits: the number of bits in the piece.
        is_first: whether the piece begins at the channel's highest bit.
    """

    part: int
    above: int
    below: int
    left: int
    bits: int
    is_first: bool

    def placed(self, name: str) -> str:
        """Return the GLSL expression for the piece's bits at their place in the channel, from the number `name`."""
        low = f"{name} >> {self.below}" if self.below else name
        kept = f"({low} & {mask_text(self.bits)})" if self.above else low
        return f"{kept} << {self.left}" if self.left else kept

    def taken(self, part: str) -> str:
        """Return the GLSL expression for the piece's bits at their place in the number, from the channel `part`."""
        low = f"{part} >> {self.left}" if self.left else part
        kept = low if self.is_first else f"({low} & {mask_text(self.bits)})"
        return f"{kept} << {self.below}" if self.below else kept


@dataclass(frozen=True)
class Channel:
    """One number of a code in its storage.

    Attributes:
        name: x, y, z or w.
        kind: the kind of the storage.
        bits: the number of its bits.
        first: the position of its lowest bit in the texel; if numbers are laid across channels, in the channels read
            as one number, in which the first channel is the highest.
        integer: the integer that stands for 1.
        most: the largest integer.
        rounding: one of `storage.ROUNDINGS`.
        form: the form of a float.
        share: as in `Numbers`.
        is_offset: whether `integer` is added to the number's integer, so that no stored integer is negative.
        words: the number of words in the texel.
        pieces: its bits by channel, if numbers are laid across channels.
    """

    name: str
    kind: str
    bits: int
    first: int
    integer: int
    most: int
    rounding: str
    form: FloatForm | None
    share: str
    is_offset: bool
    words: int
    pieces: tuple[Piece, ...] = ()

    @property
    def scale(self) -> str:
        return f"{self.integer}.0"

    @property
    def top(self) -> str:
        """The largest integer as a float literal, such as `127.0`."""
        return f"{self.most}.0"

    @property
    def mask(self) -> str:
        return mask_text(self.bits)

    @property
    def largest(self) -> str:
        """The largest unsigned integer with this number of bits, as a float literal such as `255.0`."""
        return f"{(1 << self.bits) - 1}.0"

    @property
    def truncates(self) -> str:
        return "false" if self.rounding == "nearest" else "true"

    @property
    def float_words(self) -> str:
        """The arguments of `float_bits` as text: the bits of exponent and mantissa, and whether it is signed."""
        assert self.form
        return f"{self.form.exponent}, {self.form.mantissa}, {'true' if self.form.is_signed else 'false'}"

    @property
    def share_words(self) -> str:
        """The arguments of `fixed_code` as text: the largest integer, and whether the number has a sign."""
        return f"{self.scale}, {'true' if self.share == 'signed' else 'false'}"

    def rounded(self, x: str) -> str:
        """Return the GLSL expression, a float, that scales the expression `x`, in [-1, 1], and rounds it to a whole
        number."""
        if self.rounding == "nearest":
            whole = f"roundEven({x} * {self.scale})"
            return whole if self.most == self.integer else f"min({whole}, {self.top})"
        if self.rounding == "truncate" and self.most == self.integer:
            return f"trunc({x} * {self.scale})"
        widened = f"{self.integer}.{5 if self.rounding == 'truncate_half' else 0}"
        return f"clamp(trunc({x} * {widened}), -{self.scale}, {self.top})"

    @property
    def _word_name(self) -> str:
        return "texel" + (f".{FIELDS[self.first // WORD]}" if self.words > 1 else "")

    @property
    def read(self) -> str:
        """The GLSL expression that takes the number's bits from the word or the channels that hold them; in
        parentheses unless it is a name."""
        if self.pieces:
            return f"({' | '.join(f'({piece.taken(PARTS[piece.part])})' for piece in self.pieces)})"
        shift = self.first % WORD
        moved = f"{self._word_name} >> {shift}" if shift else self._word_name
        return f"({moved} & {self.mask})" if self.bits < WORD else self._word_name

    @property
    def signed(self) -> str:
        """The GLSL expression that shifts the number's word until the number's bits are the highest."""
        shift = WORD - self.bits - self.first % WORD
        return f"{self._word_name} << {shift}" if shift else self._word_name

    @property
    def placed(self) -> str:
        """The GLSL expression that shifts the number's bits, a variable with its name, to their place in a word."""
        shift = self.first % WORD
        return f"{self.name} << {shift}" if shift else self.name


@dataclass(frozen=True)
class Channels:
    """The numbers of any kind of codec in their storage, as the template needs them."""

    codec: Any

    @cached_property
    def numbers(self) -> Numbers:
        """The code's numbers."""
        return kind_of(self.codec).numbers(self.codec)

    @property
    def words(self) -> int:
        """The number of 32-bit integers in a texel: 1, 2 or 4."""
        least = -(-self._end // WORD)
        return least if least < 3 else 4

    @property
    def part(self) -> int:
        """The number of bits per channel if numbers are laid across channels; 0 if each number has its own channel,
        or all numbers are in one integer."""
        return 0 if self.numbers.storage.is_word else self.numbers.storage.part

    @property
    def parts(self) -> int:
        """The number of target channels that a texel's bits fill one after the other; 0 if each number has its own."""
        size = self.numbers.storage.part
        return -(-self._end // size) if size else 0

    @property
    def _end(self) -> int:
        """The number of bits up to the end of the last number, from the first channel's highest bit."""
        return self.numbers.skipped + sum(self.numbers.storage.bits)

    @cached_property
    def channels(self) -> list[Channel]:
        """The position and format of each number of the code."""
        storage = self.numbers.storage
        return [
            Channel(
                FIELDS[i],
                storage.kind,
                storage.bits[i],
                self._first_bit(i),
                storage.scale(i),
                storage.most(i),
                rounding,
                storage.float_form(i) if storage.kind == "float" else None,
                self.numbers.share,
                storage.kind == "snorm" and (storage.is_packed or storage.is_centred),
                self.words,
                self._pieces(i),
            )
            for i, rounding in enumerate(self.numbers.roundings)
        ]

    def _first_bit(self, index: int) -> int:
        bits = self.numbers.storage.bits
        before = self.numbers.skipped + sum(bits[:index])
        return self.part * self.parts - before - bits[index] if self.part else before

    def _pieces(self, index: int) -> tuple[Piece, ...]:
        """Return the pieces of a number, one per channel with bits of it; empty unless laid across channels."""
        if not self.part:
            return ()
        bits = self.numbers.storage.bits
        start = self.numbers.skipped + sum(bits[:index])
        end = start + bits[index]
        pieces = []
        for part in range(start // self.part, -(-end // self.part)):
            low, high = max(start, part * self.part), min(end, (part + 1) * self.part)
            is_first = low == part * self.part
            pieces.append(Piece(part, low - start, end - high, (part + 1) * self.part - high, high - low, is_first))
        return tuple(pieces)

    def _texel_text(self, word: int) -> str:
        """Return the GLSL expression for a word of the texel, from its numbers or channels; "0u" if it is empty."""
        if not self.part:
            return " | ".join(c.placed for c in self.channels if c.first // WORD == word) or "0u"
        each = WORD // self.part
        inside = range(word * each, min(self.parts, word * each + each))
        return " | ".join(_shifted_text(PARTS[i], self.part * (i % each)) for i in inside) or "0u"

    def _part_text(self, part: int) -> str:
        """Return the GLSL expression for a channel, from the numbers laid across it; "0u" if the channel is empty."""
        held = [(c.name, piece) for c in self.channels for piece in c.pieces if piece.part == part]
        return (
            " | ".join(f"({piece.placed(name)})" if piece.left else piece.placed(name) for name, piece in held) or "0u"
        )

    def _read_part(self, part: int) -> str:
        """Return the GLSL expression that reads a channel's integer from the texel's words."""
        size = self.numbers.storage.part
        each = WORD // size
        word = "texel" + (f".{FIELDS[part // each]}" if self.words > 1 else "")
        shift = size * (part % each)
        return f"{word} >> {shift} & {mask_text(size)}" if shift else f"{word} & {mask_text(size)}"

    @property
    def layout(self) -> str:
        """The positions of the numbers in the texel, as a phrase for a comment."""
        if self.part:
            spread = ", then ".join(f"{c.bits} bits of {c.name}" for c in self.channels)
            what = "byte" if self.part == 8 else f"channel of {self.part}"
            place = ("first", "second", "third", "fourth")[self.numbers.skipped // self.part]
            bit = self.part - self.numbers.skipped % self.part
            begin = "the highest bit" if bit == self.part else f"bit {bit - 1}"
            return f"{spread}, starting at {begin} of the {place} {what}"
        places = (f"{c.name} in bits {c.first % WORD} to {c.first % WORD + c.bits - 1}" for c in self.channels)
        owners = (f" of the {('first', 'second', 'third', 'fourth')[c.first // WORD]}" for c in self.channels)
        return ", ".join(p + (o if self.words > 1 else "") for p, o in zip(places, owners, strict=True))

    @property
    def rule(self) -> str:
        """The rule by which a number becomes an integer, as a sentence; empty for floats with a channel each."""
        first = self.channels[0]
        if first.form:
            if not self.part:
                return ""
            return f"Each is a float of {first.form.exponent} exponent bits and {first.form.mantissa} mantissa bits."
        if first.share == "signed":
            half = first.integer // 2
            return f"Each is round(code * {half}) if code >= 0, else {half + 1} + round(-code * {half})."
        x = "(code / 2 + 1/2)" if self.numbers.is_biased else "code"
        scales = dict.fromkeys(str(c.integer) for c in self.channels)
        offset = f", plus {' or '.join(scales)}" if first.is_offset else ""
        return f"Each is {RULES[first.rounding].format(x=x, scale=' or '.join(scales))}{offset}."

    def context(self) -> dict[str, Any]:
        """Return the template's variables."""
        numbers = self.numbers
        return {
            "words": self.words,
            "has_sign": bool(numbers.sign_bits),
            "is_precise": numbers.is_precise,
            "settle": numbers.settle,
            "is_biased": numbers.is_biased,
            "is_centred": numbers.storage.is_centred,
            "rounds_itself": numbers.storage.is_centred or any(rounding != "nearest" for rounding in numbers.roundings),
            "channels": self.channels,
            "size": numbers.size,
            "layout": self.layout,
            "rule": self.rule,
            "target": numbers.target.title,
            "texels": [self._texel_text(word) for word in range(self.words)],
            "is_word": numbers.storage.is_word,
            **self._across_fields(),
        }

    def _across_fields(self) -> dict[str, Any]:
        """Return the template's variables for texels whose bits fill channels one by one; empty lists otherwise."""
        if not self.parts:
            return {"parts": [], "target_parts": []}
        size, each = self.numbers.storage.part, WORD // self.numbers.storage.part
        read = [self._read_part(i) for i in range(self.parts)]
        words = [range(word * each, min(self.parts, word * each + each)) for word in range(self.words)]
        joined = [" | ".join(_shifted_text(f"parts.{FIELDS[i]}", size * (i % each)) for i in w) for w in words]
        return {
            "parts": [(PARTS[i], self._part_text(i), read[i]) for i in range(self.parts) if self.part],
            "part_scale": f"{(1 << size) - 1}.0",
            "target_parts": [f"float({part})" for part in read] + ["0.0"] * (4 - self.parts),
            "from_parts": [part or "0u" for part in joined],
        }

    # The same in NumPy.

    def texel_words(self, integers: np.ndarray) -> np.ndarray:
        """Return the texels that hold numbers, uint32 of shape (count, words), from the bits of the numbers, of shape
        (count, numbers)."""
        words = np.zeros((len(integers), self.words), np.uint32)
        for index, channel in enumerate(self.channels):
            if not channel.pieces:
                words[:, channel.first // WORD] |= integers[:, index] << np.uint32(channel.first % WORD)
            for piece in channel.pieces:
                bits = integers[:, index] >> np.uint32(piece.below) & np.uint32((1 << piece.bits) - 1)
                place = piece.part * self.part
                words[:, place // WORD] |= bits << np.uint32(place % WORD + piece.left)
        return words

    def bits_in(self, words: np.ndarray, index: int) -> np.ndarray:
        """Return the bits of number `index` in texels, uint32 of shape (count,): the inverse of `texel_words`."""
        channel = self.channels[index]
        if not channel.pieces:
            word = words[:, channel.first // WORD]
            return word >> np.uint32(channel.first % WORD) & np.uint32((1 << channel.bits) - 1)
        integers = np.zeros(len(words), np.uint32)
        for piece in channel.pieces:
            place = piece.part * self.part
            bits = words[:, place // WORD] >> np.uint32(place % WORD + piece.left) & np.uint32((1 << piece.bits) - 1)
            integers |= bits << np.uint32(piece.below)
        return integers

    def part_in(self, words: np.ndarray, part: int) -> np.ndarray:
        """Return the integers in channel `part` of texels with numbers laid across it, uint32 of shape (count,)."""
        size = self.numbers.storage.part
        place = part * size
        return words[:, place // WORD] >> np.uint32(place % WORD) & np.uint32((1 << size) - 1)


def mask_text(bits: int) -> str:
    """Return the text of an unsigned integer whose lowest `bits` bits are set, in decimal: 15u for 4."""
    return f"{(1 << bits) - 1}u"


def _shifted_text(value: str, shift: int) -> str:
    return f"({value} << {shift})" if shift else value
