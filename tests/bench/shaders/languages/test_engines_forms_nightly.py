"""Encoders in the forms that engines write: each is read as it lies, and has the figures of the code that it is."""

import pytest
import test_engines_forms_slow


@pytest.mark.usefixtures("slang")
def test_thousands_of_functions_that_are_wrong_stand_in_no_pairs_way(tmp_path):
    test_engines_forms_slow.test_hundreds_of_functions_that_are_wrong_stand_in_no_pairs_way(tmp_path, 1000)
