"""`normalbench curves`: errors known from theory, dithering, output and messages for bad input."""

import itertools
import json

import numpy as np
import pytest
from typed import storages_named

from normalbench.bench.ground.machine import devices
from normalbench.bench.tables.curves import measure as curves
from normalbench.bench.tables.curves import work
from normalbench.bench.tables.curves.table import CurvesOptions
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import CURVE_ENCODINGS
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.gbuffer.gl.device import NoDeviceError

QUICK = ["curves", "--backend", "jax", "--count", "4096", "--format", "json"]


def row(encoding: str, storage: str, rounding: str = "nearest", backend: str = "jax") -> dict:
    (chosen,) = storages_named(storage)
    codec = CurveCodec(CURVE_ENCODINGS[encoding], chosen, 1.0, rounding)
    figures = curves.measure(curves.CurveCase(codec, backend, 2**16, 0))
    assert figures["skipped"] is None and tuple(figures) == tuple(TABLES["curves"].empty()), figures
    return figures


@pytest.mark.parametrize("bits", [1, 3, 5, 8, 12, 16])
def test_linear_error_is_a_quarter_step_on_average_and_half_a_step_at_most(bits):
    step, figures = 1 / (2**bits - 1), row("linear", f"unorm:{bits}")
    assert figures["error_mean"] == pytest.approx(step / 4, rel=0.01)
    assert figures["error_max"] == pytest.approx(step / 2, rel=0.01)
    assert figures["zero"] == 0 and figures["one"] == 1 and figures["least"] == pytest.approx(step / 2, rel=0.01)
    assert abs(figures["bias"]) < step / 500 + 2.0**-24 and figures["bits"] == bits


def test_truncation_has_a_bias_of_half_a_step_and_dithering_is_unbiased():
    """The mean error of dithering is a third of a step, weighted over all values that a number may become."""
    step = 1 / 31
    cut, dithered = row("linear", "unorm:5", "truncate"), row("linear", "unorm:5", "dithered")
    assert cut["bias"] == pytest.approx(-step / 2, rel=0.01) and cut["error_max"] == pytest.approx(step, rel=0.01)
    assert abs(dithered["bias"]) < step / 100
    assert dithered["error_mean"] == pytest.approx(step / 3, rel=0.03)
    assert dithered["zero"] == 0


def test_8_bits_on_the_srgb_curve_are_off_by_at_most_half_a_display_step():
    assert row("srgb", "r8")["display_max"] == pytest.approx(0.5, abs=0.005)
    # 12.92 steps of the curve to one of the line near black.
    assert row("linear", "r8")["display_max"] == pytest.approx(12.92 / 2, rel=0.01)


def test_curves_not_used_for_colours_have_no_display_steps():
    names = {name for name in CURVE_ENCODINGS if row(name, "r8")["display_max"] is None}
    assert names == {"squared", "inverted", "ray_bits", "reflectivity"}


def test_error_of_a_float_is_proportional_to_the_quantity():
    figures = row("linear", "float:5:10")
    assert figures["relative_max"] == pytest.approx(100 * 2.0**-11, rel=0.05)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "storage, rounding",
    [
        *itertools.product(["r8", "unorm:5", "ufloat:5:6", "rgba8_snorm", "snorm_full:8"], ["nearest", "truncate"]),
        *itertools.product(["unorm:5", "rgba8_snorm"], ["truncate_half"]),
    ],
)
def test_both_languages_give_the_same_figures(storage, rounding):
    by_jax, by_gl = (row("square_root", storage, rounding, backend) for backend in ("jax", "glsl"))
    for name in ("error_mean", "error_max", "display_mean", "zero", "one"):
        assert by_jax[name] == pytest.approx(by_gl[name], rel=1e-3, abs=1e-7), name


@pytest.mark.usefixtures("gl")
def test_dithering_is_the_same_in_both_languages():
    by_jax, by_gl = (row("square_root", "unorm:6", "dithered", backend) for backend in ("jax", "glsl"))
    assert by_jax["error_mean"] == pytest.approx(by_gl["error_mean"], rel=1e-3)


def test_every_curve_is_measured_over_its_default_range():
    cases = work.cases(CurvesOptions(backend="jax"))
    assert {case.codec.encoding.name for case in cases} == set(CURVE_ENCODINGS)
    assert {case.codec.range for case in cases if case.codec.encoding.name == "log"} == {31.0}


@pytest.mark.parametrize(
    "words, said",
    [
        (["--encoding", "cubed"], ["'cubed'", "squared", "fast_srgb"]),
        (["--storage", "r9"], ["'r9'", "rgb10a2"]),
        (["--storage", "rg8_centred"], ["centred numbers are signed"]),
        (["--storage", "r16f", "--rounding", "dithered"], ["use noise only with fixed point"]),
        (["--rounding", "up"], ["'up'", "truncate", "dithered"]),
        (["--range", "0"], ["--range"]),
        (["--count", "1"], ["--count"]),
        (["--backend", "vulkan"], ["'vulkan'"]),
    ],
    ids=lambda value: value[-1] if isinstance(value, list) else None,
)
def test_bad_input_is_a_one_line_error_with_valid_values(run, words, said):
    status, out, err = run(*QUICK, *words)
    assert status == 2 and not out and err.count("\n") == 1 and all(word in err for word in said), err


def test_glsl_rows_without_a_device_give_the_reason(run, monkeypatch):
    def none():
        raise NoDeviceError("no device here")

    for module in (curves, devices):
        monkeypatch.setattr(module, "device", none)
    status, out, _ = run("curves", "--encoding", "linear", "--storage", "r8", "--count", "256", "--format", "json")
    by_backend = {figures["backend"]: figures for figures in json.loads(out)}
    assert status == 0 and by_backend["glsl"]["skipped"] == "no device here"
    assert np.isfinite(by_backend["jax"]["error_mean"])
