"""An encoder and its decoder in two files: FILE:ENCODE,FILE:DECODE."""

import pytest
import test_two_files
from test_two_files_slow import check_figures

two = test_two_files.two


@pytest.mark.usefixtures("gl", "slang", "two")
def test_workers_give_the_figures_of_xy_for_two_files(run, tmp_path, monkeypatch):
    check_figures(run, tmp_path, monkeypatch, "--on", "local:1")
