"""The programs of `python -m tests.speed`: consistent measurements, ratios, exponents, and the simulation."""

import json

import numpy as np
import pytest
from speed import __main__ as program
from speed import c_baseline, simulate, throughput, timing
from speed.throughput import WHOLE
from test_speed import needs_c

from normalbench.encodings.catalogue import ENCODINGS


@pytest.fixture
def briefly(monkeypatch):
    """Timing without a minimum duration."""
    monkeypatch.setattr(timing, "LONG_ENOUGH_S", 0.0)


def printed(capsys, *words):
    """Return the rows that a program prints."""
    program.main([*words])
    return json.loads(capsys.readouterr().out)


@pytest.mark.usefixtures("briefly")
def test_ratios_compare_rates_from_the_same_run(capsys):
    """A row without a C version states the reason. Counts are rounded down to whole blocks, and measured once."""
    counts = f"{WHOLE + 5},{WHOLE}"
    row, other = printed(capsys, "throughput", "--encoding", "octahedral,hemi_octahedral", "--counts", counts)
    assert row["count"] == other["count"] == WHOLE
    for name in ("numpy", "numpy_blocked", "c", "reading"):
        assert (row[name] is None) == (row[f"times_{name}"] is None)
        assert row[name] is None or row[f"times_{name}"] == pytest.approx(row["rate"] / row[name])
    assert row["numpy"] and (row["c"] is None) == (row["reading"] is None) == bool(row["no_c"])
    assert other["rate"] > 0 and other["c"] is None and other["numpy"] is None
    assert other["no_c"] == "row.c has no hemi_octahedral"


@needs_c
@pytest.mark.parametrize("name", sorted(c_baseline.ENCODINGS))
def test_the_c_program_measures_the_same_as_the_table(name):
    """The C program's mean, RMS and largest angle agree with the quality table's. With -ffast-math it rounds a few
    normals to another code."""
    data = throughput.normals(WHOLE)
    ours = throughput.by_jax(ENCODINGS[name], data)()
    total, squares, largest = c_baseline.work(name, "row", data.n, data.view)()
    assert total / WHOLE == pytest.approx(ours["angle_mean_deg"], rel=1e-4)
    assert np.sqrt(squares / WHOLE) == pytest.approx(ours["angle_rms_deg"], rel=1e-4)
    assert largest == pytest.approx(ours["angle_max_deg"], rel=2e-2)


def test_the_stored_record_yields_a_table(capsys):
    rows = printed(capsys, "simulate")
    assert {row["workers"] for row in rows} == set(simulate.WORKERS)
