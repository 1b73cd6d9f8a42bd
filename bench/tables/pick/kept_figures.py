"""Cached figures of codecs."""

from __future__ import annotations

from typing import Any

import jax

from ....encodings.catalogue import is_in_catalogue
from ....encodings.codecs.codec import Codec
from ...ground.output.cache import key_of
from ...ground.output.sources import sources


def figures_key(what: str, codec: Codec, *parts: Any) -> str:
    """Return the cache key for a codec's figure; empty if the figure may change between runs: `parts` contains None,
    or the encoding is not in the catalogue."""
    if None in parts or not is_in_catalogue(codec.encoding):
        return ""
    return key_of("pick", what, sources(), jax.__version__, codec.name, *map(repr, parts))
