"""Code of every codec as an engine programmer would paste it: short names and lines, and loops over tables unrolled."""

import pytest
from test_readable import EVERY, check, codecs_of

from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.encodings.codecs.kind import NORMAL
from normalbench.encodings.storages.storage import (
    CURVE_STORAGES,
    FRAME_STORAGES,
    LIGHT_STORAGES,
    MOTION_STORAGES,
)

# Storages whose functions are the longest: bytes, bits across channels, floats, signed numbers, two words.
SOME = "rg8,rgba8,rgb8_12_12,rg16f,rgba8_10_10_10_snorm"


OF_KIND = {"motion": MOTION_STORAGES, "curve": CURVE_STORAGES, "light": LIGHT_STORAGES, "frame": FRAME_STORAGES}


@pytest.mark.parametrize("kind, name", EVERY, ids=[f"{kind.word}-{name}" for kind, name in EVERY])
def test_code_in_other_storages_has_short_names_and_lines(kind, name):
    """In every language, and in another storage than the encoding before; at night in all of them."""
    codecs = in_other_storages(kind, name)
    check([codecs[EVERY.index((kind, name)) % len(codecs)]], LANGUAGES)


def in_other_storages(kind, name) -> list:
    """The codecs of an encoding in storages of its kind."""
    return codecs_of(kind, name, SOME if kind is NORMAL else ",".join(OF_KIND.get(kind.word, ())))
