"""Damaged archives and NumPy files are refused, and nothing beyond the size limit is unpacked."""

import io

import numpy as np
import pytest
from attack.files import ARRAYS

from normalbench.bench.ground.output.arrays import read_npy, read_npz


def npz(**arrays) -> bytes:
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def npy(array) -> bytes:
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


@pytest.mark.parametrize("order", ["C", "F"])
def test_written_arrays_are_read_back(tmp_path, order):
    path = tmp_path / "a.npz"
    path.write_bytes(npz(**{name: np.asarray(array, order=order) for name, array in ARRAYS.items()}))
    for loaded, array in zip(read_npz(path, list(ARRAYS)), ARRAYS.values(), strict=True):
        assert np.array_equal(loaded, array) and loaded.dtype == array.dtype
    (tmp_path / "a.npy").write_bytes(npy(ARRAYS["mean"]))
    assert np.array_equal(read_npy(tmp_path / "a.npy", 4096), ARRAYS["mean"])
