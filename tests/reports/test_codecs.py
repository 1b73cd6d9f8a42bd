"""The view Codecs: a list of all, and everything about one codec in a card, as the run's rows have it."""

import pytest

from normalbench.encodings.storages.rules import rule_of_first
from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.parametrize(
    ("one", "other", "count", "same"),
    [
        ("rg8", "rgba8", 2, True),
        ("rg8", "rgb10a2", 2, False),
        ("rg8", "rg8_snorm", 2, False),
        ("rgba16", "rg16", 2, True),
        ("rgba16f", "rg16f", 2, True),
        ("rgb10a2", "rgb8_10_10_2", 2, False),
    ],
)
def test_storages_of_the_same_first_numbers(one, other, count, same):
    """Numbers that lie across channels are not filtered as others are."""
    assert (rule_of_first(STORAGES[one], count) == rule_of_first(STORAGES[other], count)) is same
