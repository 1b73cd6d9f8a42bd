"""The quality table by WGSL on Vulkan."""

import sys
from pathlib import Path
from types import ModuleType

import pytest

from normalbench.bench.code.run import trip, wgsl
from normalbench.bench.normals import normal_sets
from normalbench.bench.output.errors import MissingError
from normalbench.bench.tables.quality import measure
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.variants import in_half
from normalbench.encodings.storages.storage import STORAGES

FILE = Path(__file__).parents[2] / "inputs" / "code" / "spheremap_rg8.wgsl"


@pytest.fixture
def emitted(monkeypatch):
    """Spheremap in RG8, written by hand, in place of what would be written of it."""
    try:
        wgsl.device()
    except MissingError as error:
        pytest.skip(str(error))
    module = ModuleType(trip.EMIT)
    module.emitted = lambda *_: FILE.read_text().replace("spheremap_rg8", trip.PREFIX)
    monkeypatch.setitem(sys.modules, trip.EMIT, module)


def row_of(backend: str, encoding="spheremap") -> dict:
    codec = Codec(ENCODINGS[encoding], STORAGES["rg8"])
    return measure.measure(measure.Case(codec, normal_sets.axes(), backend))


@pytest.mark.usefixtures("emitted")
def test_a_row_by_wgsl_has_the_figures_of_jax():
    """The same errors to a millionth, by the shader's rounding, on the Vulkan device."""
    found, expected = row_of("wgsl"), row_of("jax")
    assert not found["skipped"] and found["rounded_by"] == "shader" and "Vulkan" in found["device"]
    for column in ("mse", "angle_mean_deg", "angle_max_deg"):
        assert found[column] == pytest.approx(expected[column], rel=1e-6, abs=1e-12), column
    assert found["count"] == expected["count"] and not found["invalid"]


@pytest.mark.usefixtures("emitted")
def test_half_arithmetic_is_refused_in_a_line():
    """The row says why it has no figures."""
    codec = Codec(in_half(ENCODINGS["spheremap"]), STORAGES["rg8"])
    row = measure.measure(measure.Case(codec, normal_sets.axes(), "wgsl"))
    assert "half" in row["skipped"] and row["mse"] is None


def test_without_wgpu_the_row_says_what_to_install(monkeypatch):
    """`pip install wgpu`."""

    def missing():
        raise ImportError("No module named 'wgpu'")

    wgsl.device.cache_clear()
    monkeypatch.setattr(wgsl, "adapters", missing)
    assert "pip install wgpu" in row_of("wgsl")["skipped"]
