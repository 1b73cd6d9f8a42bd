"""Image errors over sampled pixels match the errors of the whole frame, as far as their standard errors allow."""

from contextlib import ExitStack

import numpy as np
import pytest

from normalbench.bench.measures.images import whole
from normalbench.bench.measures.images.orientations import POLES, yaws
from normalbench.bench.measures.images.sampled import SampledImage
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting


@pytest.fixture
def image_of(monkeypatch, gl):
    """A function from a scene and a power to the whole image, 160 pixels wide, and to pixels sampled from it."""
    monkeypatch.setattr(whole, "SIZE", (160, 120))
    with ExitStack() as stack:

        def images(scene: str, power: float | None) -> tuple[whole.WholeImage, SampledImage]:
            what = (SCENES[scene], Setting(lights=8), [power])
            image = whole.whole_images(gl, stack, PIPELINES["deferred"], *what)[power]
            return image, SampledImage(image, 0, gl, stack)

        yield images


@pytest.mark.parametrize("scene, power", [("playground", 200.0), ("ramps", None)])
def test_the_error_of_the_samples_matches_the_error_of_the_frame(image_of, scene, power):
    """The frame's error is within three standard errors, each below a tenth of it; classes are within 35%."""
    codec = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])
    trip, turns = (lambda n, p: round_trip(codec, n, p)), [POLES["y"] @ yaws(0, 1, 0)[0]]
    image, sampled = image_of(scene, power)
    frame, samples = (part.by_class(trip, turns, "sphere") for part in (image, sampled))
    spread = sampled.pixel_error(sampled.errors(trip, turns)[0])
    assert abs(samples[""][0] - frame[""][0]) < 3 * spread and spread < 0.1 * frame[""][0], (samples, frame, spread)
    assert samples.keys() == frame.keys()
    assert all(samples[name][0] == pytest.approx(frame[name][0], rel=0.35) for name in samples), (samples, frame)


def test_surfaces_are_classed_by_direction_and_roughness(image_of):
    """Axis-aligned surfaces such as floors are one class for all materials; the shares of all classes add up to 1."""
    image, sampled = image_of("studio", None)
    floors, *others = sampled.classes
    assert floors.name == whole.AXIS_ALIGNED and [sample.name for sample in others] == list(whole.UP_TO)
    assert sum(sample.share for sample in sampled.classes) == pytest.approx(1)
    along = np.abs(sampled.normals @ image.to_world.T).max(axis=1)
    assert along[floors.columns].min() > 0.99999
    assert max(along[sample.columns].min() for sample in others) < 0.999


def test_exact_normals_have_no_error(image_of):
    """The error is 0 in view space, and only rounding error in the frame's axes; glass is not part of any class."""
    image, sampled = image_of("room", 50.0)
    errors = sampled.errors(lambda normals, _: normals, [None, np.eye(3)])
    assert (errors[0] == 0).all() and errors[1].max() < 1e-9
    heights = (image.places @ image.to_world.T)[..., 1]
    assert heights[0].mean() > heights[-1].mean(), "the first row is on top"
    assert 0.5 < np.mean(image.classes >= 0) < np.mean(image.covered) - 0.01
