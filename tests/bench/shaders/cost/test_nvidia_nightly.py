"""Instructions by NVIDIA's compiler of CUDA: what listings hold, what is compiled, and what a machine may lack."""

import pytest
import test_nvidia_slow


@pytest.mark.parametrize("is_every", [True], ids=["every"])
def test_known_counts_of_nvidias_compiler_of_every_encoding(vendor_rows, is_every):
    test_nvidia_slow.test_known_counts_of_nvidias_compiler(vendor_rows, is_every)


@pytest.mark.parametrize("is_every", [True], ids=["every"])
def test_an_instruction_of_nvidias_is_16_bytes_and_none_spills_of_every_encoding(vendor_rows, is_every):
    test_nvidia_slow.test_an_instruction_of_nvidias_is_16_bytes_and_none_spills(vendor_rows, is_every)
