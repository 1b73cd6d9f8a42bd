"""The quality table, measured by WGSL on Vulkan."""

import pytest
from typed import codecs_named

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.code.run import wgsl
from normalbench.bench.subjects.normals import normal_sets
from normalbench.bench.tables.quality import measure
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.variants import in_half


@pytest.fixture
def vulkan():
    try:
        wgsl.device()
    except MissingError as error:
        pytest.skip(str(error))


def row_of(codec, backend: str, normals=None) -> dict:
    return measure.measure(measure.QualityCase(codec, normals or normal_sets.axes(), backend))


@pytest.mark.usefixtures("vulkan")
def test_half_precision_arithmetic_is_refused_with_a_reason():
    """The row says why it has no figures."""
    (codec,) = codecs_named("spheremap", "rg8", "nearest")
    halved = type(codec)(in_half(ENCODINGS["spheremap"]), codec.storage)
    row = row_of(halved, "wgsl")
    assert "half" in row["skipped"] and row["mse"] is None


def test_without_wgpu_the_row_says_what_to_install(monkeypatch):
    """The row says `pip install wgpu`."""

    def missing():
        raise ImportError("No module named 'wgpu'")

    wgsl.device.cache_clear()
    monkeypatch.setattr(wgsl, "adapters", missing)
    (codec,) = codecs_named("spheremap", "rg8", "nearest")
    assert "pip install wgpu" in row_of(codec, "wgsl")["skipped"]
    wgsl.device.cache_clear()
