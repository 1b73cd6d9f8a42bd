"""A run with two processes: the answer comes first, rows and files are the same, and no process outlives the run."""

from types import SimpleNamespace

import pytest

from normalbench.bench.door import beside
from normalbench.bench.door import run as run_of
from normalbench.bench.run import second
from normalbench.bench.run.measuring import HERE, Asked
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Measured


@pytest.fixture
def cores(monkeypatch):
    """A function that sets the number of cores."""
    return lambda count: monkeypatch.setattr(second, "cores", lambda: count)


def test_the_answer_comes_first(cores, monkeypatch):
    """The first table of the page is measured and printed before any other begins, wherever the request names it."""
    cores(1)
    seen = []
    monkeypatch.setattr(
        run_of, "measured", lambda ask, *_: seen.append(ask.table.name) or Measured(ask.options, None, (), ())
    )
    monkeypatch.setattr(run_of, "say_verdict", lambda table, _: seen.append(f"{table.name} is shown"))
    tables = [TABLES[name] for name in ("vectors", "frames", "pick")]
    run_of._measure_all(None, [Asked(table, table.options(), None, ()) for table in tables], HERE, None)
    assert seen[:2] == ["pick", "pick is shown"], seen


@pytest.mark.parametrize("rows", [[{"psnr_db": 47.5}], None])
def test_the_second_process_writes_the_measurements_of_the_first(monkeypatch, rows):
    """If a row of the answer is still missing, the first process writes the files."""
    written, sent = [], []
    work = SimpleNamespace(write=lambda done, _: written.append(done))
    ask = SimpleNamespace(table=SimpleNamespace(name="pick", work=work), steps=["a step"])
    monkeypatch.setattr(beside, "measured", lambda *_: rows)
    beside._write_others([ask], SimpleNamespace(find=lambda *_: rows), sent.append)
    assert (written, sent) == (([rows], [second.Written("pick")]) if rows else ([], []))
