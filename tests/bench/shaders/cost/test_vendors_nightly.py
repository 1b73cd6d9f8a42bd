"""What holds for every vendor's compiler: nothing costs nothing, kinds add up, rows are kept, and its failures are its
own. Figures of one vendor stand in the vendor's file."""

import test_vendors_slow
from test_vendors_slow import named
from test_vendors_slow import (
    test_the_kinds_of_every_encoding_and_packing_add_up_to_the_compilers_own_count as kinds_add_up,
)


@named
def test_doing_nothing_costs_nothing_of_every_encoding(vendor_rows, vendor):
    test_vendors_slow.test_doing_nothing_costs_nothing(vendor_rows, vendor, is_every=True)


@named
def test_the_kinds_of_every_encoding_and_packing_add_up_to_the_compilers_own_count_for_all(vendor_rows, vendor):
    kinds_add_up(vendor_rows, vendor, is_every=True)
