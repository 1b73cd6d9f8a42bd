"""`normalbench frames`: its measurements, bounds, output and messages for bad input."""

import json

import numpy as np
import pytest
from test_frames_command import QUICK
from typed import storages_named
from written import as_document

from normalbench.bench.tables.frames import measure as frames
from normalbench.bench.tables.frames.sets import CHUNK, Frames, rotations
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.storages.storage import FRAME_STORAGES
from normalbench.gbuffer.scenes.mesh import sphere


def test_random_rotations_are_spread_evenly():
    """By the Haar measure the mean angle to a fixed rotation is pi/2 + 2/pi, 126.5 degrees. Both signs of handedness
    are equally common."""
    count = 2 * CHUNK + 100
    turns = rotations(count, 0)
    chunks = list(turns.chunks())
    normals, tangents = (np.concatenate([getattr(c, name) for c in chunks]) for name in ("normals", "tangents"))
    assert normals.shape == tangents.shape == (count, 4)
    still = Frames(*(np.tile(row, (count, 1)) for row in ([0.0, 0, 1, 1], [1.0, 0, 0, 0])))
    angles = frames.frame_angles(still, Frames(normals, tangents))
    for column, mean in ((0, 90.0), (1, 90.0), (2, np.degrees(np.pi / 2 + 2 / np.pi))):
        assert angles[column].mean() == pytest.approx(mean, abs=5 * angles[column].std() / np.sqrt(count))
    assert abs(normals[:, 3].mean()) < 5 / np.sqrt(count)
    assert np.array_equal(turns.chunk(0).normals, rotations(10**6, 0).chunk(0).normals), "a prefix is a prefix"
    assert not np.array_equal(turns.chunk(0).normals, rotations(count, 1).chunk(0).normals)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "name, storage",
    [("octahedral_angle", "unorm:12:12:12:1"), ("qtangent", "rgba8_snorm"), ("rotation_vector", "rgb10a2")],
)
def test_noise_costs_one_and_a_half_bits_and_keeps_handedness(name, storage):
    """The squared error is a sixth of a squared step instead of a twelfth: half a bit for each of three numbers.
    Numbers that are settled after the first are rounded also get noise, and both languages add the same noise."""

    def row(rounding: str, backend: str) -> dict:
        codec = FrameCodec(FRAME_ENCODINGS[name], storages_named(storage)[0], rounding)
        return frames.measure(frames.FrameCase(codec, rotations(2**14, 3), backend))

    nearest, noisy, by_gl = row("nearest", "jax"), row("dithered", "jax"), row("dithered", "glsl")
    assert noisy["rotation_rms_deg"] / nearest["rotation_rms_deg"] == pytest.approx(2**0.5, rel=0.015)
    assert nearest["effective_bits"] - noisy["effective_bits"] == pytest.approx(1.5, abs=0.05)
    assert noisy["rounding"] == "dithered" and not noisy["hands_lost"] and not noisy["below_limit"]
    for figure in ("rotation_rms_deg", "rotation_max_deg", "normal_mean_deg", "tangent_mean_deg"):
        assert by_gl[figure] == pytest.approx(noisy[figure], rel=2e-3), figure


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("storage", ["rgba8", "rgba16f", "unorm:12:12:7:1"])
def test_numbers_are_truncated_alike_in_both_languages(storage):
    """The error is about twice that of nearest, handedness is kept, and stored numbers are not truncated again."""
    (chosen,) = storages_named(storage)

    def row(rounding: str, backend: str) -> dict:
        codec = FrameCodec(FRAME_ENCODINGS["octahedral_angle"], chosen, rounding)
        return frames.measure(frames.FrameCase(codec, rotations(2**14, 3), backend))

    nearest, cut, by_gl = row("nearest", "jax"), row("truncate", "jax"), row("truncate", "glsl")
    assert cut["rounding"] == "truncate" and not cut["hands_lost"]
    assert 1.8 < cut["rotation_rms_deg"] / nearest["rotation_rms_deg"] < 2.3, cut
    for name in ("normal_max_deg", "rotation_rms_deg", "rotation_max_deg"):
        assert cut[name] == pytest.approx(by_gl[name], rel=1e-3), name


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_every_encoding_keeps_handedness_and_stays_above_the_bound(request, backend):
    if backend == "glsl":
        request.getfixturevalue("gl")
    for encoding in FRAME_ENCODINGS.values():
        for storage in encoding.storages:
            codec = FrameCodec(encoding, FRAME_STORAGES[storage])
            row = frames.measure(frames.FrameCase(codec, rotations(2**14, 3), backend))
            assert tuple(row) == tuple(TABLES["frames"].empty())
            assert row["skipped"] is None and not row["hands_lost"] and row["invalid"] == 0, row
            assert (row["hands_lost"] is None) == row["encoding"].startswith("rotation_")
            assert not row["below_limit"] and row["reached_rms_percent"] < 90, row
            assert row["effective_bits"] < row["bits"], row


@pytest.mark.usefixtures("rows_are_shared")
def test_json_has_flat_rows_best_first(run):
    status, out, err = run(*QUICK, "--storage", "rgba8,rgb10a2", "--format", "json")
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert (status, err) == (0, "") and len(rows) == 4
    assert [row["rotation_rms_deg"] for row in rows] == sorted(row["rotation_rms_deg"] for row in rows)
    assert all(tuple(row) == tuple(TABLES["frames"].empty()) and row["count"] == 4096 for row in rows)


@pytest.mark.usefixtures("gl", "rows_are_shared")
def test_the_table_shows_both_backends_of_an_encoding_in_consecutive_lines(run):
    status, out, _ = run("frames", "--count", "4096", "--encoding", "qtangent")
    lines = [line.split() for line in out.splitlines() if line.startswith("rgba") and "bits" not in line]
    assert status == 0 and len(lines) == 8
    assert all(a[0] == b[0] and {a[1], b[1]} == {"jax", "glsl"} for a, b in zip(lines[::2], lines[1::2], strict=True))


def test_the_frames_of_a_mesh_are_its_vertex_frames(run, tmp_path):
    """The mesh has authored tangents and signs under a mirrored node. Its frames have no bound, because they are not
    spread evenly."""
    as_document([sphere(1.0, 16, 8)]).write(tmp_path / "scene.glb")
    status, out, err = run(*QUICK, "--frames", str(tmp_path / "scene.glb"), "--format", "json")
    rows = json.loads(out)
    assert status == 0, err
    assert {row["frame_set"] for row in rows} == {"scene.glb"} and {row["count"] for row in rows} == {17 * 9}
    assert all(row["limit_rms_deg"] is None and row["effective_bits"] is None for row in rows)
    assert all(row["rotation_max_deg"] < 1.3 and row["hands_lost"] == 0 for row in rows)
