"""Engine layouts: their encodings have the errors measured for them elsewhere, and all layouts render."""

from functools import cache
from itertools import product

import numpy as np
import pytest
from slowly import a_tenth
from test_engine_layouts import ENGINES, FIGURES, GLOSS, plan

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.rules import storage_of
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import check, rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting


@pytest.mark.parametrize("name", FIGURES)
def test_the_encoding_of_a_preset_has_the_error_measured_elsewhere(name):
    """Within 1% on uniform directions, or half of the last digit given; the largest sampled error within 3%."""
    encoding, storage, rounding, mean, rms, largest, _ = FIGURES[name]
    preset = LAYOUTS[name]
    assert (preset.encoding.name, preset.rounding if rounding != preset.packing else rounding) == (encoding, rounding)
    codec = Codec(ENCODINGS[encoding], storage_of(storage) or STORAGES[storage], rounding)
    n = np.random.default_rng(18).normal(size=(2**20, 3))
    n = (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32)
    apart = angles_deg(n, round_trip(codec, n, n))
    for figure, wanted, share in ((apart.mean(), mean, 0.01), (np.sqrt(np.mean(apart**2)), rms, 0.01)):
        if wanted:
            assert abs(figure - wanted) <= max(share * wanted, 0.5e-4), f"{figure:.5f}, {wanted} outside"
    if largest:
        assert abs(apart.max() - largest) <= max(0.03 * largest, 1e-4), f"{apart.max():.4f}, {largest} outside"


STUDIO = SCENES["studio"].make(Setting())


@cache
def image_of(gl, pipeline: str, scene: str, layout: str) -> np.ndarray:
    layout_plan = plan(LAYOUTS[layout], light_targets=1 if pipeline == "deferred" else 2)
    scenes = {"gloss": GLOSS, "studio": STUDIO}
    check(gl, PIPELINES[pipeline], layout_plan, scenes[scene].is_metal_rough)
    with rendering(gl, PIPELINES[pipeline], scenes[scene], layout_plan) as drawing:
        drawing.draw()
        return drawing.image()


@pytest.mark.parametrize("pipeline, name", a_tenth(product(["deferred", "hybrid"], ENGINES)))
def test_every_engines_layout_renders(gl, pipeline, name):
    """The image is finite, lit and near the image from 32-bit floats. Whole layouts are tested on metallic-roughness
    materials, the others on glossy materials."""
    layout = LAYOUTS[name]
    if missing := PIPELINES[pipeline].needs - layout.metal_rough_components:
        pytest.skip(f"{pipeline} needs {', '.join(missing)}")
    images = [image_of(gl, pipeline, "studio" if layout.is_whole else "gloss", preset) for preset in (name, "fp32")]
    assert np.isfinite(images[0]).all() and images[1].max() > 0.1
    apart = np.sqrt(np.mean((np.clip(images[0], 0, 1) - np.clip(images[1], 0, 1)) ** 2))
    # The square of a roughness in 8 bits, FidelityFX's, is 0.037 off where surfaces are nearly mirrors.
    assert apart < (0.04 if layout.is_whole else 0.03), f"{apart:.4f} RMS"
