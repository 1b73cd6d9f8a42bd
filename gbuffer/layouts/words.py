"""The words of a layout: what lies in which bits of a render target.

A target is a format and a line of words that fill its bits in order, the most significant first. A word alone
(`albedo.r`) takes one whole channel and is converted as the format converts. A word with a number of bits (`depth:16`)
is an unsigned integer laid across channels of 8 bits. `-` leaves a channel free.

A quantity may carry a number of the normal's code that is 1 or -1 as its own sign: `roughness*normal.z`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ...encodings.storages.storage import FORMATS, MANTISSA, Storage

# The order is the G-buffer shaders' (gbuffer.glsl).
COMPONENTS = (
    *("normal.x", "normal.y", "normal.z", "depth", "albedo.r", "albedo.g", "albedo.b"),
    *("specular.r", "specular.g", "specular.b", "power", "roughness", "metalness", "reflectance", "occlusion"),
    *("emission.r", "emission.g", "emission.b", "kind", "instance", "motion.x", "motion.y"),
)
FREE = "-"
# What engines keep and this renderer does not use: it takes its bits. There may be several.
OTHER = "other"
# What may carry a sign: quantities that are not negative.
CARRIERS = ("depth", "power", "roughness")
COLOURS = ("albedo", "specular", "emission")
# How a number x in [0, 1] of the normal becomes one of 2^n codes: floor(x (2^n - 1 + widen) + bias). As `signed` it is
# the integer nearest c (2^(n-1) - 1) for c in [-1, 1], as SNORM has it, plus 2^(n-1) - 1.
SIGNED = "signed"
PACKINGS = {"nearest": (0.0, 0.5), "truncate": (0.0, 0.0), "truncate_half": (0.5, 0.0), SIGNED: (0.0, 0.5)}
MAX_PACKED_BITS = 24
# A Deferred ID tells four kinds apart, an instance is 1 to 255.
LEAST_BITS = {"kind": 2, "instance": 8}
# How far from 0 a carried sign keeps its number, in steps: NRD.hlsli has 1.5 / 512 of 10 bits.
SIGN_STEPS = 1.5
WORD = re.compile(r"([a-z.]+|-)(?:\*(normal\.[xyz]))?(?::(\d{1,2}))?")


class LayoutError(Exception):
    """A layout that cannot be: one line that says what clashes."""


@dataclass(frozen=True)
class Word:
    """One component in a target. `first` counts channels if `bits` is 0, and bits otherwise. `sign` is the number of
    the normal's code that it carries as its sign, or empty."""

    component: str
    target: int
    first: int
    bits: int
    sign: str = ""


@dataclass(frozen=True)
class Target:
    """A render target: the name of its format, and the words that fill it."""

    format: str
    holds: str

    @property
    def storage(self) -> Storage:
        return FORMATS[self.format]


def placed(layout: str, index: int, target: Target) -> Iterator[Word]:
    """Where each component of a target lies, the free and the unused ones left out.

    Args:
        layout: its name, for messages.
        index: which target of the layout it is.

    Raises:
        LayoutError: an unknown word, or one that does not fit.
    """
    place, storage, bit = place_of(layout, index, target), target.storage, 0
    for text in target.holds.split():
        name, sign, bits = _word_parts(place, text)
        if bits and name != OTHER:
            _check_packed(place, text, storage, bits)
        channel = len([end for end in _ends(storage) if end <= bit])
        if not bits and bit not in (0, *_ends(storage)):
            raise LayoutError(f"{place}: {text} starts within a channel; give it a number of bits")
        taken = bits or (storage.bits[channel] if channel < storage.channels else 1)
        if bit + taken > sum(storage.bits):
            raise LayoutError(f"{place}: {target.holds!r} takes more than its {sum(storage.bits)} bits")
        if channel < storage.curved and name.partition(".")[0] not in (*COLOURS, OTHER, FREE):
            raise LayoutError(f"{place}: {text}: the first three channels of {storage.title} hold colours")
        if name not in (FREE, OTHER):
            yield Word(name, index, bit if bits else channel, bits, sign)
        bit += taken


def place_of(layout: str, index: int, target: Target) -> str:
    """What messages call a target."""
    return f"layout {layout}, target {index} ({target.format})"


def _word_parts(place: str, text: str) -> tuple[str, str, int]:
    """The component of a word, the sign that it carries, and its bits."""
    match = WORD.fullmatch(text)
    if not match or match[1] not in (*COMPONENTS, OTHER, FREE):
        known = ", ".join((*COMPONENTS, OTHER, FREE))
        raise LayoutError(f"{place}: unknown component {text!r}; known: {known}")
    if match[3] and not int(match[3]):
        raise LayoutError(f"{place}: {text}: a word has at least 1 bit; without a number it has a channel")
    if match[2] and match[1] not in CARRIERS:
        raise LayoutError(f"{place}: {text}: only {', '.join(CARRIERS)} carry a sign")
    return match[1], match[2] or "", int(match[3] or 0)


def _check_packed(place: str, text: str, storage: Storage, bits: int) -> None:
    is_bytes = storage.kind == "unorm" and set(storage.bits) == {8} and not storage.curved
    if not is_bytes or bits > MAX_PACKED_BITS:
        raise LayoutError(f"{place}: {text}: up to {MAX_PACKED_BITS} bits may be packed, into channels of 8-bit UNORM")


def _ends(storage: Storage) -> list[int]:
    """The bit at which each channel ends."""
    return [sum(storage.bits[: channel + 1]) for channel in range(storage.channels)]


def least_carried(storage: Storage, bits: int) -> float:
    """The least share of [0, 1] that a number with a sign is kept at, so that rounding leaves the sign."""
    if storage.kind == "snorm":
        return 1.0 / (2 ** (bits - 1) - 1)
    if storage.kind == "unorm":
        return SIGN_STEPS / 2 ** (bits - 1)
    return SIGN_STEPS / 2 ** MANTISSA[bits] if storage.is_biased else 2.0**-14


def without_normal(holds: str) -> list[str]:
    """The words of a target, those of the normal left free so that the others keep their channels."""
    words = []
    for text in holds.split():
        if text.startswith("normal."):
            words.append(FREE + text[len("normal.x") :])
        else:
            words.append(re.sub(r"\*normal\.[xyz]", "", text))
    return words
