"""The claims of README.md and every page of docs/ are true: commands run, examples pass."""

import pytest
import test_readme
import test_readme_slow
from slowly import half
from test_readme import LONG_COMMANDS

readers_folder = test_readme.readers_folder


@pytest.mark.parametrize("command", half(LONG_COMMANDS))
def test_every_command_runs_as_written_however_long_it_takes(command, readers_folder, monkeypatch, capsys, request):
    test_readme_slow.test_every_command_runs_as_written(command, readers_folder, monkeypatch, capsys, request)
