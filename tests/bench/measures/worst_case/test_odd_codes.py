"""Codes that are unused, duplicate or unstable, compared with independent counts."""

from normalbench.bench.measures.worst_case.odd_codes import odd_codes
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def test_codes_of_more_than_24_bits_are_not_counted():
    assert odd_codes(Codec(ENCODINGS["octahedral"], STORAGES["rg16"])) is None
