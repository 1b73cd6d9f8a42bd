"""Settings for reading users' files, given after the file name: macros, preludes, include folders and languages."""

import json

import pytest
import test_source_options
from test_source_options_slow import rows_by_macros

pytestmark = pytest.mark.usefixtures("in_this_process")
mine = test_source_options.mine


@pytest.mark.usefixtures("gl", "slang")
def test_rows_from_workers_record_the_settings_they_were_read_with(run, mine, tmp_path):
    asked, mean = rows_by_macros(run, mine, tmp_path)
    status, out, err = run(*asked, "-DHALF=1.0", "--on", "local:1")
    assert status == 0, err
    assert json.loads(out)[0]["angle_mean_deg"] == mean
