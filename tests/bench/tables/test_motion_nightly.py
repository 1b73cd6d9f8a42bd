"""`normalbench motion`: the wobble of codes, highlights and images, animations, and bad input."""

import numpy as np
from PIL import Image
from test_motion import SMALL

from normalbench.bench.tables.motion.table import MotionOptions


def test_a_page_contains_its_charts_and_its_animation(run, tmp_path, monkeypatch):
    """`compare` finds no difference between a run and itself."""
    folder = tmp_path / "one"
    # `run` has no options for these.
    for name, value in (("frames", 8), ("count", 2048), ("size", "96x72"), ("lights", 2)):
        monkeypatch.setitem(MotionOptions.__init__.__kwdefaults__, name, value)
    words = ("run", "--tables", "motion", "--encoding", "spheremap", "--turn", "0.25,1")
    status, _, err = run(*words, "-o", str(folder))
    assert status == 0, err
    page = (folder / "report.html").read_text()
    assert "Temporal stability" in page and page.count("data:image/png;base64,") == 1
    assert 'data-chart="motion"' in page and (folder / "charts" / "motion.svg").exists()
    assert "Wobble by speed of the turn" in page and "The highlight that moves the most: spheremap rg8" in page
    status, _, err = run("compare", str(folder), str(folder))
    assert status == 0, err


def test_a_plot_is_drawn(run, tmp_path):
    plot = tmp_path / "plot.png"
    words = ("motion", "--encoding", "octahedral,spheremap", "--axis", "yaw,roll", "--picture-turn", "none", *SMALL)
    status, _, err = run(*words, "--space", "all", "--plot", str(plot))
    assert status == 0, err
    assert len(np.unique(np.asarray(Image.open(plot).convert("RGB")).reshape(-1, 3), axis=0)) > 50
