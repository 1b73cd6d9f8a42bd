"""Findings on pairs in the forms that engines use: which function is wrong, and what is missing between the two."""

import pytest
import test_engines_pairs_slow
from test_engines_pairs_slow import ALONE, BY_DOCTOR

pytestmark = pytest.mark.usefixtures("gl", "slang")


@pytest.mark.parametrize("name", [name for name in ALONE if name not in BY_DOCTOR])
def test_doctor_identifies_a_single_function(run, tmp_path, name):
    test_engines_pairs_slow.test_single_function_is_identified(run, tmp_path, "doctor", name)
