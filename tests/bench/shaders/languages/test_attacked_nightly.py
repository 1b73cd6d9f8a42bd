"""What a file may not do, and what stands in the way of a pair: found by those who tried."""

import pytest
import test_attacked
from test_attacked import JOINED, JOINS, WAYS

pytestmark = pytest.mark.usefixtures("slang")


@pytest.mark.parametrize("ending, by", [way for way in WAYS if way not in JOINED])
def test_no_disguise_of_an_include_with_any_join_reads_a_file_elsewhere(tmp_path, ending, by):
    test_attacked.test_no_disguise_of_an_include_reads_a_file_elsewhere(tmp_path, ending, by, [*JOINS])
