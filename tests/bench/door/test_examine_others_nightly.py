"""Encodings of quantities other than normals: every kind, and every error."""

import pytest
import test_examine_others_slow
from test_examine_others_slow import BY_DAY, MEASURED, WRONG

pytestmark = pytest.mark.usefixtures("gl", "slang")


@pytest.mark.parametrize("name", [name for name in MEASURED if name not in BY_DAY])
def test_doctor_names_the_quantity_and_the_command_for_all_kinds(run, name):
    test_examine_others_slow.test_doctor_names_the_quantity_and_the_command_that_measures_it(run, name)


@pytest.mark.parametrize("text", [text for index, text in enumerate(WRONG) if index % 3])
def test_doctor_reports_all_errors(run, tmp_path, text):
    test_examine_others_slow.test_doctor_reports_errors(run, tmp_path, text)
