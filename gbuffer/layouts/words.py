"""The words of a layout: the assignment of components to the bits of a render target.

A target is a format and a line of words that fill its bits in order, the most significant first. A word without a bit
count (`base_color.r`) takes one whole channel and is converted as the format converts. A word with a bit count
(`depth:16`) is an unsigned integer across the first channels of equal size in a UNORM or integer format. `-` leaves a
channel free.

The sign of a quantity may store a number of the normal's code that is 1 or -1: `roughness*normal.z`. A quantity may
also use a curve from the catalogue, over a range of its own: `squared(roughness)`, `linear:0.08(f0)`. A colour
without a channel means all of its channels: `square_root(base_color)`, `f0.rgb`. Light may be stored as a code of
four numbers that fill a texel: `rgb9e5(emissive)`. Engines' words are accepted as well (see `names.py`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ...encodings.storages.storage import FORMS, TARGET_FORMATS, Storage
from .kept import COLOURS, LIGHT, WHOLE, Kept, channels_of, kept_as, quantity_of
from .names import RefusedWordError, named

# The order is the G-buffer shaders' (gbuffer.glsl).
COMPONENTS = (
    *("normal.x", "normal.y", "normal.z", "depth", "base_color.r", "base_color.g", "base_color.b"),
    *("f0.r", "f0.g", "f0.b", "power", "roughness", "metallic", "f0", "ao"),
    *("emissive.r", "emissive.g", "emissive.b", "emissive.a", "shading_model", "instance", "motion.x", "motion.y"),
)
FREE = "-"
# What engines keep and this renderer does not use: it takes its bits. There may be several, and each may have a name
# of its own: `other.flags:4`.
OTHER = "other"
# What may carry a sign: quantities that are not negative.
CARRIERS = ("depth", "power", "roughness")
# How a number x in [0, 1] of the normal becomes one of 2^n codes: floor(x (2^n - 1 + widen) + bias). As `signed` it is
# the integer nearest c (2^(n-1) - 1) for c in [-1, 1], as SNORM has it, plus 2^(n-1) - 1.
SIGNED = "signed"
PACKINGS = {"nearest": (0.0, 0.5), "truncate": (0.0, 0.0), "truncate_half": (0.5, 0.0), SIGNED: (0.0, 0.5)}
MAX_PACKED_BITS = 24
# A Deferred ID tells four kinds apart, an instance is 1 to 255.
LEAST_BITS = {"shading_model": 2, "instance": 8, "motion.x": 2, "motion.y": 2}
# How far from 0 a carried sign keeps its number, in steps: NRD.hlsli has 1.5 / 512 of 10 bits.
SIGN_STEPS = 1.5
WORD = re.compile(
    r"(?:(?P<curve>\w+)(?::(?P<range>[^()\s]*))?\((?P<curved>[a-z][\w.]*)\)|(?P<name>[a-z][\w.]*|-))"
    r"(?:\*(?P<sign>normal\.[xyz]))?(?::(?P<bits>\d{1,2}))?"
)


class LayoutError(Exception):
    """An invalid layout; the message is one line that names the conflict."""


@dataclass(frozen=True)
class Word:
    """One component in a target. `first` counts channels if `bits` is 0, and bits otherwise. `sign` is the number of
    the normal's code that the component's sign stores, or empty. `kept` is the curve or the encoding of the
    component, or None. `label` is the name of an `other` field, or empty."""

    component: str
    target: int
    first: int
    bits: int
    sign: str = ""
    kept: Kept | None = None
    label: str = ""

    def bits_in(self, storage: Storage) -> int:
        """Return the bits that the component takes in a target of this storage: its own, or those of its channel."""
        return self.bits or storage.bits[self.first]


@dataclass(frozen=True)
class Target:
    """A render target: the name of its format, and the words that fill it."""

    format: str
    holds: str

    @property
    def storage(self) -> Storage:
        return TARGET_FORMATS[self.format]


def targets_of(text: str) -> tuple[Target, ...]:
    """Return the targets that a text lists, unchecked: `rg16f: normal.x normal.y; rgba8: base_color ao`."""
    return tuple(Target(*part.strip().split(": ", 1)) for part in text.split(";"))


def placed(layout_name: str, index: int, target: Target) -> Iterator[Word]:
    """Yield the `Word` of each component of a target, without free bits and `other` fields. Takes the same arguments
    and raises the same errors as `all_placed`."""
    return (word for word in all_placed(layout_name, index, target) if word.component != OTHER)


def all_placed(layout_name: str, index: int, target: Target) -> Iterator[Word]:
    """Yield the `Word` of each component of a target, and of each `other` field, which only engines use; skip free
    bits.

    Args:
        layout_name: the layout's name, for messages.
        index: the target's index in the layout.

    Raises:
        LayoutError: a word is unknown or does not fit.
    """
    place, storage, bit = place_of(layout_name, index, target), target.storage, 0
    for text in spelt_out(place, target):
        label = text.removeprefix(f"{OTHER}.").partition(":")[0] if text.startswith(f"{OTHER}.") else ""
        name, sign, bits, kept = _word_parts(place, text)
        if bits and name != OTHER:
            _check_packed(place, text, storage, bits, bit)
        channel = len([end for end in _ends(storage) if end <= bit])
        if not bits and bit not in (0, *_ends(storage)):
            raise LayoutError(f"{place}: {text} starts within a channel; give it a bit count")
        taken = bits or (storage.bits[channel] if channel < storage.channels else 1)
        if storage.is_integer and name not in (FREE, OTHER):
            bits = taken
            _check_packed(place, text, storage, bits, bit)
        if bit + taken > sum(storage.bits):
            raise LayoutError(f"{place}: {target.holds!r} needs more than its {sum(storage.bits)} bits")
        if channel < storage.curved and quantity_of(name) not in (*COLOURS, OTHER, FREE):
            raise LayoutError(f"{place}: {text}: the first three channels of {storage.title} can hold only colours")
        if channel < storage.curved and kept:
            raise LayoutError(f"{place}: {text}: {storage.title} already applies its own curve to colours")
        bits = taken if storage.is_integer else bits
        if name != FREE:
            yield Word(name, index, bit if bits else channel, bits, sign, kept, label)
        bit += taken


def place_of(layout_name: str, index: int, target: Target) -> str:
    """Return text that names a target in messages: "layout NAME, target INDEX (FORMAT)"."""
    return f"layout {layout_name}, target {index} ({target.format})"


def spelt_out(place: str, target: Target) -> Iterator[str]:
    """Yield the words of a target under the names in COMPONENTS; a colour without a channel becomes one word per
    channel. Raises LayoutError if a word is ambiguous, or if a code of light does not fill its target."""
    for typed in target.holds.split():
        text, match = _by_its_name(place, typed)
        name = (match["curved"] or match["name"]) if match else ""
        if match and match["curve"] in WHOLE and name.startswith(f"{LIGHT}."):
            raise LayoutError(f"{place}: {text}: write {match['curve']}({LIGHT}), which uses the whole target")
        if not match or name not in COLOURS:
            yield text
            continue
        is_whole = match["curve"] in WHOLE and name == LIGHT
        if is_whole and (target.holds.split()[0] != text or target.format not in WHOLE[match["curve"]].storages):
            known = ", ".join(WHOLE[match["curve"]].storages)
            raise LayoutError(f"{place}: {text} must be alone in its target, of format {known}")
        for component in (*channels_of(name), *([f"{name}.a"] if is_whole else [])):
            yield component.join(text.rsplit(name, 1))


def _by_its_name(place: str, typed: str) -> tuple[str, re.Match[str] | None]:
    """Return a word with its component's name from COMPONENTS, and the match of WORD; a malformed word unchanged,
    with None. Raises LayoutError if the word is ambiguous."""
    match = WORD.fullmatch(typed)
    name = (match["curved"] or match["name"]) if match else ""
    if not match or name == OTHER or name.startswith(f"{OTHER}."):
        return typed, match
    try:
        other = named(name, bool(match["curve"]))
    except RefusedWordError as error:
        raise LayoutError(f"{place}: {typed}: {error}") from error
    text = other.join(typed.rsplit(name, 1))
    return text, WORD.fullmatch(text)


def _word_parts(place: str, text: str) -> tuple[str, str, int, Kept | None]:
    """Return a word's component, the component of the normal in its sign (or ""), its bit count (or 0) and its curve
    (or None). Raises LayoutError."""
    match = WORD.fullmatch(text)
    name = (match["curved"] or match["name"]) if match else ""
    name = OTHER if name.startswith(f"{OTHER}.") else name
    if not match or name not in (*COMPONENTS, OTHER, FREE):
        if not match and set(text) & set("()"):
            raise LayoutError(f"{place}: {text}: write a curve as squared(roughness) or linear:0.08(f0):6")
        known = ", ".join((*COMPONENTS, OTHER, FREE))
        raise LayoutError(f"{place}: unknown component {name or text!r}; known: {known}")
    sign, bits = match["sign"] or "", int(match["bits"] or 0)
    if match["bits"] and not bits:
        raise LayoutError(f"{place}: {text}: a field has at least 1 bit; without a bit count it takes a whole channel")
    if sign and name not in CARRIERS:
        raise LayoutError(f"{place}: {text}: only {', '.join(CARRIERS)} can store a sign")
    try:
        kept = kept_as(match["curve"], match["range"], quantity_of(name)) if match["curve"] else None
    except ValueError as error:
        raise LayoutError(f"{place}: {text}: {error}") from error
    if kept and kept.is_whole and bits:
        raise LayoutError(f"{place}: {text}: each component of {kept.encoding.name} needs its own channel")
    return name, sign, bits, kept


def _check_packed(place: str, text: str, storage: Storage, bits: int, first: int) -> None:
    is_curved = first < sum(storage.bits[: storage.curved])
    if not storage.field_bits or is_curved or bits > MAX_PACKED_BITS:
        into = "UNORM or integer channels"
        raise LayoutError(f"{place}: {text}: a field can have up to {MAX_PACKED_BITS} bits, in {into}")
    if storage.field_bits < first + bits <= sum(storage.bits):
        within = f"the first {storage.field_bits} bits, whose channels have equal size"
        raise LayoutError(f"{place}: {text}: fields must be in {within}")


def _ends(storage: Storage) -> list[int]:
    """Return the number of bits up to the end of each channel: 8, 16, 24 and 32 for `rgba8`."""
    return [sum(storage.bits[: channel + 1]) for channel in range(storage.channels)]


def least_carried(storage: Storage, bits: int) -> float:
    """Return the smallest magnitude, as a share of [0, 1], at which a signed number may be stored so that rounding
    keeps its sign."""
    if storage.kind == "snorm":
        return 1.0 / (2 ** (bits - 1) - 1)
    if storage.kind == "unorm":
        return SIGN_STEPS / 2 ** (bits - 1)
    return SIGN_STEPS / 2 ** FORMS[bits].mantissa if storage.is_biased else 2.0**-14


def without_normal(holds: str) -> list[str]:
    """Return a target's words, given as one text, with the normal's words replaced by free bits and without signs
    that store the normal; other words keep their channels."""
    words = []
    for text in holds.split():
        if text.startswith("normal."):
            words.append(FREE + text[len("normal.x") :])
        else:
            words.append(re.sub(r"\*normal\.[xyz]", "", text))
    return words
