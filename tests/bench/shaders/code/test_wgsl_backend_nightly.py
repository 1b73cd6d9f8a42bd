"""The quality table, measured by WGSL on Vulkan."""

import itertools

import pytest
import test_wgsl_backend
from test_wgsl_backend import row_of
from typed import codecs_named

from normalbench.bench.subjects.normals import normal_sets
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES

vulkan = test_wgsl_backend.vulkan


# Numbers of more bits than a float32's mantissa holds twice over are not compared by their PSNR.
TO_16_BITS = ",".join(name for name in STORAGES if name != "rgba32f")


@pytest.mark.usefixtures("vulkan", "gl")
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_three_backends_agree_within_two_hundredths_of_a_decibel(encoding):
    """Every storage of at most 16 bits per number is measured on uniform directions."""
    apart = []
    sets = normal_sets.NORMAL_SETS["hemisphere" if ENCODINGS[encoding].domain == "hemisphere" else "sphere"]
    normals = sets(2**14, 0)
    for codec in (codec for codec in codecs_named(encoding, TO_16_BITS, "nearest") if codec.fits):
        rows = [row_of(codec, backend, normals) for backend in ("jax", "glsl", "wgsl")]
        for row, other in itertools.combinations(rows, 2):
            if abs(row["psnr_db"] - other["psnr_db"]) > 0.02:
                apart.append((codec.name, row["backend"], row["psnr_db"], other["backend"], other["psnr_db"]))
    assert not apart, apart
