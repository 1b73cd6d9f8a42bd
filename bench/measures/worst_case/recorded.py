"""Recorded suprema of the catalogue's codecs, from an earlier search."""

from __future__ import annotations

from pathlib import Path

from ....encodings.codecs.codec import Codec
from ..recorded import Recorded
from .search import Worst, worst_case

SUPREMA = Recorded(
    Path(__file__).with_name("suprema.json"),
    [f"bench/measures/worst_case/{name}.py" for name in ("search", "cells", "climb", "exact_codec")],
)


def supremum(codec: Codec, is_half: bool) -> Worst:
    """Return a codec's largest error over the sphere, or over z >= 0 if `is_half`: the recorded error if it was
    computed from the same sources, else the result of `worst_case`."""
    if known := SUPREMA.find(name_of(codec, is_half), codec):
        return Worst(known["angle_deg"], tuple(known["normal"]), known["found_by"], known["moved_deg"])
    return worst_case(codec, is_half)


def name_of(codec: Codec, is_half: bool) -> str:
    """Return the name under which a supremum is recorded."""
    return f"{codec.name} {'hemisphere' if is_half else 'sphere'}"
