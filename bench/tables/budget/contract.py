"""The attributes that a G-buffer stores, as named by `--hold`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from ...ground.options.words import Names, Word
from ...ground.output.errors import UsageError
from ...ground.spelling import spelled
from .attributes import EMISSION, MOST_PART, NORMAL, SEEN, Attribute, exact_bits, motion

# Attributes of bits that come back as they are, with the word that a layout has for them.
EXACT: Mapping[str, str] = MappingProxyType(
    {
        "shading_model": "shading_model",
        "flags": "other.flags",
        "shadow": "other.shadow",
        "custom": "other.custom",
        "other": "other",
    }
)
# A frame of a tangent: an angle around the normal and a hand.
TANGENT = exact_bits("tangent", "other.tangent", 8)
MOTION, PACKED, IN_LIGHT, STENCIL = "motion", "motion:packed", "emissive:light", "stencil"
MOST_BITS = 64
# What hardware can test before shading.
IN_STENCIL = ("shading_model", "flags")
KNOWN = (
    *(*SEEN, MOTION, PACKED, EMISSION.name, IN_LIGHT, TANGENT.name),
    *(f"{name}:BITS" for name in EXACT),
    *(f"{name}:{STENCIL}" for name in IN_STENCIL),
)
# What words are made of, here and in the options that name what is held.
NAMES = dict.fromkeys(name for word in (*KNOWN, *EXACT, "depth", "all", "none") for name in word.split(":"))


def as_known(words: Iterable[Word]) -> Names:
    """Return words of attributes, joined by + or :, with known names in their standard spelling; other names are
    unchanged."""
    known = re.compile(r"[^+:]+")
    return tuple(
        known.sub(lambda match: spelled("attribute", match[0], NAMES) or match[0], str(word)) for word in words
    )


def attributes_held(words: Names, speed: float) -> list[Attribute]:
    """Return the attributes that the words of --hold name, without attributes in the light buffer or the stencil.

    Args:
        speed: the maximum motion, in pixels per frame.

    Raises:
        UsageError: an attribute is unknown or named twice, or the normal is missing.
    """
    attributes = [_attribute(str(word), speed) for word in words]
    held = [attribute for attribute in attributes if attribute]
    names = [attribute.name for attribute in held]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise UsageError(f"--hold: {twice} is named twice; name it once")
    if NORMAL not in names:
        raise UsageError(f"--hold: {NORMAL} is missing; name for example {NORMAL},roughness")
    return held


def _attribute(word: str, speed: float) -> Attribute | None:
    """Return the attribute that a word of `--hold` names; None if it takes no bytes here. Raises UsageError."""
    name, _, size = word.partition(":")
    # What lies in the light buffer or in the stencil takes no bytes here.
    if word == IN_LIGHT or (name in IN_STENCIL and size == STENCIL):
        return None
    if word in (MOTION, PACKED):
        return motion(speed, word == PACKED)
    if not size and name in (*SEEN, EMISSION.name, TANGENT.name):
        return {**SEEN, EMISSION.name: EMISSION, TANGENT.name: TANGENT}[name]
    if name not in EXACT:
        raise UsageError(f"--hold {word}: unknown; known: {', '.join(KNOWN)}")
    if not size.isdigit() or not 1 <= int(size) <= MOST_BITS:
        raise UsageError(f"--hold {word}: {name} takes 1 to {MOST_BITS} bits, such as {name}:4")
    layout_word = EXACT[name]
    if layout_word == "shading_model" and not 2 <= int(size) <= MOST_PART:
        raise UsageError(f"--hold {word}: a shading model takes 2 to {MOST_PART} bits")
    return exact_bits(name, layout_word, int(size))


def held_in_stencil(words: Names) -> list[str]:
    """Return the attributes that the words of --hold place in the stencil."""
    return [name for name in IN_STENCIL if f"{name}:{STENCIL}" in words]


def names_held(option: str, words: Names | None, held: Sequence[str]) -> list[str]:
    """Return the attributes that an option names, without depth. Raises UsageError for an attribute not in --hold."""
    names = [str(word) for word in words or () if word != "depth"]
    for word in names:
        if word not in held:
            raise UsageError(f"{option} {word}: not in --hold; in --hold: {', '.join(held)}")
    return names
