"""The view Codecs: a list of all codecs, and everything about one codec in a card, from the run's rows."""

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
def test_storages_share_a_rule_if_their_first_numbers_are_alike(one, other, count, same):
    """Numbers that span several channels are filtered differently."""
    assert (rule_of_first(STORAGES[one], count) == rule_of_first(STORAGES[other], count)) is same
