"""Rows from workers, equal to rows from one process, for more tables."""

import pytest
import test_same_rows_slow

scheduler = test_same_rows_slow.scheduler

COMMANDS = {
    "depth": "--depth linear,logarithmic --near 0.1 --count 512 --storage depth16,depth24",
    "lights": "--experiment equal,banding --light-buffer linear,rgba16f --sum 1 --counts 4",
    "motion": "--encoding octahedral --storage rg8 --turn 0.25,1 --frames 4 --count 256 --size 64x36",
}


@pytest.mark.parametrize("table", COMMANDS)
def test_workers_give_the_rows_and_pictures_of_one_process_for_more_tables(gl, run, tmp_path, table):  # noqa: ARG001
    """Every figure matches to the last digit and in the same order, and every picture to the last byte."""
    test_same_rows_slow.compared(run, tmp_path, table, COMMANDS[table])


def test_workers_receive_users_files_with_absolute_paths(gl, run, scheduler, tmp_path, monkeypatch):
    test_same_rows_slow.test_workers_receive_users_files(gl, run, scheduler, tmp_path, monkeypatch, True)
