"""Damaged archives and NumPy files are refused, and nothing beyond the size limit is unpacked."""

import tracemalloc
import zipfile

import numpy as np
import pytest
from test_arrays import npy

from normalbench.bench.ground.output.arrays import MOST_BYTES, DamagedError, array_of, read_npz


def test_files_that_would_unpack_beyond_the_limit_are_not_unpacked(tmp_path):
    """One file packs 2 GB of zeros into 2 MB; the header of an array claims 8 TB."""
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("mean.npy", "w") as file:
        for _ in range(2 * MOST_BYTES >> 20):
            file.write(bytes(1 << 20))
    tracemalloc.start()
    with pytest.raises(DamagedError):
        read_npz(path, ["mean"])
    with pytest.raises(DamagedError):
        array_of(npy(np.zeros(3)).replace(b"(3,), ", b"(1099511627776,), ").replace(b" " * 12, b""))
    with pytest.raises(DamagedError):
        array_of(npy(np.array([None], dtype=object)))
    assert tracemalloc.get_traced_memory()[1] < 4 << 20
    tracemalloc.stop()
