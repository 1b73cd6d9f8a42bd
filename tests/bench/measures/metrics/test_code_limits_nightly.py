"""The error bound for N codes: its values, measurements that respect it and wrong measures that are caught."""

import pytest
import test_code_limits_slow
from test_code_limits_slow import SOME

from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.parametrize("name", [name for name in STORAGES if name not in SOME])
def test_no_row_is_below_its_bound_in_any_storage(name):
    test_code_limits_slow.test_no_row_is_below_its_bound(name)
