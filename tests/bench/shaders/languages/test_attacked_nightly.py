"""Forbidden actions of a file, and obstacles to finding a pair, collected from attempted attacks."""

import pytest
import test_attacked
from test_attacked import JOINED, JOINS, WAYS

pytestmark = pytest.mark.usefixtures("slang")


@pytest.mark.parametrize("ending, by", [way for way in WAYS if way not in JOINED])
def test_an_include_disguised_with_any_join_cannot_read_a_file_elsewhere(tmp_path, ending, by):
    test_attacked.test_a_disguised_include_cannot_read_a_file_elsewhere(tmp_path, ending, by, [*JOINS])
