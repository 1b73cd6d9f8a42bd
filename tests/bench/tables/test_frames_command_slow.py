"""`normalbench frames`: what is measured, its limits, what it prints, and what it says of bad input."""

import json

import pytest
from test_frames_command import QUICK
from written import as_document

from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.tangent_frames import measure as frames
from normalbench.bench.tables.tangent_frames.sets import rotations
from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.storages.storage import FRAME_STORAGES
from normalbench.gbuffer.scenes.mesh import sphere


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_every_code_keeps_its_hand_and_its_limit(request, backend):
    if backend == "glsl":
        request.getfixturevalue("gl")
    for encoding in FRAME_ENCODINGS.values():
        for storage in encoding.storages:
            codec = FrameCodec(encoding, FRAME_STORAGES[storage])
            row = frames.measure(frames.Case(codec, rotations(2**14, 3), backend))
            assert tuple(row) == tuple(TABLES["frames"].empty())
            assert row["skipped"] is None and not row["hands_lost"] and row["invalid"] == 0, row
            assert (row["hands_lost"] is None) == row["encoding"].startswith("rotation_")
            assert not row["below_limit"] and row["reached_rms_percent"] < 90, row
            assert row["effective_bits"] < row["bits"], row


@pytest.mark.usefixtures("rows_are_shared")
def test_json_is_flat_rows_the_best_first(run):
    status, out, err = run(*QUICK, "--storage", "rgba8,rgb10a2", "--format", "json")
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert (status, err) == (0, "") and len(rows) == 4
    assert [row["rotation_rms_deg"] for row in rows] == sorted(row["rotation_rms_deg"] for row in rows)
    assert all(tuple(row) == tuple(TABLES["frames"].empty()) and row["count"] == 4096 for row in rows)


@pytest.mark.usefixtures("gl", "rows_are_shared")
def test_the_table_has_both_back_ends_of_a_code_side_by_side(run):
    status, out, _ = run("frames", "--count", "4096", "--encoding", "qtangent")
    lines = [line.split() for line in out.splitlines() if line.startswith("rgba")]
    assert status == 0 and len(lines) == 8
    assert all(a[0] == b[0] and {a[1], b[1]} == {"jax", "glsl"} for a, b in zip(lines[::2], lines[1::2], strict=True))


def test_the_frames_of_a_mesh_are_its_vertices(run, tmp_path):
    """Authored tangents and their signs under a mirrored node; no limit, for they are not spread evenly."""
    as_document([sphere(1.0, 16, 8)]).write(tmp_path / "scene.glb")
    status, out, err = run(*QUICK, "--frames", str(tmp_path / "scene.glb"), "--format", "json")
    rows = json.loads(out)
    assert status == 0, err
    assert {row["frame_set"] for row in rows} == {"scene.glb"} and {row["count"] for row in rows} == {17 * 9}
    assert all(row["limit_rms_deg"] is None and row["effective_bits"] is None for row in rows)
    assert all(row["rotation_max_deg"] < 1.3 and row["hands_lost"] == 0 for row in rows)
