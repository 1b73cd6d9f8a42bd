"""Codes that are unused, duplicate or unstable, compared with independent counts."""

import itertools
import math

import numpy as np
import pytest
from exact_codes import fibonacci, nearest_of, storage

from normalbench.bench.measures.worst_case.odd_codes import odd_codes
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import R11G11B10F, STORAGES


def test_xy_leaves_the_corners_of_the_square_unused():
    """A cell is unused if its point nearest to the centre is outside the unit disk."""
    numbers = np.arange(256) / 255 * 2 - 1
    nearest = np.maximum(np.abs(numbers) - 1 / 255, 0)
    beyond = int((nearest[:, None] ** 2 + nearest[None, :] ** 2 > 1).sum())
    odd = odd_codes(Codec(ENCODINGS["xy"], STORAGES["rg8"]), True)
    assert odd and odd.unused == beyond == 13924


def test_most_codes_of_three_numbers_are_unused_or_duplicate():
    """In SNORM of 5 bits, cells that the unit sphere crosses are used, and lattice points hidden behind another point
    are duplicates. The code 0, which is not a direction, counts as +z."""
    scale = 15
    lattice = np.array(list(itertools.product(range(-scale, scale + 1), repeat=3)))
    # The outermost cells end at 1 and have no outside.
    low = np.maximum(np.abs(lattice) - 0.5, 0) / scale
    high = np.minimum(np.abs(lattice) + 0.5, scale) / scale
    met = ((low**2).sum(axis=1) < 1) & ((high**2).sum(axis=1) > 1)
    visible = sum(math.gcd(*point) == 1 for point in lattice.tolist())
    odd = odd_codes(Codec(ENCODINGS["xyz_renormalised"], storage("snorm", 5, 5, 5)))
    assert odd and odd.unused == int((~met).sum())
    assert odd.duplicate == len(lattice) - visible
    assert odd.unstable <= int(met.sum()), "what nothing makes does not come back as another"


def test_a_pole_takes_a_whole_row_of_codes():
    """In `spherical`, the 256 angles at each pole are one direction, and the other 254 rows have the seam twice."""
    odd = odd_codes(Codec(ENCODINGS["spherical"], STORAGES["rg8"]))
    assert odd and (odd.unused, odd.duplicate) == (0, 2 * 255 + 254)


def test_a_lattice_wastes_no_codes():
    odd = odd_codes(Codec(nearest_of(fibonacci(256), 16), storage("unorm", 4, 4)))
    assert odd and (odd.unused, odd.duplicate, odd.unstable) == (0, 0, 0)


def test_truncation_does_not_reproduce_its_own_codes():
    """In float32 a truncated number is often slightly below its exact value, and is truncated again."""
    odd = odd_codes(Codec(ENCODINGS["octahedral"], STORAGES["rg8"], "truncate"))
    assert odd and odd.unstable > 20000


def test_the_border_of_the_octahedron_has_duplicate_codes():
    """Each border code has a mirror image, except the middles of SNORM's sides; the four corners are all -z. A round
    trip gives one code of each pair."""
    unorm, snorm = (odd_codes(Codec(ENCODINGS["octahedral"], STORAGES[name])) for name in ("rg8", "rg8_snorm"))
    assert unorm and snorm and unorm.unused == snorm.unused == 0
    assert unorm.duplicate == (4 * 255 - 4) // 2 + 3 and snorm.duplicate == (4 * 254 - 4 - 4) // 2 + 3
    assert unorm.unstable == unorm.duplicate


@pytest.mark.drawn(3)
@pytest.mark.parametrize("storage", [*STORAGES.values(), R11G11B10F], ids=lambda s: s.name)
def test_numbers_of_a_storage_are_stored_unchanged(storage):
    """Each number is stored unchanged in float32 and float64, and their count is as stated."""
    import jax
    import jax.numpy as jnp

    from normalbench.encodings.storages.rounding import store_number

    # The first channel of each size: of another one as large the numbers are the same.
    for channel in [storage.bits.index(bits) for bits in dict.fromkeys(storage.bits)]:
        if storage.bits[channel] == 32:
            continue
        numbers = storage.numbers(channel)
        assert len(numbers) == storage.count(channel) and np.all(np.diff(numbers) > 0)
        with jax.enable_x64(True):
            exact = np.asarray(store_number(jnp.asarray(numbers), storage, channel))
            assert exact == pytest.approx(numbers, abs=1e-15)
        short = np.asarray(store_number(jnp.asarray(numbers, jnp.float32), storage, channel))
        assert short == pytest.approx(numbers, abs=1e-6)
