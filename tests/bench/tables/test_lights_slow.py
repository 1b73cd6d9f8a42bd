"""Accumulated light: the model, the OpenGL device and published findings."""

import csv
import json

import numpy as np
import pytest
from drawing import FP32, scene_of
from test_lights import by_model
from typed import light_buffers_named

from normalbench.bench.tables.lights import measure as lights
from normalbench.bench.tables.lights.sums import (
    ROUNDINGS,
    Adder,
    chromaticity,
    coloured_lights,
    equal_lights,
    random_lights,
    steps_apart,
)
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.encodings.codecs.light_codec import LightCodec
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering

EVERY = sorted(LIGHT_BUFFERS)


@pytest.mark.parametrize("name", EVERY[:4])
def test_no_error_exceeds_half_a_step_per_blend(name):
    """The model rounds to nearest and adds various numbers of equal and random lights, the latter in every order."""
    adder = by_model(name)
    rows = [*equal_lights(adder, [1.0, 4.0], [8, 64, 256]), *random_lights(adder, 1.0, [8, 64, 256], 0)]
    for row in rows:
        error = abs(row["error"]) if "error" in row else row["model_max"]
        # float32 rounds as well.
        assert error <= row["bound"] + row["lights"] * 2.0**-23, f"{name}: {row}"


def test_pure_blue_light_amplifies_quantisation_errors_13_85_times(gl):
    """The factor is 1/0.0722 in every encoding with a fourth number, in the model and on the device."""
    expected = {"white": 1.0, "red": 1 / 0.2126, "green": 1 / 0.7152, "blue": 1 / 0.0722}
    for name, encoding in LIGHT_BUFFERS.items():
        with Adder(encoding, gl) as adder:
            for row in chromaticity(adder) if encoding.has_alpha else ():
                for prefix in ("", "gl_"):
                    amplification = row[f"{prefix}amplification"]
                    if amplification is None:
                        assert name == "rgba32f", row
                    else:
                        assert abs(amplification / expected[row["colour"]] - 1) < 0.01, (name, row)


QUICK = ("--counts", "8")


def test_each_experiment_has_one_table(run):
    status, out, _ = run("lights", *QUICK, "--light-buffer", "linear,log", "--experiment", "equal,banding")
    assert status == 0 and out.count("experiment equal") == out.count("experiment banding") == 1
    assert "shown" not in out.split("experiment equal")[0], "no table has another's columns"
    status, out, _ = run(
        "lights", *QUICK, "--light-buffer", "linear", "--experiment", "equal,banding", "--format", "csv"
    )
    assert tuple(next(csv.reader(out.splitlines()))) == tuple(TABLES["lights"].empty())


# Hue in 6 bits and saturation in 2.
COARSE = "hue_saturation"


# Pipelines and samples per pixel that are drawn by day: light is added up by blending and by reading.
BY_DAY = [("hybrid", 1), ("prepass", 4)]


@pytest.mark.parametrize("name", EVERY)
def test_the_device_sums_lights_like_the_model_with_the_same_rounding(gl, name):
    """Equal lights agree exactly in fixed point and to a step in floats. A device's own conversion is reported."""
    encoding = LIGHT_BUFFERS[name]
    with Adder(encoding, gl) as adder:
        rounding = adder.rounding
        assert rounding
        if rounding.name not in ROUNDINGS:
            assert encoding.storage.curved and rounding.name.startswith("its own conversion"), rounding
            return
        assert rounding.share >= 0.99, rounding
        for total, count in ((1.0, 8), (1.0, 64), (1.0, 256), (4.0, 64)):
            light = np.full((count, 1, 4), total / count, np.float32)
            got = adder.device(light)
            apart = steps_apart(encoding.storage, adder.model(light, None, ROUNDINGS[rounding.name]).texels, got.texels)
            allowed = 1 if encoding.storage.kind == "float" else 1e-3
            assert apart.max() <= allowed, f"{name}, {count} lights that sum to {total}: {apart.max()} steps apart"


@pytest.mark.parametrize("name", ["linear", "rgb9e5", "rgba32f"])
def test_random_lights_sum_to_the_same_texels(gl, name):
    """For 256 coloured lights in encodings without a transcendental function, fixed point agrees exactly at every
    pixel and floats agree to within a step."""
    encoding = LIGHT_BUFFERS[name]
    with Adder(encoding, gl) as adder:
        light = coloured_lights(256, 1.0, 0)
        model = adder.model(light, None, ROUNDINGS[adder.rounding.name])
        apart = steps_apart(encoding.storage, model.texels, adder.device(light).texels)
        assert apart.max() <= (1 if encoding.storage.kind == "float" else 1e-3), f"{name}: {apart.max()} steps"


@pytest.mark.parametrize("name", EVERY[4:])
def test_no_error_of_any_encoding_exceeds_half_a_step_per_blend(name):
    test_no_error_exceeds_half_a_step_per_blend(name)


def test_the_bound_includes_light_beyond_the_range():
    for name, total in (("linear:0.01", 1.0), ("srgb", 4.0), ("rgbm:1", 30.0)):
        (encoding,) = light_buffers_named(name)
        for row in random_lights(Adder(encoding, None), total, [1, 8], 0):
            assert row["model_max"] <= row["bound"] + 1e-4 * total, (name, row)


@pytest.mark.parametrize("name", [name for name in EVERY if name not in ("linear", "rgba32f", COARSE)])
def test_adding_dim_lights_first_has_smaller_errors(name):
    """Steps are smallest while there is little light. In linear fixed point all steps are the same, and a hue of
    6 bits always has the same relative error."""
    rms = {row["order"]: row["model_rms"] for row in random_lights(by_model(name), 1.0, [64], 0)}
    assert rms["dimmest first"] < rms["as drawn"] <= rms["brightest first"] * 1.05, rms


def plan(name: str, targets: int, samples: int = 1) -> Plan:
    return Plan((160, 120), samples, FP32, LIGHT_BUFFERS[name], targets, True, 1.0)


def targets_of(pipeline: str, encoding: LightCodec) -> list[int]:
    """Return the numbers of targets to test. If a pipeline can have two, a single target needs the fourth number."""
    asked = PIPELINES[pipeline].light_targets
    return [n for n in asked if n == max(asked) or encoding.has_alpha]


def frame(gl, pipeline: str, made_with: Plan) -> np.ndarray:
    with rendering(gl, PIPELINES[pipeline], scene_of("room"), made_with) as renderer:
        renderer.draw()
        return renderer.image()


@pytest.mark.parametrize("pipeline, samples", BY_DAY)
def test_every_light_encoding_works_in_every_pipeline(gl, pipeline, samples):
    """Images are finite and near the reference, with blending and reading, with one target and two, and also at
    several samples."""
    samples = gl.given_samples(samples)
    most = max(PIPELINES[pipeline].light_targets)
    reference = displayed(frame(gl, pipeline, plan("rgba32f", most, samples)))
    several = ("r11g11b10f", "srgb", "log", "nao32")  # of each blending
    for encoding in LIGHT_BUFFERS.values() if samples == 1 else map(LIGHT_BUFFERS.get, several):
        for targets in targets_of(pipeline, encoding):
            image = frame(gl, pipeline, plan(encoding.name, targets, samples))
            assert np.isfinite(image).all(), f"{encoding.name}x{targets}"
            psnr = -10 * np.log10(np.mean((displayed(image) - reference) ** 2) + 1e-30)
            # Saturation in four steps is for what a surface gives off.
            least = 28 if encoding.encoding.name == COARSE else 40
            assert psnr > least, f"{pipeline}, {encoding.name}x{targets}, {samples} samples: {psnr:.1f} dB"


def test_rows_have_all_columns_and_all_experiments_in_order(run, gl, monkeypatch):
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    status, out, err = run("lights", *QUICK, "--light-buffer", "linear,log,rgbm", "--format", "json")
    rows = json.loads(out)
    assert (status, err) == (0, "")
    assert all(tuple(row) == tuple(TABLES["lights"].empty()) for row in rows)
    assert list(dict.fromkeys(row["experiment"] for row in rows)) == list(lights.EXPERIMENTS)
    assert {row["device"] for row in rows} == {gl.renderer} and not any(row["skipped"] for row in rows)
    rebuilt = {row["light_buffer"] for row in rows if row["experiment"] == "chromaticity"}
    assert rebuilt == {"linear", "log"}
