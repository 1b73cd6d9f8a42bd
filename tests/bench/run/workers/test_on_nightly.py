"""What `--on` takes and refuses, and what is left behind."""

import signal

import pytest
import test_on_slow

rows_alone = test_on_slow.rows_alone


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_leaves_rows_and_no_process_by_any_signal(tmp_path, rows_alone, number):
    test_on_slow.test_an_interruption_leaves_rows_and_no_process(tmp_path, rows_alone, number)
