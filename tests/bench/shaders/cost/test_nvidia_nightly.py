"""Instructions by NVIDIA's CUDA compiler: listings, compiled code and missing tools."""

import test_nvidia_slow


def test_known_counts_of_nvidias_compiler_of_every_encoding(vendor_rows):
    test_nvidia_slow.test_known_counts_of_nvidias_compiler(vendor_rows, is_every=True)


def test_nvidia_instructions_are_16_bytes_and_no_encoding_spills(vendor_rows):
    test_nvidia_slow.test_nvidia_instructions_are_16_bytes_and_no_kernel_spills(vendor_rows, is_every=True)
