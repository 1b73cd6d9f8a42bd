"""The programs of `python -m tests.speed`: consistent measurements, ratios, exponents, and the simulation."""

from speed import simulate
from test_speed import check_record

from normalbench.bench.tables.registry import TABLES


def test_two_workers_measure_the_cost_of_a_task():
    costs = simulate.measured_costs()
    assert 0 < costs.task < 1 and 0 < costs.byte < 1e-5 and 0 < costs.row < 1, costs


def test_a_new_record_of_a_whole_table_keeps_the_other_records(tmp_path, monkeypatch):
    check_record(tmp_path / "record.json", monkeypatch, TABLES["vectors"].options())
