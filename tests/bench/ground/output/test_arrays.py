"""Archives and NumPy files that are damaged are refused, and nothing is unpacked that is larger than it may be."""

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
def test_what_was_written_is_read(tmp_path, order):
    path = tmp_path / "a.npz"
    path.write_bytes(npz(**{name: np.asarray(array, order=order) for name, array in ARRAYS.items()}))
    for found, array in zip(read_npz(path, list(ARRAYS)), ARRAYS.values(), strict=True):
        assert np.array_equal(found, array) and found.dtype == array.dtype
    (tmp_path / "a.npy").write_bytes(npy(ARRAYS["mean"]))
    assert np.array_equal(read_npy(tmp_path / "a.npy", 4096), ARRAYS["mean"])
