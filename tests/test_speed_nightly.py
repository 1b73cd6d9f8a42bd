"""The programs of `python -m tests.speed`: that everybody measures the same, ratios, exponents, and the simulation."""

from speed import simulate
from test_speed import check_record

from normalbench.bench.tables.registry import TABLES


def test_what_a_task_costs_is_measured_by_two_workers():
    costs = simulate.measured_costs()
    assert 0 < costs.task < 1 and 0 < costs.byte < 1e-5 and 0 < costs.row < 1, costs


def test_a_record_of_a_whole_table_keeps_what_else_it_holds(tmp_path, monkeypatch):
    check_record(tmp_path / "record.json", monkeypatch, TABLES["vectors"].options())
