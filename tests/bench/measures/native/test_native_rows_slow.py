"""Every codec measured by compiled C decodes to the same bits in XLA if XLA compiles exactly what is written."""

import pytest
from slowly import drawn_of
from test_native_rows import BY_XLA
from two_compilers import differences

from normalbench.bench.ground.native import library
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")

# A curved storage has a power, which C and XLA compute each in its way.
CODECS = [
    f"{name} {storage.name}"
    for name in ENCODINGS
    for storage in STORAGES.values()
    if name not in BY_XLA and not storage.curved and Codec(ENCODINGS[name], storage).fits
]


def test_c_and_xla_agree_on_twelve_codecs():
    assert differences(drawn_of(CODECS, 12)) == {}
