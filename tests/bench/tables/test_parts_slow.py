"""Large sets that are measured in parts: the row is the same to the last digit as for the whole set, and no
part is measured twice."""

import json
from dataclasses import replace

import pytest
import test_parts
from test_parts import COUNT, TABLE, ask, rows_of

from normalbench.bench.keep.runs import facts_of, opened, read_run
from normalbench.bench.run.workers import tasks
from normalbench.bench.run.workers.chunks import tasks_of
from normalbench.bench.subjects.normals import normal_sets
from normalbench.bench.subjects.normals.normal_sets import CHUNK
from normalbench.bench.tables.quality import measure as quality

small_parts = test_parts.small_parts


PARTS = ["1 of 3", "2 of 3", "3 of 3"]


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_the_row_is_the_same_as_for_the_whole_set(backend, monkeypatch):
    """This also holds for a set that the encoding is not made for, where half of the decodes are far off."""
    at_once = rows_of(ask(backend, "octahedral,xy"))
    monkeypatch.setattr(normal_sets, "PART", 2 * CHUNK)
    in_parts = ask(backend, "octahedral,xy")
    assert [[part.key["part"] for part in step.parts] for step in in_parts.steps] == [PARTS] * 2
    assert rows_of(in_parts) == at_once
    assert at_once[0]["count"] == COUNT


@pytest.mark.usefixtures("small_parts")
def test_an_interrupted_step_resumes_with_the_missing_part(tmp_path, monkeypatch):
    """Parts stay in the run's file until their step is complete, and never appear as rows."""
    whole, measured, facts = rows_of(ask()), [], {**facts_of([]), "request": {}}
    run_rows = quality.rows

    def some(cases, tick):
        for index, row in enumerate(run_rows(cases, tick)):
            if index == 3:
                raise KeyboardInterrupt
            measured.append(row)
            yield row

    monkeypatch.setattr(quality, "rows", some)
    with opened(tmp_path / "run", facts) as run, pytest.raises(KeyboardInterrupt):
        rows_of(ask(), run)
    stopped = read_run(tmp_path / "run")
    # The first part of both codecs, and the second of one.
    assert [part["key"]["part"] for part in stopped.parts] == ["1 of 3", "1 of 3", "2 of 3"]
    assert stopped.steps == [] and stopped.tables == {}
    monkeypatch.setattr(quality, "rows", run_rows)
    wanted = []
    monkeypatch.setattr(quality, "rows", lambda cases, tick: run_rows(wanted.append([*cases]) or wanted[-1], tick))
    with opened(tmp_path / "run", facts) as run:
        request = ask()
        assert rows_of(request, run) == json.loads(json.dumps(whole))
        run.arrange(("quality", step) for step in request.steps)
    assert len(wanted[0]) == 3
    done = read_run(tmp_path / "run")
    assert len(done.steps) == 2 and not done.parts
    # Another request leaves parts whose step is not whole.
    (other,) = ask(encoding="xyz").steps
    with opened(tmp_path / "run", facts) as run:
        run.keep("quality", other.parts[0], [{"total": ""}])
        run.arrange(("quality", step) for step in request.steps)
    done = read_run(tmp_path / "run")
    assert len(done.steps) == 2 and [part["key"]["encoding"] for part in done.parts] == ["xyz"]
    assert done.tables["quality"] == json.loads(json.dumps(whole))


@pytest.mark.usefixtures("small_parts")
def test_a_worker_measures_parts_by_their_names():
    """The worker makes a step's parts from an order; its rows equal the rows that this process measures."""
    request = ask(encoding="octahedral")
    (step,) = request.steps
    packed = (replace(task, is_packed=True) for task in tasks_of(request, step.parts, 1))
    answers = [tasks.measure(*task.arguments()) for task in packed]
    assert not any(answer.refused for answer in answers)
    rows = [row for answer in answers for rows, _ in answer.steps for row in rows]
    assert TABLE.work.merge(step, rows) == rows_of(request)
