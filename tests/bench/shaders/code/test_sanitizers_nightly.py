"""C in somebody's engine: whatever it is given, nothing undefined happens, and the same comes back."""

import pytest
from languages import require_runner
from test_sanitizers_slow import ran

from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_c_of_every_codec_is_defined_for_every_float(encoding, tmp_path):
    require_runner("c")
    said = [ran(codec, tmp_path) for codec in codecs_named(encoding, ",".join(STORAGES), "nearest") if codec.fits]
    assert not any(said), said
