"""Rows that the C compiler's code measures: those of XLA's code, whatever the set and the decodes are like."""

import pytest
import test_native_rows
from slowly import a_tenth
from test_native_rows import BY_XLA

from normalbench.bench.ground.native import library
from normalbench.encodings.catalogue import ENCODINGS

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")


NATIVE = sorted(set(ENCODINGS) - BY_XLA)


@pytest.mark.parametrize("name", a_tenth(NATIVE))
def test_rows_are_those_of_xla_in_a_second_format(name):
    test_native_rows.test_rows_are_those_of_xla(name, 1)
