"""`normalbench mix`: what further operations make of stored codes at worst."""

import test_mix_slow


def test_the_worst_mix_of_further_operations_is_searched_for_and_named():
    test_mix_slow.check_the_worst_mixes("mip_2x2", "resolve")
