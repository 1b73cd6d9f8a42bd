"""What is said of pairs in the forms that engines write: which function is wrong, and what makes a pair of two."""

import pytest
import test_engines_pairs_slow
from test_engines_pairs_slow import ALONE, BY_DOCTOR

pytestmark = pytest.mark.usefixtures("gl", "slang")


@pytest.mark.parametrize("name", [name for name in ALONE if name not in BY_DOCTOR])
def test_doctor_tells_one_function_alone_what_it_is(run, tmp_path, name):
    test_engines_pairs_slow.test_one_function_alone_is_told_what_it_is(run, tmp_path, "doctor", name)
