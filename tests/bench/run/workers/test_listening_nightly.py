"""A worker that gets another signal, SIGINT, leaves no file behind."""

import signal

import test_listening_slow


def test_a_worker_that_is_interrupted_leaves_no_file(tmp_path):
    test_listening_slow.test_a_stopped_worker_leaves_no_file(tmp_path, signal.SIGINT)
