"""`normalbench mix`: the effect of filters, mip levels, resolves and blending on stored codes."""

from test_mix_slow import check_the_worst_mixes


def test_the_worst_mix_of_other_operations_is_found():
    check_the_worst_mixes("mip_2x2", "resolve")
