"""No command overwrites a file that it reads, or a file that it could not have written."""

import itertools

import pytest
import test_replaced_files
from test_replaced_files import AGAIN, BY_DAY, ENDINGS

folder = test_replaced_files.folder


@pytest.mark.parametrize("case, ending", [pair for pair in itertools.product(AGAIN, ENDINGS) if pair not in BY_DAY])
def test_rows_replace_earlier_rows_of_the_same_command_in_other_formats(run, case, ending):
    test_replaced_files.test_rows_replace_earlier_rows_of_the_same_command(run, case, ending)
