"""`normalbench frames`: its measurements, bounds, output and messages for bad input."""

import json
import math
from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest
from typed import storages_named

from normalbench.bench.ground.machine import devices
from normalbench.bench.measures.metrics.code_limits import SCATTER
from normalbench.bench.tables.frames import measure as frames
from normalbench.bench.tables.frames.limits import ball_moment, frame_effective_bits, frame_limit, frames_broken
from normalbench.bench.tables.frames.sets import Frames, frames_from, rotations
from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.storages.storage import FRAME_STORAGES
from normalbench.encodings.vec import Vec4
from normalbench.gbuffer.gl.device import NoDeviceError

QUICK = ["frames", "--count", "4096", "--backend", "jax", "--encoding", "octahedral_angle,smallest_three"]


def turned(angle: float, axis: int, count: int = 3) -> Frames:
    """Return frames turned about one of their own axes: 0 the tangent, 1 the bitangent, 2 the normal."""
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    matrix = np.eye(3)
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix[a, a] = matrix[b, b] = cosine
    matrix[a, b], matrix[b, a] = -sine, sine
    x, z = matrix[:, 0], matrix[:, 2]
    return Frames(np.tile([*z, 1.0], (count, 1)), np.tile([*x, 0.0], (count, 1)))


@pytest.mark.parametrize("angle", [1e-5, 0.1, 60.0, 180.0])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_angles_match_a_known_rotation(angle, axis):
    """A turn about the tangent moves only the normal, and vice versa; the rotation error is the angle of the turn."""
    angles = frames.frame_angles(turned(0, axis), turned(angle, axis))[:, 0]
    expected = [0.0 if axis == 2 else angle, 0.0 if axis == 0 else angle, angle]
    assert angles == pytest.approx(expected, rel=1e-6, abs=1e-12)


def test_lost_handedness_and_invalid_decodes_are_counted():
    total = frames.FrameTotal()
    given, decoded = turned(0, 0, 4), turned(1, 0, 4)
    decoded.normals[0, 3] = -1
    decoded.tangents[1, 0] = np.nan
    with np.errstate(invalid="ignore"):
        total.add(given, decoded)
    assert (total.count, total.hands_lost, total.invalid) == (4, 1, 1)
    assert total.largest[2] == 180 and total.sums[2] == pytest.approx(3 + 180)


def test_the_bound_for_a_few_codes_is_known():
    """With one rotation the error reaches 180 degrees. With the 24 rotations of a cube it is at most 62.80 degrees
    and 40.74 on average (Mackenzie 1958), slightly above the bound."""
    all_of_them = frame_limit(2)
    assert all_of_them.max_deg == pytest.approx(180)
    assert all_of_them.mean_deg == pytest.approx(np.degrees(np.pi / 2 + 2 / np.pi))
    cube = frame_limit(48)
    assert 0.85 * 62.80 < cube.max_deg < 62.80 and 0.97 * 40.74 < cube.mean_deg < 40.74


@pytest.mark.parametrize("codes", [2, 3, 100, 2**26, 2**32, 2**64, 2**124])
def test_the_bound_is_a_ball_with_each_codes_share_of_the_rotations(codes):
    """theta - sin theta = 2 pi / N, by a series where float64 cancels. The effective bits of the bound's RMS error
    are the bits of the codes."""
    least = frame_limit(codes)
    theta = np.radians(least.max_deg)
    exact = theta - np.sin(theta) if theta > 0.1 else theta**3 / 6 * (1 - theta**2 / 20)
    assert exact == pytest.approx(2 * np.pi / codes, rel=1e-7)
    assert least.mean_deg < least.rms_deg < least.max_deg
    assert frame_effective_bits(least.rms_deg) == pytest.approx(math.log2(codes), abs=1e-9)
    if codes > 2**20:
        assert least.rms_deg / least.max_deg == pytest.approx(np.sqrt(3 / 5), rel=1e-3)
        assert least.mean_deg / least.max_deg == pytest.approx(3 / 4, rel=1e-3)
    assert ball_moment(np.pi, 0) == pytest.approx(1)


def test_errors_below_the_bound_are_reported():
    least = frame_limit(2**20)
    assert not frames_broken(2**20, 10**6, least.mean_deg, least.rms_deg)
    spared = 1 - 2 * SCATTER / 1000
    assert "RMS" in frames_broken(2**20, 10**6, least.mean_deg, least.rms_deg * spared)
    assert "mean" in frames_broken(2**20, 10**6, least.mean_deg * spared, least.rms_deg)
    assert frame_effective_bits(0.0) == np.inf and frame_effective_bits(170.0) == 1


# Mean and largest angle of the rotation, measured with NumPy in float64 by somebody else; the largest is of a sample.
# 12:12:7:1 is the half step of 7 bits, 360 / 127 / 2 degrees.
ELSEWHERE = {
    ("rotation_smallest_three", "rgb10a2"): (0.0844, 0.232),
    ("rotation_xyz", "rgba8"): (1.12, 12.2),
    ("octahedral_angle", "unorm:12:12:7:1"): (360 / 127 / 4, 360 / 127 / 2),
}


@pytest.mark.parametrize("name, storage", ELSEWHERE)
def test_errors_of_rotation_encodings_match_independent_measurements(name, storage):
    mean, largest = ELSEWHERE[name, storage]
    codec = FrameCodec(FRAME_ENCODINGS[name], storages_named(storage)[0])
    row = frames.measure(frames.FrameCase(codec, rotations(2**16, 3), "jax"))
    assert row["rotation_mean_deg"] == pytest.approx(mean, rel=0.005), row
    assert row["rotation_max_deg"] == pytest.approx(largest, rel=0.05), row


def test_noise_is_added_only_to_numbers_of_a_frame_that_have_many_values():
    """The mean over a whole tile is the number, and numbers stored before settling do not get noise twice."""
    codec = FrameCodec(FRAME_ENCODINGS["smallest_three"], FRAME_STORAGES["rgb10a2"], "dithered")
    added = codec.dither.added.reshape(-1, 4)
    assert np.allclose(np.ptp(added, axis=0) / codec.storage.step(0), [1, 1, 1, 0], atol=1e-3)
    given = np.random.default_rng(3).uniform(-0.9, 0.9, 3).astype(np.float32)
    noisy = Vec4(*(jnp.asarray(np.float32(g) + a) for g, a in zip((*given, 1.0), added.T, strict=True)))
    stored = np.array(codec.store(noisy), np.float64)
    assert abs(stored.mean(axis=1) - [*given, 1.0]).max() < 2e-3 * codec.storage.step(0)


@pytest.mark.parametrize(
    "asked, said",
    [
        (["--rounding", "dithered", "--worst-case"], "--worst-case cannot be used with --rounding dithered"),
        (["--rounding", "dithered", "--storage", "rgba16f"], "use noise only with fixed point"),
    ],
)
def test_dithering_that_cannot_apply_is_a_one_line_error(run, asked, said):
    status, out, err = run(*QUICK[:5], "--encoding", "octahedral_angle", *asked)
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err, err


def test_an_angle_about_the_true_normal_would_be_lost_at_the_seam():
    """Without `settle`, rounding moves normals across the seam, and their tangents point anywhere."""
    settled = FRAME_ENCODINGS["octahedral_angle"]
    rows = [
        frames.measure(frames.FrameCase(FrameCodec(encoding, FRAME_STORAGES["rgb10a2"]), rotations(2**14, 0), "jax"))
        for encoding in (settled, replace(settled, settle=None))
    ]
    assert rows[0]["rotation_max_deg"] < 0.3 and rows[1]["rotation_max_deg"] > 90


def test_tilted_or_zero_tangents_still_give_frames():
    normals = np.float64([[0, 0, 1], [0, 0, 1], [1, 0, 0]])
    built = frames_from(normals, np.float64([[1, 0, 1, -1], [0, 0, 1, 1], [0, 0, 0, 1]]))
    n, t = built.normals[:, :3], built.tangents[:, :3]
    assert np.sum(n * t, axis=1) == pytest.approx(0, abs=1e-7) and np.linalg.norm(t, axis=1) == pytest.approx(1)
    assert t[0] == pytest.approx([1, 0, 0]) and built.normals[:, 3].tolist() == [-1, 1, 1]


BAD = {
    "an encoding": (["--encoding", "smallest_four"], ["'smallest_four'", "smallest_three", "qtangent"]),
    "a storage": (["--storage", "rg9"], ["'rg9'", "rgb10a2", "rgba16_snorm"]),
    "a set": (["--frames", "turns"], ["'turns'", "rotations", ".glb"]),
    "a file": (["--frames", "missing.glb"], ["missing.glb"]),
    "a back end": (["--backend", "vulkan"], ["'vulkan'", "jax", "glsl"]),
    "no frames": (["--count", "0"], ["--count 0"]),
    "a seed": (["--seed", "-1"], ["--seed -1"]),
    "no room": (["--encoding", "qtangent", "--storage", "rgb10a2"], ["qtangent/rgb10a2", "4 has only 2 bits"]),
    "no room for an index": (["--storage", "rgba8_10_10_11_1", "--encoding", "smallest_three"], ["has 4 values"]),
    "no folder": (["-o", "/proc/nowhere/rows.csv"], ["/proc/nowhere"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error_with_valid_values(run, what, tmp_path, monkeypatch):
    arguments, parts = BAD[what]
    monkeypatch.chdir(tmp_path)
    status, out, err = run("frames", *arguments)
    assert status == 2 and out == ""
    assert err.count("\n") == 1 and err.startswith("normalbench: "), err
    assert all(part in err for part in parts), err
    assert not list(tmp_path.iterdir()), "something was left behind"


def test_a_row_below_its_bound_is_reported_with_status_1(run, monkeypatch):
    monkeypatch.setattr(frames, "frames_broken", lambda *_: "RMS 0.1 degrees is below the bound of 0.2 degrees")
    status, _, err = run(*QUICK, "--storage", "rgb10a2")
    assert status == 1 and err.count("\n") == 2 and "octahedral_angle/rgb10a2: RMS 0.1 degrees" in err


def test_jax_rows_are_measured_without_an_opengl_driver(run, monkeypatch):
    def no_device():
        raise NoDeviceError("no OpenGL 4.3 device: gone; install an OpenGL driver")

    for module in (frames, devices):
        monkeypatch.setattr(module, "device", no_device)
    command = ["frames", "--count", "100", "--encoding", "qtangent", "--storage", "rgba8", "--format", "json"]
    status, out, err = run(*command)
    rows = {row["backend"]: row for row in json.loads(out)}
    assert status == 0 and err.count("\n") == 1 and "install an OpenGL driver" in err
    assert rows["jax"]["rotation_max_deg"] < 1 and rows["glsl"]["rotation_max_deg"] is None
    status, _, err = run(*command, "--backend", "glsl")
    assert status == 3 and err.count("\n") == 1 and "install an OpenGL driver" in err


def test_lost_handedness_of_either_sign_is_counted():
    given = rotations(8, 0).chunk(0)
    assert set(given.normals[:, 3]) == {-1.0, 1.0}
    for lost in (given.normals[:, 3] > 0, given.normals[:, 3] < 0):
        normals = given.normals.copy()
        normals[lost, 3] *= -1
        total = frames.FrameTotal()
        total.add(given, Frames(normals, given.tangents))
        assert total.hands_lost == lost.sum() > 0
