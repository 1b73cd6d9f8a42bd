"""What `--on` takes and refuses, and what is left behind."""

import json
import signal

import pytest
import test_on_slow
from speed.scheduled import scheduled
from test_on import SMALL
from test_on_slow import NO_GL

rows_alone = test_on_slow.rows_alone


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_leaves_rows_and_no_process_by_any_signal(tmp_path, rows_alone, number):
    test_on_slow.test_an_interruption_leaves_rows_and_no_process_and_a_killed_worker_costs_no_row(
        tmp_path, rows_alone, number
    )


@pytest.mark.usefixtures("gl")
def test_steps_by_glsl_go_to_no_worker_without_gl(run, tmp_path):
    """One worker of two has no GL: rows by both back ends are those of one process, and none is measured here."""
    assert run(*SMALL, "-o", str(tmp_path / "one.json"))[0] == 0
    with scheduled({}, NO_GL) as there:
        status, _, err = run(*SMALL, "-o", str(tmp_path / "two.json"), "--on", there.address)
    assert status == 0 and not err
    assert json.loads((tmp_path / "one.json").read_text()) == json.loads((tmp_path / "two.json").read_text())
