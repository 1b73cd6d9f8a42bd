"""Archives and NumPy files that are damaged are refused, and nothing is unpacked that is larger than it may be."""

import tracemalloc
import zipfile

import numpy as np
import pytest
from test_arrays import npy

from normalbench.bench.ground.output.arrays import MOST_BYTES, DamagedError, array_of, read_npz


def test_what_would_grow_is_not_unpacked(tmp_path):
    """2 MB of zeros packed from 2 GB, and an array whose header says 8 TB."""
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
