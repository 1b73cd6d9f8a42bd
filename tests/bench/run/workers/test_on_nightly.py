"""Values that `--on` accepts or refuses, and clean-up when a command or worker ends."""

import json
import signal

import pytest
import test_on_slow
from speed.scheduled import scheduled
from test_on import SMALL
from test_on_slow import NO_GL

rows_alone = test_on_slow.rows_alone


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interruption_by_any_signal_loses_no_rows_and_leaves_no_process(tmp_path, rows_alone, number):
    test_on_slow.test_interruption_and_killed_workers_lose_no_rows_and_leave_no_process(tmp_path, rows_alone, number)


@pytest.mark.usefixtures("gl")
def test_glsl_steps_are_not_sent_to_workers_without_gl(run, tmp_path):
    """One of two workers has no OpenGL. The rows equal those of one process, and none is measured locally."""
    assert run(*SMALL, "-o", str(tmp_path / "one.json"))[0] == 0
    with scheduled({}, NO_GL) as there:
        status, _, err = run(*SMALL, "-o", str(tmp_path / "two.json"), "--on", there.address)
    assert status == 0 and not err
    assert json.loads((tmp_path / "one.json").read_text()) == json.loads((tmp_path / "two.json").read_text())
