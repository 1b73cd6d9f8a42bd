"""The programs of `python -m tests.speed`: that everybody measures the same, ratios, exponents, and the simulation."""

import numpy as np
import pytest
from speed import c_baseline, simulate, throughput
from speed.throughput import WHOLE
from test_speed import needs_c, printed

from normalbench.encodings.catalogue import ENCODINGS


@needs_c
@pytest.mark.parametrize("name", sorted(c_baseline.ENCODINGS))
def test_the_c_program_measures_what_the_table_measures(name):
    """Mean, RMS and largest angle agree with the quality table's. With -ffast-math it rounds a few normals to another
    code."""
    data = throughput.normals(WHOLE)
    ours = throughput.by_jax(ENCODINGS[name], data)()
    total, squares, largest = c_baseline.work(name, "row", data.n, data.view)()
    assert total / WHOLE == pytest.approx(ours["angle_mean_deg"], rel=1e-4)
    assert np.sqrt(squares / WHOLE) == pytest.approx(ours["angle_rms_deg"], rel=1e-4)
    assert largest == pytest.approx(ours["angle_max_deg"], rel=2e-2)


def test_the_record_that_is_kept_makes_a_table(capsys):
    rows = printed(capsys, "simulate")
    assert {row["workers"] for row in rows} == set(simulate.WORKERS)
