"""Codes that are wasted or come back as others, against what can be counted otherwise."""

import numpy as np
import pytest

from normalbench.bench.measures.worst_case.odd_codes import odd_codes
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import R11G11B10F, STORAGES


def test_the_octahedrons_border_is_there_twice():
    """Each border code but the middles of SNORM's sides has a mirror image; the four corners are -z. Of two that mean
    the same one comes back."""
    unorm, snorm = (odd_codes(Codec(ENCODINGS["octahedral"], STORAGES[name])) for name in ("rg8", "rg8_snorm"))
    assert unorm and snorm and unorm.unused == snorm.unused == 0
    assert unorm.duplicate == (4 * 255 - 4) // 2 + 3 and snorm.duplicate == (4 * 254 - 4 - 4) // 2 + 3
    assert unorm.unstable == unorm.duplicate


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
