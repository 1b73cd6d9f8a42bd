"""Codes that are wasted or come back as others, against what can be counted otherwise."""

import itertools
import math

import numpy as np
import pytest
from exact_codes import fibonacci, nearest_of, storage

from normalbench.bench.measures.worst_case.odd_codes import odd_codes
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import R11G11B10F, STORAGES


def test_x_and_y_leave_the_corners_of_the_square_unused():
    """Unused are the cells that do not meet the unit disk: whose point nearest the centre is beyond it."""
    numbers = np.arange(256) / 255 * 2 - 1
    nearest = np.maximum(np.abs(numbers) - 1 / 255, 0)
    beyond = int((nearest[:, None] ** 2 + nearest[None, :] ** 2 > 1).sum())
    odd = odd_codes(Codec(ENCODINGS["xy"], STORAGES["rg8"]), True)
    assert odd and odd.unused == beyond == 13924


def test_most_codes_of_three_numbers_are_no_directions_of_their_own():
    """SNORM of 5 bits: cubes that the unit sphere meets, and points of the lattice seen from its centre. The code 0,
    which is none, is counted with +z."""
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


def test_a_pole_is_a_row_of_codes():
    """spherical: 256 angles at each pole are one direction, and the seam is there twice in the other 254 rows."""
    odd = odd_codes(Codec(ENCODINGS["spherical"], STORAGES["rg8"]))
    assert odd and (odd.unused, odd.duplicate) == (0, 2 * 255 + 254)


def test_a_lattice_wastes_nothing():
    odd = odd_codes(Codec(nearest_of(fibonacci(256), 16), storage("unorm", 4, 4)))
    assert odd and (odd.unused, odd.duplicate, odd.unstable) == (0, 0, 0)


def test_truncation_does_not_give_back_what_it_was_given():
    """A number that was cut off is a hair below itself in float32 as often as not, and is cut off again."""
    odd = odd_codes(Codec(ENCODINGS["octahedral"], STORAGES["rg8"], "truncate"))
    assert odd and odd.unstable > 20000


def test_the_octahedrons_border_is_there_twice():
    """Each border code but the middles of SNORM's sides has a mirror image; the four corners are -z. Of two that mean
    the same one comes back."""
    unorm, snorm = (odd_codes(Codec(ENCODINGS["octahedral"], STORAGES[name])) for name in ("rg8", "rg8_snorm"))
    assert unorm and snorm and unorm.unused == snorm.unused == 0
    assert unorm.duplicate == (4 * 255 - 4) // 2 + 3 and snorm.duplicate == (4 * 254 - 4 - 4) // 2 + 3
    assert unorm.unstable == unorm.duplicate


@pytest.mark.drawn(3)
@pytest.mark.parametrize("storage", [*STORAGES.values(), R11G11B10F], ids=lambda s: s.name)
def test_a_storages_numbers_are_what_it_gives_back(storage):
    """Each is stored as itself in float32 and in float64, and there are as many as are said to be."""
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
