"""Instructions from NVIDIA's CUDA compiler: listings, compiled code and missing tools."""

import test_nvidia_slow


def test_nvidias_compiler_gives_the_known_counts_for_every_encoding(vendor_rows):
    test_nvidia_slow.test_nvidias_compiler_gives_the_known_counts(vendor_rows, is_every=True)


def test_nvidia_instructions_are_16_bytes_and_no_encoding_spills(vendor_rows):
    test_nvidia_slow.test_nvidia_instructions_are_16_bytes_and_no_kernel_spills(vendor_rows, is_every=True)
