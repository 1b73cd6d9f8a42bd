"""Rows that the C compiler's code measures: those of XLA's code, whatever the set and the decodes are like."""

import pytest
import test_native_rows_slow
from test_native_rows_slow import NATIVE

from normalbench.bench.ground.native import library

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")


@pytest.mark.parametrize("name", NATIVE)
def test_all_rows_are_those_of_xla_in_a_second_format(name):
    test_native_rows_slow.test_rows_are_those_of_xla_in_a_second_format(name)
