"""`normalbench sweep`: its output, the rows that it keeps, and refused requests."""

import csv

import numpy as np
import pytest
from PIL import Image
from test_sweep import SWEEP

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.usefixtures("gl")
def test_a_sweep_writes_its_rows_and_its_plot(run, tmp_path):
    rows, plot = tmp_path / "rows.csv", tmp_path / "plot.png"
    status, out, _ = run(*SWEEP, "--format", "csv", "-o", str(rows), "--plot", str(plot))
    assert (status, out) == (0, "") and len(list(csv.DictReader(rows.read_text().splitlines()))) == 8
    pixels = np.asarray(Image.open(plot).convert("RGB"))
    assert pixels.shape[1] > 800 and len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50
    assert sorted(path.name for path in tmp_path.iterdir()) == ["plot.png", "rows.csv"], "the journal is gone"
