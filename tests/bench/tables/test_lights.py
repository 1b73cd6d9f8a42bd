"""Accumulated light: the model, the OpenGL device and published findings."""

import json

import numpy as np
import pytest
from typed import light_buffers_named

from normalbench.bench.ground.machine import devices
from normalbench.bench.tables.lights import measure as lights
from normalbench.bench.tables.lights.charts import charts
from normalbench.bench.tables.lights.sums import (
    ORDERS,
    Adder,
    banding,
    coloured_lights,
    equal_lights,
    gradient,
    ordered,
)
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.gl.device import NoDeviceError

(LINEAR_1,) = light_buffers_named("linear:1")


def by_model(name: str) -> Adder:
    return Adder(LIGHT_BUFFERS[name], None)


# Known figures: N equal lights that sum to S, stored with rounding at every blend; to the digits given.
TABLE = [
    *(("linear", "rgba", s, n, v) for s, n, v in ((1, 8, 1.004), (1, 64, 1.004), (1, 256, 0), (4, 64, 2))),
    *(("srgb", "rgb", s, n, v) for s, n, v in ((1, 8, 1.006), (1, 64, 0.970), (1, 256, 0.485), (4, 64, 2))),
    *(("log", "rgba", s, n, v) for s, n, v in ((1, 8, 1.006), (1, 64, 0.983), (1, 256, 0.471), (4, 64, 3.994))),
    *(("r11g11b10f", c, 1, 256, v) for c, v in (("rg", 0.5), ("b", 0.25))),
    *(("r11g11b10f", "rgb", s, n, v) for s, n, v in ((1, 8, 1), (1, 64, 1), (4, 64, 4))),
    *(("rgba16f", "rgba", s, n, v) for s, n, v in ((1, 8, 1), (1, 64, 1), (1, 256, 1), (4, 64, 4))),
]


@pytest.mark.parametrize("name, channels, total, count, value", TABLE)
def test_the_model_reproduces_the_accumulation_table(name, channels, total, count, value):
    by_channel = {}
    for row in equal_lights(by_model(name), [float(total)], [count]):
        by_channel |= dict.fromkeys(row["channel"], row["model"])
    for channel in channels:
        assert abs(by_channel[channel] - value) <= 0.0005, f"{name} {channel}: {by_channel[channel]} for {value}"


def test_the_bound_is_half_a_code_per_blend():
    """linear: a code is 2/255; log: near 1 a code is 1/(255 2^-L ln 2) of light."""
    linear, log = (next(iter(equal_lights(by_model(name), [1.0], [64]))) for name in ("linear", "log"))
    assert abs(linear["bound"] / (64 / 255) - 1) < 0.01, linear
    assert abs(log["bound"] / (64 * 0.5 / (255 * 0.5 * np.log(2))) - 1) < 0.01, log


def test_orders_are_permutations():
    light = coloured_lights(16, 2.0, 3)
    assert abs(light.sum(axis=0).max() - 2) < 1e-5 and light.min() >= 0
    energies = {order: ordered(light, order).sum(axis=(1, 2)) for order in ORDERS}
    assert np.all(np.diff(energies["dimmest first"]) >= 0) and np.all(np.diff(energies["brightest first"]) <= 0)
    for energy in energies.values():
        assert np.array_equal(np.sort(energy), np.sort(energies["as drawn"]))


def bands(name: str, peak: float) -> dict[str, dict]:
    by_channel = {}
    for row in banding(by_model(name), [peak]):
        by_channel |= dict.fromkeys(row["channel"], row)
    return by_channel


def test_srgb_has_much_less_banding_than_linear_except_in_its_fourth_channel():
    """J. Ols, 2010: with two targets there is less banding in dim light and a smooth falloff to the edge; with one
    target the banding of the highlight stays."""
    for peak in (0.1, 1.0):
        linear, srgb = bands("linear", peak), bands("srgb", peak)
        assert srgb["r"]["shown_step"] < linear["r"]["shown_step"] / 8, (peak, srgb["r"], linear["r"])
        assert srgb["a"]["shown_step"] == linear["a"]["shown_step"] and srgb["a"]["levels"] == linear["a"]["levels"]
    assert bands("srgb", 0.1)["r"]["levels"] > 4 * bands("linear", 0.1)["r"]["levels"]


def test_log_light_has_a_larger_range_and_coarser_steps_at_its_end():
    """J. Ols, 2010: extended range. `linear` clips a lamp of 3, `log` does not, but its steps grow with the light."""
    peak = gradient(3.0)
    linear, log = (by_model(name).model(peak[None]).light[:, 0] for name in ("linear", "log"))
    assert linear.max() == 2.0 and abs(log.max() - 3.0) < 0.05
    assert bands("log", 3.0)["r"]["largest_step"] > 5 * bands("linear", 3.0)["r"]["largest_step"]


def test_log_light_is_coarser_in_the_dark_than_rgba8_with_a_range_of_1():
    """J. Ols, 2010: `log` is slightly worse on dim lights than plain RGBA8 with the range [0, 1]. The steps are
    1/(255 ln 2) and 1/255."""
    plain, log = Adder(LINEAR_1, None), by_model("log")
    steps = [next(iter(banding(adder, [0.1])))["largest_step"] for adder in (plain, log)]
    assert abs(steps[0] * 255 - 1) < 1e-3 and 1.4 < steps[1] / steps[0] < 1.6, steps
    dim = np.stack([gradient(0.1 / 8)] * 8)
    lost = [np.abs(adder.model(dim).light - dim.sum(axis=0)).mean() for adder in (plain, log)]
    assert lost[1] > lost[0], lost


def test_both_languages_use_a_given_range(gl):
    with Adder(LINEAR_1, gl) as adder:
        light = np.full((3, 1, 4), 0.2, np.float32)
        model, got = adder.model(light).light[0], adder.device(light).light[0]
    assert LINEAR_1.name == "linear:1" and np.allclose(model, 153 / 255) and np.allclose(got, model)
    ranged = [encoding.name for encoding in light_buffers_named("srgb:4,rgbm:51.5,log")]
    assert ranged == ["srgb:4", "rgbm:51.5", "log"]
    assert light_buffers_named("rgbm:51.5")[0].limit == 51.5


def test_the_chart_shows_missing_light_like_excess_light():
    row = {"experiment": "equal", "sum": 1.0, "light_buffer": "linear", "bound": 1.0}
    (chart,) = charts([row | {"lights": 4, "error": -0.5}, row | {"lights": 8, "error": 0.25}])
    assert [(point["x"], point["y"]) for point in chart.rows] == [(4, 0.5), (8, 0.25)]


def test_only_the_model_is_measured_without_a_device(run, monkeypatch):
    def missing():
        raise NoDeviceError("no OpenGL 4.3 device: none; install an OpenGL driver")

    monkeypatch.setattr(devices, "device", missing)
    status, out, err = run("lights", "--light-buffer", "log", "--counts", "8", "--format", "json")
    rows = json.loads(out)
    assert status == 0 and err.count("\n") == 1 and "install an OpenGL driver" in err
    equal = [row for row in rows if row["experiment"] == "equal"]
    assert equal and all(row["model"] is not None and row["gl"] is None for row in equal)
    assert {row["experiment"] for row in rows} == set(lights.EXPERIMENTS)


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--experiment", "glow"], "unknown experiment 'glow'; known: all, equal, random"),
        (["--light-buffer", "rgbe"], "unknown light buffer 'rgbe'; did you mean rgb9e5? known: all, rgba32f"),
        (
            ["--light-buffer", "log:2"],
            "light buffer log:2: only linear, srgb, rgbm take a range, as in linear:1",
        ),
        (["--light-buffer", "linear:wide"], "light buffer linear:wide: the range must be"),
        (["--light-buffer", "linear:-1"], "light buffer linear:-1: the range must be"),
        (["--counts", "0"], "--counts 0: expected whole numbers from 1 to 4096"),
        (["--counts", "8,many"], "--counts 8,many: expected whole numbers"),
        (["--counts", ""], "--counts : expected whole numbers"),
        (["--sum", "-1"], "--sum -1: expected numbers from"),
        (["--sum", "nan"], "--sum nan: expected numbers from"),
        (["--sum", "1e99"], "--sum 1e99: expected numbers from"),
        (["--peak", "inf"], "--peak inf: expected numbers from"),
        (["--seed", "-1"], "--seed -1"),
        (["--plot", "plot.gif"], "unsupported plot format"),
        (["--plot", "plot.png", "--experiment", "banding"], "--plot: plots only the experiments equal and random"),
        (["--images", "/proc/none"], "cannot write to /proc/none"),
        (["--images", "pictures", "--experiment", "equal"], "--images: shows only the experiment banding"),
        (["--experiment", "chromaticity", "--light-buffer", "rgbm"], "nothing to measure: chromaticity requires"),
        (["-o", "/proc/none/rows.csv"], "cannot write"),
    ],
)
def test_bad_input_is_a_one_line_error_and_nothing_is_written(run, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("lights", *arguments)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1 and said in err, err
    assert not list(tmp_path.iterdir())
