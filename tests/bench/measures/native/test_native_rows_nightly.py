"""Every codec measured by compiled C decodes to the same bits in XLA if XLA compiles exactly what is written."""

import pytest
from test_native_rows_slow import CODECS
from two_compilers import differences

from normalbench.bench.ground.native import library

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")


def test_c_and_xla_agree_on_every_codec():
    assert differences(CODECS) == {}
