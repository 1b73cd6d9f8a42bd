"""Codes that are wasted or come back as others, against what can be counted otherwise."""

from normalbench.bench.measures.worst_case.odd_codes import odd_codes
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def test_beyond_24_bits_nobody_counts():
    assert odd_codes(Codec(ENCODINGS["octahedral"], STORAGES["rg16"])) is None
