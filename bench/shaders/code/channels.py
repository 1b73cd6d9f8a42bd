"""Where a storage keeps each number of a code, as the functions of storage.glsl.j2 say it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ....encodings.codecs.codec import Codec

TEMPLATE = Path(__file__).with_name("storage.glsl.j2")
FIELDS, WORD, BYTE = "xyzw", 32, 8
RULES: Mapping[str, str] = MappingProxyType(
    {
        "nearest": "the integer nearest to {x} {scale}, of two as near the even one",
        "truncate": "{x} {scale} cut off toward zero",
        "truncate_half": "{x} ({scale} + 1/2) cut off toward zero, {scale} at most",
    }
)


@dataclass(frozen=True)
class Channel:
    """One number of a code in its storage.

    Attributes:
        name: x, y, z or w.
        kind: as the storage's.
        bits: its bits.
        first: its lowest bit among all bits of the texel; where numbers are laid across bytes, of the bytes read as one
            number, the first byte the highest.
        integer: the integer that stands for 1.
        rounding: one of `storage.ROUNDINGS`.
        is_across: it is laid across bytes.
        words: how many words the texel has.
    """

    name: str
    kind: str
    bits: int
    first: int
    integer: int
    rounding: str
    is_across: bool
    words: int

    @property
    def scale(self) -> str:
        return f"{self.integer}.0"

    @property
    def mask(self) -> str:
        return f"{(1 << self.bits) - 1}u"

    @property
    def truncates(self) -> str:
        return "false" if self.rounding == "nearest" else "true"

    def rounded(self, x: str) -> str:
        """x in [-1, 1] as a whole number."""
        if self.rounding == "nearest":
            return f"roundEven({x} * {self.scale})"
        if self.rounding == "truncate":
            return f"trunc({x} * {self.scale})"
        return f"clamp(trunc({x} * {self.integer}.5), -{self.scale}, {self.scale})"

    @property
    def _word_name(self) -> str:
        return "bits" if self.is_across else "texel" + (f".{FIELDS[self.first // WORD]}" if self.words > 1 else "")

    @property
    def read(self) -> str:
        """Its bits, from the word that holds them."""
        shift = self.first if self.is_across else self.first % WORD
        moved = f"{self._word_name} >> {shift}" if shift else self._word_name
        return f"({moved} & {self.mask})" if self.bits < WORD else self._word_name

    @property
    def signed(self) -> str:
        """Its bits as the highest of a word."""
        shift = WORD - self.bits - self.first % WORD
        return f"{self._word_name} << {shift}" if shift else self._word_name

    @property
    def placed(self) -> str:
        """Its bits where they lie."""
        shift = self.first if self.is_across else self.first % WORD
        return f"{self.name} << {shift}" if shift else self.name


@dataclass(frozen=True)
class Channels:
    """A codec's storage, as the template asks for it."""

    codec: Codec

    @property
    def words(self) -> int:
        """How many integers of 32 bits a texel is: 1, 2 or 4."""
        return -(-sum(self.codec.storage.bits) // WORD)

    @property
    def has_sign(self) -> bool:
        return bool(self.codec.encoding.sign_bits)

    @property
    def bytes(self) -> int:
        """How many bytes numbers are laid across."""
        return -(-sum(self.codec.storage.bits) // BYTE)

    @cached_property
    def channels(self) -> list[Channel]:
        """Where each number of the code is kept."""
        storage, count = self.codec.storage, self.codec.encoding.components
        return [
            Channel(
                FIELDS[at],
                storage.kind,
                storage.bits[at],
                self._first_bit(at),
                storage.scale(at),
                self.codec.rounding_of(at),
                storage.is_packed,
                self.words,
            )
            for at in range(count)
        ]

    def _first_bit(self, at: int) -> int:
        bits = self.codec.storage.bits
        return BYTE * self.bytes - sum(bits[: at + 1]) if self.codec.storage.is_packed else sum(bits[:at])

    def _texel_text(self, word: int) -> str:
        return " | ".join(c.placed for c in self.channels if c.first // WORD == word) or "0u"

    @property
    def layout(self) -> str:
        """Where the numbers are, in words."""
        if self.codec.storage.is_packed:
            spread = ", then ".join(f"{c.bits} bits of {c.name}" for c in self.channels)
            return f"{spread}, from the highest bit of the first byte on"
        places = (f"{c.name} in bits {c.first % WORD} to {c.first % WORD + c.bits - 1}" for c in self.channels)
        owners = (f" of the {('first', 'second', 'third', 'fourth')[c.first // WORD]}" for c in self.channels)
        return ", ".join(p + (o if self.words > 1 else "") for p, o in zip(places, owners, strict=True))

    @property
    def rule(self) -> str:
        """How a number becomes an integer, in words."""
        storage, first = self.codec.storage, self.channels[0]
        if storage.kind == "float":
            return ""
        x = "(code / 2 + 1/2)" if storage.is_biased else "code"
        scales = dict.fromkeys(str(c.integer) for c in self.channels)
        return f"Each is {RULES[first.rounding].format(x=x, scale=' or '.join(scales))}."

    def context(self) -> dict[str, Any]:
        """What the template is given."""
        return {
            "words": self.words,
            "has_sign": self.has_sign,
            "is_precise": self.codec.encoding.is_precise,
            "is_biased": self.codec.storage.is_biased,
            "is_packed": self.codec.storage.is_packed,
            "rounds_itself": self.codec.rounding != "nearest",
            "channels": self.channels,
            "layout": self.layout,
            "rule": self.rule,
            "target": self.codec.storage.target.title,
            "texels": [self._texel_text(word) for word in range(self.words)],
            **(self._across_fields() if self.codec.storage.is_packed else {}),
        }

    def _across_fields(self) -> dict[str, Any]:
        """What the template is given of numbers that are laid across bytes."""
        count = self.bytes
        shifts = [(BYTE * (count - 1 - at), BYTE * at) for at in range(count)]
        return {
            "bits_of": " | ".join(c.placed for c in self.channels),
            "bytes_of": " | ".join(_shifted_text(_byte_text("bits", high), low) for high, low in shifts),
            "joined": " | ".join(_shifted_text(_byte_text("texel", low), high) for high, low in shifts),
            "target_bytes": [f"float({_byte_text('texel', low)})" for _, low in shifts] + ["0.0"] * (4 - count),
            "from_bytes": " | ".join(_shifted_text(f"bytes.{FIELDS[at]}", low) for at, (_, low) in enumerate(shifts)),
        }


def _byte_text(word: str, shift: int) -> str:
    return f"({word} >> {shift} & 255u)" if shift else f"({word} & 255u)"


def _shifted_text(value: str, shift: int) -> str:
    return f"{value} << {shift}" if shift else value
