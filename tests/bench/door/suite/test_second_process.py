"""A run of two processes: the answer first, the same rows and files, and nothing left of it when it is ended."""

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
    """Says how many cores there are."""
    return lambda count: monkeypatch.setattr(second, "cores", lambda: count)


def test_the_answer_comes_first(cores, monkeypatch):
    """The table that leads the page is measured and printed before another one begins, wherever it was named."""
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
def test_the_second_process_writes_what_the_first_has_measured(monkeypatch, rows):
    """The files of the answer; where a row of it is still missing they are left to the first process."""
    written, sent = [], []
    work = SimpleNamespace(write=lambda done, _: written.append(done))
    ask = SimpleNamespace(table=SimpleNamespace(name="pick", work=work), steps=["a step"])
    monkeypatch.setattr(beside, "measured", lambda *_: rows)
    beside._write_others([ask], SimpleNamespace(find=lambda *_: rows), sent.append)
    assert (written, sent) == (([rows], [second.Written("pick")]) if rows else ([], []))
