"""The simulation of many workers: its arithmetic on cases that can be done by hand."""

import json

import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.run.workers.simulate import ON_A_MACHINE, Costs, Load, recorded, simulated

FREE = Costs(start=0, task=0, row=0, byte=0)


@pytest.mark.parametrize(("workers", "seconds"), [(1, 1024), (4, 256), (64, 16), (2000, 1)])
def test_steps_of_a_second_are_shared_out(workers, seconds):
    """1024 steps, where nothing else takes time."""
    assert simulated(Load([1.0], 1024), workers, FREE).seconds == pytest.approx(seconds)


def test_a_command_that_is_always_busy_is_the_limit():
    """A row costs it 10 ms, and 1000 of them 10 s, however many workers there are; the last step takes one more."""
    found = simulated(Load([1.0], 1000), 10**4, Costs(start=0, task=0, row=0.01, byte=0))
    assert found.seconds == pytest.approx(11.0) and found.command == pytest.approx(10.0)


def test_each_worker_makes_the_steps_of_an_order_once():
    assert simulated(Load([1.0], 100, prepare=50), 1, FREE).seconds == pytest.approx(150)
    assert simulated(Load([1.0], 100, prepare=50), 100, FREE).seconds == pytest.approx(51)


def test_files_travel_once_to_each_worker_that_measures_their_steps():
    """10 orders of 10 steps: 10 times a second to one worker; to all of 100 workers, 100 times."""
    load, costs = Load([1.0], 100, sent=1.0, orders=10), Costs(start=0, task=0, row=0, byte=1.0)
    assert simulated(load, 1, costs).command == pytest.approx(10)
    assert simulated(load, 100, costs).command == pytest.approx(100)


def test_of_steps_that_a_clock_is_read_for_a_machine_has_one_at_a_time():
    assert simulated(Load([1.0], 100, is_timed=True), ON_A_MACHINE, FREE).seconds == pytest.approx(100)
    assert simulated(Load([1.0], 100, is_timed=True), 10 * ON_A_MACHINE, FREE).seconds == pytest.approx(10)


def test_a_run_without_step_times_is_refused(tmp_path):
    with pytest.raises(UsageError, match="name a run that was measured with --on"):
        recorded(tmp_path)


def test_a_runs_step_times_are_taken_by_table(tmp_path):
    steps = [{"table": "a", "seconds": 1.23456, "bytes": 10}, {"table": "a", "seconds": 2, "bytes": 20}]
    (tmp_path / "step_times.json").write_text(json.dumps([*steps, {"table": "b", "seconds": 3, "bytes": 0}]))
    assert recorded(tmp_path) == {"seconds": {"a": [1.235, 2], "b": [3]}, "bytes": {"a": 15, "b": 0}}
