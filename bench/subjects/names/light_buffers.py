"""Light buffers by name, with an optional range and an optional storage in the name."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from ....encodings.catalogue import LIGHT_BUFFERS, LIGHT_ENCODINGS
from ....encodings.codecs.light_codec import LightCodec
from ....encodings.storages.storage import FORMATS
from ...ground.choose import choose
from ...ground.options.words import Word
from ...ground.output.errors import UsageError
from .storages import RULE, storages_named

LEAST_RANGE, MOST_LIGHT = 1e-3, 1e4
PLAIN = "plain"


def light_buffers_named(names: Iterable[Word]) -> list[LightCodec]:
    """Return the light codecs with these names; `linear:1` and `linear:range=1` cover [0, 1], and
    `linear/unorm:10:10:10` uses other bits. Bits alone, as in `ufloat:6:9`, store light unencoded.

    Raises:
        UsageError: a name is unknown, a range is invalid or not supported by the encoding, or a storage does not fit
            the encoding.
    """
    words = list(names)
    typed_codecs = {word: _said_codec(word) for word in words if isinstance(word, str) and (":" in word or "/" in word)}
    chosen = choose("light buffer", words, {**LIGHT_BUFFERS, **typed_codecs})
    return list({codec.name: codec for codec in chosen}.values())


def _said_codec(word: str) -> LightCodec:
    """Return the codec for a name with a range, a storage or both: `linear:1/unorm:10:10:10`. Raises UsageError."""
    name, is_in, storage = (PLAIN, "/", word) if RULE.match(word) else word.partition("/")
    codec = ranged_light_buffer(name) if ":" in name else LIGHT_BUFFERS.get(name) or _plain_codec(name, word)
    if not is_in:
        return codec
    chosen = storages_named((storage,), FORMATS, "light storage")
    if len(chosen) > 1:
        raise UsageError(f"light buffer {word}: names {len(chosen)} storages; name one")
    stored_codec = replace(codec, storage=chosen[0])
    if stored_codec.misfit:
        raise UsageError(f"light buffer {word}: {stored_codec.misfit}")
    return stored_codec


def _plain_codec(name: str, word: str) -> LightCodec:
    """Return the codec that stores light unencoded. Raises UsageError if the name is not the name of plain light."""
    if name != PLAIN:
        known = [*LIGHT_ENCODINGS]
        raise UsageError(f"light buffer {word}: expected one of {', '.join(known)}, as in linear/unorm:10:10:10")
    return next(codec for codec in LIGHT_BUFFERS.values() if codec.encoding.is_plain)


def ranged_light_buffer(word: str) -> LightCodec:
    """Return the light codec over the range in a name, such as `linear:1`.

    Raises:
        UsageError: the range is invalid, or the encoding does not support ranges.
    """
    name, text = name_and_range(word)
    known = {name: codec for name, codec in LIGHT_BUFFERS.items() if codec.encoding.ranged}
    codec = known.get(name)
    if not codec or not codec.encoding.ranged:
        raise UsageError(f"light buffer {word}: only {', '.join(known)} take a range, as in linear:1")
    return replace(codec, encoding=codec.encoding.ranged(range_in(f"light buffer {word}", text)))


def name_and_range(word: str) -> tuple[str, str]:
    """Return a name and the text of its range: `rgbm` and `8` for `rgbm:8` or `rgbm:range=8`. The text is empty
    without a range."""
    name, _, text = word.partition(":")
    return name.strip(), text.strip().removeprefix("range=")


def range_in(what: str, text: str) -> float:
    """Return the range that a text specifies. Raises UsageError, with a message that begins with `what`, for an
    invalid range."""
    try:
        limit = float(text)
    except ValueError:
        limit = math.nan
    if not LEAST_RANGE <= limit <= MOST_LIGHT:
        raise UsageError(f"{what}: the range must be {LEAST_RANGE:g} to {MOST_LIGHT:g}, as in NAME:1")
    # As its name has it: two ranges that are called the same are the same.
    return float(f"{limit:g}")
