"""Large sets that are measured in parts: the row is the same to the last digit as for the whole set, and no
part is measured twice."""

import itertools
import json

import numpy as np
import pytest

from normalbench.bench.measures.metrics.totals import ErrorTotal, Worst, total_of
from normalbench.bench.run.measuring import Nothing, asked, measured
from normalbench.bench.subjects.normals import normal_sets
from normalbench.bench.subjects.normals.normal_sets import CHUNK, SHIFTS, STEPS, TURN, hemisphere, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.quality.table import QualityOptions
from normalbench.bench.tables.registry import TABLES

TABLE = TABLES["quality"]


# Three parts, the last of which is short.
COUNT = 5 * CHUNK + 17


@pytest.fixture
def small_parts(monkeypatch):
    monkeypatch.setattr(normal_sets, "PART", 2 * CHUNK)


def ask(backend="jax", encoding="octahedral,best_fit", normals="sphere"):
    return asked(
        TABLE, QualityOptions(encoding=encoding, storage="rgba8", normals=normals, count=COUNT, backend=backend)
    )


def rows_of(one, kept=None):
    return [row for rows in measured(one, kept or Nothing()).kept for row in rows]


def test_a_set_of_the_usual_size_has_no_parts():
    assert [step.parts for step in ask().steps] == [[], []]
    assert sphere(normal_sets.PART).parts == ()
    assert [len(part.starts) for part in hemisphere(normal_sets.PART + 1).parts] == [normal_sets.PART // CHUNK, 1]


@pytest.mark.usefixtures("small_parts")
def test_a_command_with_a_file_resumes_and_leaves_nothing_behind(run, tmp_path, monkeypatch):
    """Parts count as steps of the command, and no other command uses them."""
    arguments = ["quality", "--encoding", "octahedral", "--storage", "rgba8", "--count", str(COUNT)]
    arguments += ["--normals", "sphere", "--backend", "jax", "-o", str(tmp_path / "rows.json")]
    whole, run_rows = rows_of(ask(encoding="octahedral")), quality.rows

    def one(cases, tick):
        yield from itertools.islice(run_rows(cases, tick), 1)
        raise KeyboardInterrupt

    monkeypatch.setattr(quality, "rows", one)
    status, _, err = run(*arguments)
    assert status == 130 and "1 of 4 steps were saved; to resume, run the same command" in err
    monkeypatch.setattr(quality, "rows", run_rows)
    status, _, err = run(*arguments)
    assert status == 0 and "1 of 4 steps are already measured" in err, err
    (row,) = json.loads((tmp_path / "rows.json").read_text())
    # The file has bins as lists.
    assert row | {"angle_counts": ""} == whole[0] | {"angle_counts": ""}
    assert [path.name for path in tmp_path.iterdir()] == ["rows.json"]


@pytest.mark.usefixtures("small_parts")
def test_a_part_that_cannot_be_measured_leaves_the_step_without_figures():
    (step,) = ask(encoding="octahedral").steps
    (row,) = TABLE.work.merge(
        step, [{"total": ErrorTotal().as_text()}, {"skipped": "no device"}, {"skipped": "no worker"}]
    )
    assert row["skipped"] == "no device" and row["psnr_db"] is None and row["encoding"] == "octahedral"


def test_sums_are_exact_and_so_is_their_text():
    """1 and 2^-80 are added a thousand times, one after the other, or in two parts that are sent as text."""
    counts = np.zeros_like(ErrorTotal().histogram)
    counts[[0, 7, -1]] = 1, 2**40, 3
    worst = Worst(np.float32([0.1, 0.2, 0.3]), np.float32([0.3, 0.2, 0.1]), 1 / 3)
    parts = [((1.0, 2.0**-80, 3.0, 4.0, 0.0, float(i)), counts, worst if i == 500 else None) for i in range(1000)]
    whole, halves = ErrorTotal(), (ErrorTotal(), ErrorTotal())
    for index, part in enumerate(parts):
        whole.add(part)
        halves[index > 300].add(part)
    assert whole.figures.article_squared == 1000 * 2.0**-80 and whole.figures.largest == 999
    for half in halves:
        half_again = total_of(half.as_text())
        assert half_again.figures == half.figures and np.array_equal(half_again.histogram, half.histogram)
    joined = total_of(halves[0].as_text())
    joined.add_total(total_of(halves[1].as_text()))
    assert joined.figures == whole.figures and np.array_equal(joined.histogram, whole.histogram)
    assert joined.worst.angle_deg == 1 / 3 and np.array_equal(joined.worst.normal, worst.normal)


def test_no_normal_of_2_to_the_40_is_repeated():
    """A turn of 2^32 normals is a lattice. Later turns are shifted from the lattice by multiples of (0, c), and no
    multiple is a whole turn."""
    inverse = pow(STEPS[0], -1, TURN)
    off = (SHIFTS[1] - SHIFTS[0] * inverse * STEPS[1]) % TURN
    assert len({turn * off % TURN for turn in range(2**40 // TURN)}) == 2**40 // TURN
    some = sphere(2**40)
    first, later = (np.asarray(some.chunk(start).n.z) for start in (CHUNK, TURN + CHUNK))
    assert not np.array_equal(first, later) and np.array_equal(first, np.asarray(sphere(2**33).chunk(CHUNK).n.z))
