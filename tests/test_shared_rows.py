"""Rows that tests share are the same as newly measured rows."""

from types import SimpleNamespace

import shared_rows

from normalbench.bench.run.measuring import asked
from normalbench.bench.tables.registry import TABLES


def test_a_step_is_measured_once_and_rows_keep_their_order(tmp_path):
    table = TABLES["quality"]
    ask = asked(table, table.options(encoding="xy,octahedral", storage="rg8", normals="axes", backend="jax"))
    measured: list[str] = []

    def measure(_, __, steps, ___):
        for step in steps:
            measured.append(step.name)
            yield step, [{"name": step.name, "mse": float("inf")}]

    shared = shared_rows.shared(measure, tmp_path)
    few = list(shared(SimpleNamespace(), ask, ask.steps[1:], None))
    all_of_them = list(shared(SimpleNamespace(), ask, ask.steps, None))
    assert measured == [ask.steps[1].name, ask.steps[0].name]
    assert [step for step, _ in all_of_them] == list(ask.steps) and all_of_them[1:] == few
