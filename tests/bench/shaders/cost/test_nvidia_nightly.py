"""Instructions by NVIDIA's compiler of CUDA: what listings hold, what is compiled, and what a machine may lack."""

import test_nvidia_slow


def test_known_counts_of_nvidias_compiler_of_every_encoding(vendor_rows):
    test_nvidia_slow.test_known_counts_of_nvidias_compiler(vendor_rows, is_every=True)


def test_an_instruction_of_nvidias_is_16_bytes_and_none_spills_of_every_encoding(vendor_rows):
    test_nvidia_slow.test_an_instruction_of_nvidias_is_16_bytes_and_none_spills(vendor_rows, is_every=True)
