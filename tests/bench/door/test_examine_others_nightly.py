"""Codes of other kinds than normals: every kind, and all that may be wrong."""

import pytest
import test_examine_others_slow
from test_examine_others_slow import BY_DAY, MEASURED, WRONG

pytestmark = pytest.mark.usefixtures("gl", "slang")


@pytest.mark.parametrize("name", [name for name in MEASURED if name not in BY_DAY])
def test_codes_of_all_kinds_are_told_what_they_are_of(run, name):
    test_examine_others_slow.test_a_code_is_told_what_it_is_of_and_what_measures_it(run, name)


@pytest.mark.parametrize("text", [text for at, text in enumerate(WRONG) if at % 3])
def test_all_that_is_wrong_is_told(run, tmp_path, text):
    test_examine_others_slow.test_what_is_wrong_is_told(run, tmp_path, text)
