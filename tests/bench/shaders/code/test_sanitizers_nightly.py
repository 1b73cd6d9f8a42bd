"""Generated C with arbitrary input: no undefined behaviour, and the same results at each optimisation level."""

import pytest
from languages import require_runner
from test_sanitizers_slow import codec_of, ran
from typed import codecs_named

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_c_code_of_every_encoding_and_storage_is_well_defined_for_any_input(encoding, tmp_path):
    """Each encoding takes every third storage that fits, from a different start, so that every storage is covered."""
    require_runner("c")
    codecs = [codec for codec in codecs_named(encoding, ",".join(STORAGES), "nearest") if codec.fits]
    complaints = [ran(codec, tmp_path) for codec in codecs[list(ENCODINGS).index(encoding) % 3 :: 3]]
    assert not any(complaints), complaints


def test_c_code_that_reads_the_largest_table_is_well_defined_for_any_input(tmp_path):
    """The header has a million numbers; the test above may skip it."""
    require_runner("c")
    complaint = ran(codec_of("best_fit/rgba8"), tmp_path)
    assert not complaint, complaint
