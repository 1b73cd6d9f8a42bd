"""`normalbench vectors`: errors that theory predicts, lost motion, drift, output, and messages for bad input."""

import json
import math
from contextlib import ExitStack
from functools import cache

import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.bench.ground.machine import devices
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.vectors import measure as vectors
from normalbench.bench.tables.vectors import work
from normalbench.bench.tables.vectors.charts import vector_lines
from normalbench.bench.tables.vectors.paths import FRAMES, POINTS, Paths
from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.storage import MOTION_STORAGES
from normalbench.encodings.vec import Vec2
from normalbench.gbuffer.gl.device import NoDeviceError

WIDTH, HEIGHT = SIZE = (1920, 1080)


QUICK = ["vectors", "--backend", "jax", "--count", "256", "--format", "json"]


@cache
def row(codec: str, speed: float, largest: float = 1.0, backend: str = "jax", rounding: str = "nearest") -> dict:
    """Return the row of a codec such as linear/rg16 at a speed."""
    encoding, storage = codec.split("/")
    chosen = MotionCodec(MOTION_ENCODINGS[encoding], MOTION_STORAGES[storage], rounding)
    (figures,) = vectors.measure(vectors.MotionVectorCase(chosen, backend, largest, (speed,), Paths(POINTS, 0, SIZE)))
    assert figures["skipped"] is None, figures
    return figures


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("storage", ["rg16f", "rg8", "rg8_snorm", "rg8_centred"])
@pytest.mark.parametrize("rounding", ["truncate", "truncate_half", "dithered"])
def test_both_languages_round_alike(storage, rounding):
    if storage == "rg16f" and rounding != "truncate":
        assert "fixed point" in str(MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES[storage], rounding).misfit)
        return
    by_jax, by_gl = (row(f"linear/{storage}", 64, 1.0, backend, rounding) for backend in ("jax", "glsl"))
    for name in ("error_mean_px", "error_max_px", "still_px"):
        assert by_jax[name] == pytest.approx(by_gl[name], rel=2e-3, abs=1e-6), name


@pytest.mark.parametrize("storage", ["rg8", "rg8_snorm", "rg8_centred"])
def test_the_mean_of_dithered_codes_is_the_number(storage):
    """On average each code is off by a third of a step: by 1 - p for a share p of the pixels, by p for the others."""
    codec = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES[storage], "dithered")
    step = codec.storage.step(0)
    numbers = np.random.default_rng(3).uniform(-0.95, 0.95, (2, 64, 1)).astype(np.float32)
    noise = np.concatenate([codec.dither(frame).added.reshape(-1, 4)[:, :2] for frame in range(2)]).T[:, None]
    given, added = np.broadcast_arrays(numbers, noise)
    stored = np.array(codec.stored(Vec2(*map(jnp.asarray, given)), 1.0, Vec2(*map(jnp.asarray, added))), np.float64)
    assert abs(stored.mean(axis=2) - numbers[..., 0]).max() < 2e-3 * step
    assert abs(stored - numbers).mean() == pytest.approx(step / 3, rel=0.05)
    assert abs(stored - numbers).max() < step * 1.001


def test_noise_changes_between_frames_so_that_errors_do_not_accumulate():
    """In steps, the errors e of a component have the density 1 - |e|, independently in each frame."""
    x, y = (side / (65535 / 2) for side in SIZE)
    u, v = np.meshgrid(*[np.linspace(-1, 1, 402)[1:-1]] * 2)
    share = (1 - abs(u)) * (1 - abs(v))
    figures = row("linear/rg16", 16.0, rounding="dithered")
    assert figures["error_mean_px"] == pytest.approx((np.hypot(x * u, y * v) * share).sum() / share.sum(), rel=0.01)
    assert figures["error_max_px"] < math.hypot(x, y)
    assert figures["drift_px"] == pytest.approx(math.sqrt(FRAMES * (x * x + y * y) / 6), rel=0.03)


def test_slow_dithered_motion_does_not_drift_to_one_side():
    """UNORM has codes half a step above and below zero motion, between which dithered motions alternate. The figures
    of single motions have no noise."""
    dithered, nearest = (row("linear/rg8", 0.05, rounding=rounding) for rounding in ("dithered", "nearest"))
    half = math.hypot(*(side / 255 for side in SIZE))
    assert dithered["drift_px"] == pytest.approx(math.sqrt(FRAMES) * half, rel=0.03)
    assert nearest["drift_px"] == pytest.approx(FRAMES * half, rel=0.05)
    assert [dithered[name] for name in ("still_px", "least_px")] == [nearest[name] for name in ("still_px", "least_px")]


def test_a_few_points_get_the_noise_of_their_frames():
    """Each point gets the same noise as among more points, because a frame's motions use the noise of that frame."""
    codec = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rg8"], "dithered")
    case = vectors.MotionVectorCase(codec, "jax", 1.0, (1.0,), Paths(POINTS, 0, SIZE))
    motions = next(case.paths.chunks(1.0))
    with ExitStack() as stack:
        trip = vectors._noisy_trip(stack, case)
        many, few = vectors._through(trip, motions), vectors._through(trip, motions[:, :10])
    assert np.array_equal(many[:, :10], few) and np.ptp(few, axis=0).any()


def mean_in_a_rectangle(a: float, b: float) -> float:
    """Return the mean distance from the middle of points spread evenly over a rectangle of sides 2a and 2b."""
    d = math.hypot(a, b)
    return (d + a * a / (2 * b) * math.log((b + d) / a) + b * b / (2 * a) * math.log((a + d) / b)) / 3


@pytest.mark.parametrize("codec, steps", [("linear/rg16_snorm", 32767), ("linear/rg16", 65535 / 2)])
def test_fixed_point_is_off_by_half_a_step_evenly(codec, steps):
    """The step is range * width / 32767 pixels. Errors fill a rectangle of a step, whatever the speed; in 16 frames
    they are independent, and their squares add up."""
    x, y = (side / steps for side in SIZE)
    for speed in (16.0, 64.0):
        figures = row(codec, speed)
        assert figures["error_mean_px"] == pytest.approx(mean_in_a_rectangle(x / 2, y / 2), rel=0.01)
        assert figures["error_max_px"] == pytest.approx(math.hypot(x, y) / 2, rel=0.02)
        assert figures["drift_px"] == pytest.approx(math.sqrt(FRAMES * (x * x + y * y) / 12), rel=0.02)


def test_the_mean_distance_in_a_square_matches_the_known_formula():
    """The mean distance from the centre is (sqrt 2 + ln(1 + sqrt 2)) / 6 of the side."""
    assert mean_in_a_rectangle(0.5, 0.5) == pytest.approx((math.sqrt(2) + math.log(1 + math.sqrt(2))) / 6)


def test_steps_grow_with_the_range():
    small, large = (row("linear/rg16_snorm", 16.0, largest)["error_mean_px"] for largest in (0.25, 1.0))
    assert large / small == pytest.approx(4, rel=0.02)


@pytest.mark.parametrize("speed", [1.0, 4.0, 64.0])
def test_errors_of_half_floats_are_proportional_to_the_motion(speed):
    """Errors are at most 2^-11 of the fastest component, and on average more than a quarter of 2^-11 of the speed."""
    figures = row("linear/rg16f", speed)
    fastest = speed * 1.1 * 1.1
    assert figures["error_mean_px"] < figures["error_max_px"] <= 2**-11 * fastest
    assert figures["error_mean_px"] > 0.25 * 2**-11 * speed


def test_the_square_roots_step_grows_with_the_root_of_the_motion():
    """dv = 2 sqrt(|v| range) dc: four times the speed has twice the error."""
    slow, fast = (row("sqrt/rg16_snorm", speed)["error_mean_px"] for speed in (4.0, 16.0))
    assert fast / slow == pytest.approx(2, rel=0.02)


def test_the_logarithms_error_is_proportional_to_fast_motion():
    """A step is (|v| + range / k) ln(2048) / 32767, where range / k is 1 / 2047 of the screen."""
    figures, step = row("log/rg16_snorm", 64.0), math.log(2048) / 32767
    angles = np.linspace(0, 2 * np.pi, 1001)
    halves = 0.5 * step * (64 * abs(np.stack([np.cos(angles), np.sin(angles)])) + np.array(SIZE)[:, None] / 2047)
    expected = np.mean([mean_in_a_rectangle(*half) for half in halves.T])
    assert figures["error_mean_px"] == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("storage", ["rg8_snorm", "rg8_centred"])
def test_linear_8_8_loses_all_slow_motion(storage):
    """A step is 15 pixels: lost motion is off by its whole length, and drifts by 16 times that."""
    figures = row(f"linear/{storage}", 0.05)
    assert figures["lost_percent"] == 100 and figures["still_px"] == 0
    assert figures["error_mean_px"] == pytest.approx(0.05, rel=0.01)
    assert figures["drift_px"] == pytest.approx(16 * 0.05, rel=0.01)


def test_unorm_moves_still_points_by_half_a_step():
    """No code is 0: zero motion is a tie and rounds up. Only a quarter of the slow motions decode like zero motion;
    the others decode to the other middle codes, which are equally far off."""
    for storage, steps in (("rg8", 255), ("rg16", 65535)):
        speed = 0.01 if steps > 255 else 0.05
        figures, angles = row(f"linear/{storage}", speed), np.linspace(0, np.pi / 2, 1001)
        assert figures["still_px"] == pytest.approx(math.hypot(*SIZE) / steps, rel=1e-4)
        assert figures["lost_percent"] == pytest.approx(25, abs=1)
        # Each goes to the middle code of its own quadrant.
        apart = np.hypot(WIDTH / steps - speed * np.cos(angles), HEIGHT / steps - speed * np.sin(angles))
        assert figures["error_mean_px"] == pytest.approx(apart.mean(), rel=0.01)
    assert row("linear/rg16_centred", 0.01)["still_px"] == 0


LEAST = {
    "linear/rg16_snorm": WIDTH / 32767 / 2,
    # Rest is at the upper of the two middle codes: another whole step up.
    "linear/rg16": WIDTH * 2 / 65535,
    "sqrt/rg16_snorm": WIDTH * (0.5 / 32767) ** 2,
    "log/rg16_snorm": WIDTH / 2047 * (2 ** (11 * 0.5 / 32767) - 1),
    # Half of the least subnormal number, 2^-24.
    "linear/rg16f": WIDTH * 2.0**-25,
    "linear/rgba32f": 0.0,
}


@pytest.mark.parametrize("codec", LEAST)
def test_the_slowest_motion_that_differs_from_rest_is_half_a_step_away(codec):
    assert row(codec, 1.0)["least_px"] == pytest.approx(LEAST[codec], rel=2e-3)


def test_the_drift_of_an_exact_storage_is_0():
    figures = row("linear/rgba32f", 4.0)
    assert figures["drift_px"] == figures["error_max_px"] == figures["lost_percent"] == figures["still_px"] == 0
    assert figures["range"] is None


def test_drift_is_the_distance_after_16_frames():
    """Vectors that are all half a pixel too long along x lead 8 pixels astray, whatever the path."""
    case = vectors.MotionVectorCase(
        MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rgba32f"]), "jax", 1.0, (4.0,), PATHS
    )
    rest = np.zeros((1, 2), np.float32)
    errors = vectors._figures(case, 4.0, lambda given: given + np.float32([0.5 / WIDTH, 0]), rest)
    assert errors["drift_px"] == pytest.approx(8, rel=1e-4) and errors["error_mean_px"] == pytest.approx(0.5, rel=1e-4)


PATHS = Paths(1000, 0, SIZE)


def test_motion_beyond_the_range_is_counted():
    """A range of 0.02 screens is 38.4 pixels along x and 21.6 along y."""
    figures = row("linear/rg16", 64.0, 0.02)
    angles = np.linspace(0, 2 * np.pi, 10**5)
    beyond = (abs(64 * np.cos(angles)) > 0.02 * WIDTH) | (abs(64 * np.sin(angles)) > 0.02 * HEIGHT)
    assert figures["clipped_percent"] == pytest.approx(100 * beyond.mean(), abs=1.0) and beyond.all()
    assert row("linear/rg16", 16.0, 0.02)["clipped_percent"] == 0
    half = row("linear/rg16", 32.0, 0.02)["clipped_percent"]
    assert half == pytest.approx(100 * np.mean(abs(32 * np.sin(angles)) > 0.02 * HEIGHT), abs=2)
    assert row("linear/rg16f", 64.0, 0.02)["clipped_percent"] == 0


def test_paths_turn_slowly_in_every_direction():
    """Directions are spread evenly, speeds within two factors of 1.1 of the request, and turns within 2 degrees."""
    (motions,) = PATHS.chunks(4.0)
    pixels = motions.astype(np.float64) * SIZE
    length, angle = np.hypot(*np.moveaxis(pixels, -1, 0)), np.arctan2(pixels[..., 1], pixels[..., 0])
    assert motions.shape == (FRAMES, 1000, 2) and motions.dtype == np.float32
    assert length.min() > 4 * 0.81 * 0.999 and length.max() < 4 * 1.21 * 1.001
    assert length.mean() == pytest.approx(4, rel=0.01)
    turns = np.degrees(np.angle(np.exp(1j * np.diff(angle, axis=0))))
    assert abs(turns).max() < 2.001 and np.ptp(turns, axis=0).max() < 1e-3
    counts = np.histogram(angle[0], bins=8, range=(-np.pi, np.pi))[0]
    assert np.abs(counts - 125).max() <= 1, counts


def test_paths_are_seeded_and_come_in_blocks():
    blocks = list(Paths(2 * POINTS + 10, 1, SIZE).chunks(1.0))
    assert [block.shape[1] for block in blocks] == [POINTS, POINTS, 10]
    again, other = (next(Paths(2 * POINTS + 10, seed, SIZE).chunks(1.0)) for seed in (1, 2))
    assert np.array_equal(blocks[0], again) and not np.array_equal(blocks[0], other)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("codec", ["linear/rg16f", "linear/rg16", "sqrt/rg8_centred", "log/rgb10a2_centred"])
def test_a_real_target_gives_the_same_figures(codec):
    for speed in (0.25, 16.0):
        by_jax, by_gl = (row(codec, speed, 1.0, backend) for backend in ("jax", "glsl"))
        for figure in ("error_mean_px", "error_max_px", "drift_px", "still_px", "least_px"):
            assert by_gl[figure] == pytest.approx(by_jax[figure], rel=0.01, abs=1e-9), figure
        assert by_gl["rounded_by"] in ("device", "shader") and by_jax["rounded_by"] == "emulation"


@pytest.mark.usefixtures("rows_are_shared")
def test_json_has_flat_rows_by_encoding_and_speed(run):
    names = ["--encoding", "linear,sqrt", "--storage", "rg16f,rg8", "--speed", "1,4", "--range", "1,0.5"]
    status, out, err = run(*QUICK, *names)
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert (status, err) == (0, "")
    assert all(tuple(row) == tuple(TABLES["vectors"].empty()) for row in rows)
    codes = [(r["encoding"], r["storage"], r["range"]) for r in rows if r["speed"] == 1]
    assert sorted(codes, key=str) == sorted(
        [("linear", "rg16f", None)]
        + [(name, "rg8", largest) for name in ("linear", "sqrt") for largest in (0.5, 1.0)]
        + [("sqrt", "rg16f", largest) for largest in (0.5, 1.0)],
        key=str,
    )
    assert len(rows) == 2 * len(codes) and [r["bits"] for r in rows] == sorted(r["bits"] for r in rows)


@pytest.mark.usefixtures("rows_are_shared")
def test_the_sheets_have_a_line_for_each_code_with_speeds_side_by_side(run):
    status, out, _ = run(*QUICK[:-2], "--encoding", "linear,log", "--storage", "rg8,rg8_snorm", "--speed", "0.05,16")
    lines = [line.split()[:2] for line in out.splitlines()]
    assert status == 0 and lines.count(["linear", "rg8_snorm"]) == 3, out
    assert lines.count(["log", "rg8_snorm"]) == 2, "nothing of it is lost"


def test_the_chart_has_a_line_for_each_code_that_is_not_exact():
    rows = [row(codec, speed) for codec in ("linear/rgba32f", "linear/rg16", "sqrt/rg8") for speed in (1.0, 16.0)]
    lines = vector_lines(rows)
    assert {name: len(line) for name, line in lines.items()} == {"linear rg16": 2, "sqrt rg8": 2}
    (chart,) = work.WORK.charts(rows)
    assert [panel for panel, _ in chart.parts()] == ["16 bits", "32 bits", "64 bits"] and chart.name == "vectors"


BAD = {
    "an encoding": (["--encoding", "cubic"], ["'cubic'", "linear", "sqrt", "log"]),
    "a storage": (["--storage", "rg9"], ["'rg9'", "rg16_centred", "rgb10a2"]),
    "a back end": (["--backend", "vulkan"], ["'vulkan'", "jax", "glsl"]),
    "a way to round": (["--rounding", "up"], ["'up'", "truncate", "dithered"]),
    "no speed": (["--speed", "0"], ["--speed 0", "1e-06"]),
    "a speed that is a word": (["--speed", "fast"], ["--speed fast", "numbers from"]),
    "a speed that is not a number": (["--speed", "nan"], ["--speed nan"]),
    "no range": (["--range", "0"], ["--range 0", "0.001 to 16"]),
    "a range too far": (["--range", "17"], ["--range 17", "0.001 to 16"]),
    "a size": (["--size", "1920"], ["--size 1920", "WIDTHxHEIGHT"]),
    "a size too large": (["--size", "70000x1"], ["--size 70000x1", "65536"]),
    "no points": (["--count", "0"], ["--count 0"]),
    "a seed": (["--seed", "-1"], ["--seed -1"]),
    "no folder": (["-o", "/proc/nowhere/rows.csv"], ["/proc/nowhere"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error_with_valid_values(run, what, tmp_path, monkeypatch):
    arguments, parts = BAD[what]
    monkeypatch.chdir(tmp_path)
    status, out, err = run("vectors", *arguments)
    assert status == 2 and out == ""
    assert err.count("\n") == 1 and err.startswith("normalbench: "), err
    assert all(part in err for part in parts), err
    assert not list(tmp_path.iterdir()), "something was left behind"


def test_jax_rows_are_measured_without_an_opengl_driver(run, monkeypatch):
    def no_device():
        raise NoDeviceError("no OpenGL 4.3 device: gone; install an OpenGL driver")

    for module in (vectors, devices):
        monkeypatch.setattr(module, "device", no_device)
    command = [
        "vectors",
        "--count",
        "100",
        "--encoding",
        "sqrt",
        "--storage",
        "rg8",
        "--speed",
        "1",
        "--format",
        "json",
    ]
    status, out, err = run(*command)
    rows = {row["backend"]: row for row in json.loads(out)}
    assert status == 0 and err.count("\n") == 1 and "install an OpenGL driver" in err
    assert rows["jax"]["error_mean_px"] < 1 and rows["glsl"]["error_mean_px"] is None
    status, _, err = run(*command, "--backend", "glsl")
    assert status == 3 and err.count("\n") == 1 and "install an OpenGL driver" in err
