"""How fast normals are measured: that everybody measures the same, the ratios, bad input, and how the time grows."""

import json
import re
import shutil

import numpy as np
import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals.directions import make_input
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.throughput import c_baseline, measure
from normalbench.bench.tables.throughput.measure import WHOLE, Case
from normalbench.bench.tables.throughput.table import ThroughputOptions
from normalbench.bench.tables.throughput.work import cases, exponents
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

needs_c = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


@needs_c
@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(c_baseline.ENCODINGS))
def test_the_c_program_measures_what_the_table_measures(name):
    """Mean, RMS and largest angle of its row and its mean squared error agree with the quality table's. With
    -ffast-math it rounds a few normals to another code."""
    data, codec = make_input(WHOLE), Codec(ENCODINGS[name], STORAGES[measure.STORAGE])
    ours = quality.measure(quality.Case(codec, data.normal_set(), "jax"))
    total, squares, largest = c_baseline.work(name, "row", data.n, data.view)()
    squared, _, _ = c_baseline.work(name, "moments", data.n, data.view)()
    assert total / WHOLE == pytest.approx(ours["angle_mean_deg"], rel=1e-4)
    assert np.sqrt(squares / WHOLE) == pytest.approx(ours["angle_rms_deg"], rel=1e-4)
    assert largest == pytest.approx(ours["angle_max_deg"], rel=2e-2)
    assert squared / (3 * WHOLE) == pytest.approx(ours["mse"], rel=1e-4)


@needs_c
def test_small_numbers_stay_what_they_are_beside_the_c_program():
    """A library that is linked with -ffast-math makes its process take them for 0."""
    data = make_input(WHOLE)
    c_baseline.work("xyz", "reading", data.n, data.view)()
    assert np.float64(5e-324) * 1 > 0 and np.float32(1e-45) * np.float32(1) > 0


def test_ratios_are_of_the_rates_of_one_run(monkeypatch):
    """Rates of 4 and 2 million a second: the ratio is theirs, and what is not written in C says so."""
    monkeypatch.setattr(measure, "LONG_ENOUGH", 0.0)
    row = measure.measure(Case(ENCODINGS["octahedral"], "moments", WHOLE))
    assert row["times_numpy"] == pytest.approx(row["rate"] / row["numpy"])
    assert row["times_numpy_blocked"] == pytest.approx(row["rate"] / row["numpy_blocked"])
    assert row["reading"] is None or row["share_of_reading"] == pytest.approx(row["rate"] / row["reading"])
    assert (row["c"] is None) == (row["times_c"] is None) == (row["reading"] is None) == bool(row["no_c"])
    other = measure.measure(Case(ENCODINGS["hemi_octahedral"], "moments", WHOLE))
    assert other["rate"] > 0 and other["c"] is None and other["numpy"] is None
    assert other["no_c"] == "row.c has no hemi_octahedral"


def test_without_a_c_compiler_the_row_says_what_to_install(monkeypatch):
    monkeypatch.setattr(c_baseline.shutil, "which", lambda _: None)
    assert c_baseline.missing("xyz").startswith("no C compiler: install")


def test_the_exponent_is_the_slope_of_time_over_count():
    """By hand: 100 and 200 normals at 1 and at 1/2 million a second take 1 and 4 units of time: an exponent of 2."""
    row = {"encoding": "xyz", "statistics": "row"}
    rows = [row | {"count": 100, "rate": 1.0}, row | {"count": 200, "rate": 0.5}]
    assert [*exponents(rows)] == ["xyz, row: time grows as count^2.00 from 100 to 200 normals"]
    assert [*exponents(rows[:1])] == []
    assert [*exponents([rows[0], rows[1] | {"count": 199}])] == [], "counts that are nearly the same say nothing"


def test_counts_are_rounded_down_to_whole_blocks_and_measured_once():
    made = cases(ThroughputOptions(encoding="xyz", statistics="row", counts=f"{WHOLE + 5},{WHOLE}"))
    assert [case.count for case in made] == [WHOLE]


@pytest.mark.parametrize(
    "options, said",
    [
        ({"counts": "3"}, f"--counts 3: whole numbers from {WHOLE} to"),
        ({"counts": "2^40"}, "--counts 2^40: whole numbers from"),
        ({"statistics": "median"}, "unknown statistics 'median'"),
        ({"encoding": "no"}, "unknown encoding 'no'"),
    ],
)
def test_bad_input_is_one_line(options, said):
    with pytest.raises(UsageError, match=re.escape(said)) as error:
        cases(ThroughputOptions(**options))
    assert "\n" not in str(error.value)


def test_the_command_writes_rows_and_a_plot(run, tmp_path, monkeypatch):
    monkeypatch.setattr(measure, "LONG_ENOUGH", 0.0)
    plot = tmp_path / "rates.png"
    arguments = ["--encoding", "xyz", "--statistics", "moments", "--counts", str(WHOLE), "--plot", str(plot)]
    status, out, _ = run("throughput", *arguments, "--format", "json")
    assert status == 0 and [row["count"] for row in json.loads(out)] == [WHOLE]
    assert plot.stat().st_size > 10_000
