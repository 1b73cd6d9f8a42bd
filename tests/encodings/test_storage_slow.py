"""Storage: the emulation and the OpenGL device store the same bits."""

import itertools
from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest
from slowly import a_tenth
from test_storage import assert_same_texels, integer_inputs, rounded_in_the_shader

from normalbench.encodings.storages.rounding import (
    store_number,
)
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import ROUNDINGS, STORAGES
from normalbench.encodings.storages.words import words

PACKED = [s for s in STORAGES.values() if s.is_packed]


BY_RULE = [by_rule(kind, (bits, bits)) for kind in ("unorm", "snorm", "snorm_full") for bits in range(2, 17)]


# Four numbers of more than 32 bits together lie across channels of 16.
OF_16 = [by_rule("unorm", bits) for bits in ((20, 20, 20), (12, 12, 12, 12), (1, 20, 17, 19))]


BY_RULE += OF_16


def params(pairs) -> list:
    return [pytest.param(storage, rounding, id=f"{storage.name} {rounding}") for storage, rounding in pairs]


# Every way that numbers lie across channels, of 8 and of 16 bits; the other roundings and lengths are drawn.
NEAREST = [(storage, ROUNDINGS[0]) for storage in (*PACKED, *OF_16)]


DRAWN = [*itertools.product(PACKED, ROUNDINGS[1:])]


DRAWN += [(storage, ROUNDINGS[0]) for storage in BY_RULE if storage.is_packed and storage not in OF_16]


@pytest.mark.parametrize("storage, rounding", params([*NEAREST, *a_tenth(DRAWN)]))
def test_numbers_across_channels_match_the_emulation(gl, storage, rounding):
    """The inputs are every code of every number and every tie. All numbers of a texel have the same value."""
    values = integer_inputs(storage)
    with np.errstate(over="ignore"):
        values = values * 2 - 1 if storage.is_biased else values
    got = rounded_in_the_shader(gl, values, storage, rounding)
    for channel in range(storage.channels):
        expected = np.asarray(store_number(jnp.asarray(values), storage, channel, rounding))
        held = partial(words, storage=storage, channel=channel)
        what = f"{storage.name}, number {channel}, {rounding}"
        assert_same_texels(gl, values, expected, got[:, channel].copy(), held, what)
