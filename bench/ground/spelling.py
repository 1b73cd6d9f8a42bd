"""Names as people type them: in capitals, with hyphens, as an API or a GPU vendor writes them, or nearly right."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from ...gbuffer.layouts.names import NAMES

# By what is named: other words for it, in lower case and without marks.
OTHER_WORDS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "language": {"metal": "msl"},
        "depth storage": {
            "d16unorm": "depth16",
            "d24unorms8uint": "depth24",
            "x8d24unorm": "depth24",
            "depth24plus": "depth24",
            "d32float": "depth32f",
            "d32sfloat": "depth32f",
            "unorm:24": "packed24",
        },
        "attribute": {
            **NAMES,
            **dict.fromkeys(("specular", "reflectance"), "f0"),
        },
        "encoding": {"oct": "octahedral", "hemioct": "hemi_octahedral"},
        "family": {
            "gcn4": "polaris10",
            "gcn5": "vega10",
            "rdna": "navi10",
            "rdna1": "navi10",
            "rdna2": "navi21",
            "rdna3": "navi31",
            "haswell": "hsw",
            "broadwell": "bdw",
            "skylake": "skl",
            "tigerlake": "tgl",
            "alderlake": "adl",
            "arc": "dg2",
            "arca770": "dg2",
            "turing": "sm_75",
            "ampere": "sm_86",
            "ada": "sm_89",
            "hopper": "sm_90",
            "blackwell": "sm_120",
            "amd": "radeon",
        },
    }
)


# What APIs and engines write before and behind the channels of a format: DXGI_FORMAT_R16G16_FLOAT, PF_G16R16F.
_API = re.compile(r"^(?:dxgi_?format|vk_?format|gl|mtlpixelformat|textureformat|graphicsformat|pf)[_.]?|_?pack\d+$")
_FORMAT = re.compile(r"((?:[rgba]+\d+f?_?)+?)_?(unorm|snorm|[us]?float|f)?")
_CHANNELS = re.compile(r"([rgba]+)(\d+)")
_KINDS: Mapping[str, str] = MappingProxyType({"unorm": "", "float": "f", "ufloat": "f", "sfloat": "f"})


# How alike a word must be to a name that it may have been meant for; of one with few letters one may be another.
ALIKE, SHORT, SHORT_ALIKE = 0.75, 4, 0.65


def plain(word: str) -> str:
    """Return a name in lower case without hyphens, underscores and spaces."""
    return "".join(letter for letter in word.lower() if letter not in "-_ ")


def spelled(what: str, word: str, known: Iterable[str]) -> str | None:
    """Return the known name that a word matches: a name that differs only in what `plain` ignores, a name with this
    alias among the aliases for `what` (such as "storage"), or a format with the same channels; None unless exactly
    one name matches."""
    known = list(known)
    if word in known:
        return word
    wanted = OTHER_WORDS.get(what, {}).get(plain(_API.sub("", word.lower())), word)
    matches = [name for name in known if plain(name) == plain(wanted)]
    if not matches and what.endswith("storage") and (channels := channels_of(word)):
        matches = [name for name in known if channels_of(name) == channels]
    return matches[0] if len(matches) == 1 else None


def channels_of(word: str) -> tuple[str, ...]:
    """Return a format's channels with their bits, red first, and then its number type, such as ("r16", "g16", "f")
    for RG16F; empty for a word that is not a format."""
    match = _FORMAT.fullmatch(_API.sub("", word.lower()))
    if not match:
        return ()
    bits = [f"{letter}{count}" for letters, count in _CHANNELS.findall(match[1]) for letter in letters]
    kind = match[2] or ("f" if "f" in match[1] else "")
    return (*sorted(bits, key=lambda channel: "rgba".index(channel[0])), _KINDS.get(kind, kind))


def meant(word: str, known: Iterable[str], what: str = "") -> str:
    """Return a hint for an unknown word, such as "did you mean rg8?" or how to separate several names; empty if
    no known name is similar.

    Args:
        what: the kind of name; some kinds have alternative words.
    """
    known = list(known)
    parts = [part for part in re.split(r"[\s;|+]+", word) if part]
    if len(parts) > 1 and all(part in known or "." in part for part in parts):
        return f"separate names by commas: {','.join(parts)}"
    from difflib import get_close_matches

    by_plain = {other: name for other, name in OTHER_WORDS.get(what, {}).items() if name in known}
    by_plain |= {plain(name): name for name in known}
    near = get_close_matches(plain(word), by_plain, n=1, cutoff=SHORT_ALIKE if len(word) <= SHORT else ALIKE)
    return f"did you mean {by_plain[near[0]]}?" if near else ""
