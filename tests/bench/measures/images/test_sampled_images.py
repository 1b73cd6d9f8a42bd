"""Image errors over sampled pixels: those of the whole frame, as far as their own standard error says."""

from contextlib import ExitStack

import numpy as np
import pytest

from normalbench.bench.measures.images import sampled
from normalbench.bench.measures.images.orientations import POLES, yaws
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (160, 120)
SETTING = Setting(lights=8)


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(sampled, "SIZE", SIZE)


def trip_of(name: str):
    codec = Codec(ENCODINGS[name], STORAGES["rg8"])
    return lambda normals, positions: round_trip(codec, normals, positions)


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("scene, power", [("playground", 200.0), ("ramps", None)])
def test_the_error_of_samples_is_that_of_the_frame(gl, scene, power):
    """Within three of its standard errors, which are below a tenth of it."""
    maker, trip, turn = SCENES[scene], trip_of("octahedral"), POLES["y"] @ yaws(0, 1, 0)[0]
    with ExitStack() as stack:
        image = sampled.sampled_images(gl, stack, maker, SETTING, [power], 0)[power]
        errors = image.errors([(trip, turn)])
        found, spread = image.by_class(errors, np.ones(len(image.normals), bool))[""][0], image.pixel_error(errors[0])
        what = maker.make(SETTING) if power is None else maker.make(SETTING).with_power(power)
        plan = Plan(SIZE, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, True, 1.0)
        made = stack.enter_context(rendering(gl, PIPELINES["deferred"], what, plan))
        made.draw()
        exact, surfaces = made.image(), made.surfaces()
        covered = made.covered(surfaces)
        matrix = turn @ image.to_world
        decoded = trip((covered.normals @ matrix.T).astype(np.float32), covered.position) @ matrix
        lit = made.lit(covered.with_normals(surfaces, decoded))
        display = maker.display(exact)
        apart = (display.image(lit) - display.image(exact))[covered.pixels[::-1]] ** 2
    assert abs(found - apart.mean()) < 3 * spread and spread < 0.1 * found, (found, apart.mean(), spread)


@pytest.mark.usefixtures("small")
def test_classes_are_by_direction_and_roughness(gl):
    """A floor is a class of its own, whatever it is made of; the shares of all classes are the whole."""
    with ExitStack() as stack:
        image = sampled.sampled_images(gl, stack, SCENES["studio"], SETTING, [None], 0)[None]
    floors, *others = image.classes
    assert floors.name == sampled.AXIS_ALIGNED and {sample.name for sample in others} <= set(sampled.UP_TO)
    assert sum(sample.share for sample in image.classes) == pytest.approx(1)
    along = np.abs(image.normals @ image.to_world.T).max(axis=1)
    assert along[floors.columns].min() > 0.99999 and len(others) == 3
    assert max(along[sample.columns].min() for sample in others) < 0.999


@pytest.mark.usefixtures("small")
def test_exact_normals_have_no_error(gl):
    """In view space, and by the frame's axes to the rounding of the rotation."""
    with ExitStack() as stack:
        image = sampled.sampled_images(gl, stack, SCENES["room"], SETTING, [50.0], 0)[50.0]
        errors = image.errors([(lambda normals, _: normals, None), (lambda normals, _: normals, np.eye(3))])
    assert (errors[0] == 0).all() and errors[1].max() < 1e-9
