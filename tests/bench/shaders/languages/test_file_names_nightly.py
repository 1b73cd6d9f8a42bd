"""Files whose names have a comma or a plus."""

import pytest
from test_file_names_slow import check_measured


@pytest.mark.usefixtures("gl", "slang")
def test_workers_measure_files_with_commas_and_pluses(run, tmp_path, monkeypatch):
    check_measured(run, tmp_path, monkeypatch, "--on", "local:1")
