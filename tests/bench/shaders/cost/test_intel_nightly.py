"""Instructions from Intel's compilers: listings, comparable kernels and the null device."""

import test_intel_slow
from vendors import INTEL


def test_no_intel_kernel_spills(vendor_rows):
    assert {row["spills"] for row in vendor_rows(INTEL, True)} == {0}


def test_intels_compilers_give_the_known_counts_for_every_encoding(vendor_rows):
    test_intel_slow.test_intels_compilers_give_the_known_counts(vendor_rows, is_every=True)
