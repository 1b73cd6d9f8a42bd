"""Accumulated light: the model, the OpenGL device and published findings."""

import itertools

import numpy as np
import pytest
import test_lights_slow
from PIL import Image
from test_lights_slow import BY_DAY, QUICK

from normalbench.gbuffer.pipelines import PIPELINES

LIGHT_PIPELINES = [name for name, pipeline in PIPELINES.items() if pipeline.has_gbuffer]


EACH = itertools.product(LIGHT_PIPELINES, (1, 4))


@pytest.mark.parametrize("pipeline, samples", [drawn for drawn in EACH if drawn not in BY_DAY])
def test_every_light_encoding_works_in_the_other_pipelines(gl, pipeline, samples):
    test_lights_slow.test_every_light_encoding_works_in_every_pipeline(gl, pipeline, samples)


def test_pictures_and_plot_are_written(run, tmp_path):
    images, plot = tmp_path / "pictures", tmp_path / "plot.svg"
    asked = ("--light-buffer", "srgb,nao32", "--images", str(images), "--plot", str(plot))
    status, _, err = run("lights", *QUICK, *asked)
    lines = [f"normalbench: the pictures are in {images}", f"normalbench: the chart is in {plot}"]
    assert (status, err.splitlines()) == (0, lines)
    assert {path.name for path in images.iterdir()} == {"banding-srgb.png", "banding-nao32.png"}
    for path in images.iterdir():
        assert np.asarray(Image.open(path)).max() > 0, f"{path.name} is black"
    assert "srgb" in plot.read_text() and "dotted" in plot.read_text()
