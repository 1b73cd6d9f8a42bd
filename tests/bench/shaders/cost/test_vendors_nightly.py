"""Rules for every vendor's compiler: the identity costs nothing, kinds add up, rows are cached, and failures affect
only its own rows. Figures of a vendor are in the vendor's own file."""

import test_vendors_slow
from test_vendors_slow import named
from test_vendors_slow import (
    test_kinds_add_up_to_the_compilers_own_count as kinds_add_up,
)


@named
def test_the_identity_costs_nothing_if_every_encoding_is_compiled(vendor_rows, vendor):
    test_vendors_slow.test_the_identity_costs_nothing(vendor_rows, vendor, is_every=True)


@named
def test_all_kinds_add_up_to_the_compilers_own_count_on_every_family(vendor_rows, vendor):
    kinds_add_up(vendor_rows, vendor, is_every=True)
