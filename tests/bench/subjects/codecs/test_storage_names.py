"""Storages by rule: the catalogue's where there is one, ranges, and what cannot be."""

import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.names import storages_named


@pytest.mark.parametrize(
    "said, names",
    [
        ("unorm:8:8,snorm:16:16,unorm:10:10:10:2", "rg8 rg16_snorm rgb10a2"),
        ("unorm:9:7", "rg8_9_7"),
        ("snorm:7:7", "rg8_7_7_snorm"),
        ("unorm:12:12:7:1", "rgba8_12_12_7_1"),
        ("unorm:6:6..9:9", "rg8_6_6 rg8_7_7 rg8 rgb8_9_9"),
        ("unorm:10:10:2..12:12:4", "rgb8_10_10_2 rgba8_11_11_3 rgba8_12_12_4"),
        ("rg8,unorm:8:8", "rg8"),
    ],
)
def test_bits_name_a_storage(said, names):
    assert " ".join(storage.name for storage in storages_named(said)) == names


@pytest.mark.parametrize(
    "said, message",
    [
        ("unorm:0:8", "numbers of 1 to 20 bits, 32 altogether, not 0:8"),
        ("unorm:33:2", "numbers of 1 to 20 bits, 32 altogether, not 33:2"),
        ("unorm:16:17", "32 altogether, not 16:17"),
        ("unorm:8", "two to four numbers"),
        ("unorm:8:8..6:6", "each number grows by as many bits, as in unorm:4:4..16:16"),
        ("unorm:8:8..10:12", "each number grows by as many bits"),
        ("unorm:8:8..10", "each number grows by as many bits"),
        ("unorms:8:8", "unknown storage 'unorms:8:8'"),
    ],
)
def test_what_cannot_be_is_a_line(said, message):
    with pytest.raises(UsageError, match=message):
        storages_named(said)
