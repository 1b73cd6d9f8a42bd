"""Instructions by Intel's compilers: what listings hold, which kernels compare, and the device that is not there."""

import test_intel_slow


def test_known_counts_of_intels_compilers_of_every_encoding(vendor_rows):
    test_intel_slow.test_known_counts_of_intels_compilers(vendor_rows, is_every=True)
