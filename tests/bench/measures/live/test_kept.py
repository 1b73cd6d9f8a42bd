"""The data that a run stores for a page's laboratory: codec programs, their files, scenes and damaged files."""

import json

import numpy as np
import pytest
from directions import hard_directions
from typed import codecs_named

from normalbench.bench.measures.live import kept, programs, scenes
from normalbench.encodings.normals.octahedral import decode
from normalbench.encodings.vec import Vec2


def test_files_are_read_as_they_were_written(tmp_path):
    codecs = codecs_named("octahedral,best_fit", "rgba8", "nearest")
    kept.write_live(codecs, tmp_path)
    records, left_out = kept.read_live(tmp_path)
    (checks,) = (record.pop("checks") for record in records)
    assert checks and records == [programs.program(codecs[0])]
    assert left_out == {"best_fit rgba8": programs.TABLES_TOO_LARGE}


DAMAGED = {
    "a list": "[]",
    "empty": "",
    "half": '{"encoding": "octa',
    "deep": "[" * 100_000,
    "a number": '{"encoding": 3}',
    "large": " " * (kept.MOST_BYTES + 1),
    "not UTF-8": b"\xff\xfe{",
}


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_damaged_file_is_left_out_and_reported_by_name(tmp_path, damage):
    text = DAMAGED[damage]
    (tmp_path / "a.json").write_bytes(text if isinstance(text, bytes) else text.encode())
    assert kept.read_live(tmp_path) == ([], {"a.json": "its file is damaged"})


@pytest.mark.parametrize(("field", "value"), [("size", 5), ("words", 3), ("source", 1), ("more", 1), ("channels", [])])
def test_an_invalid_field_is_refused(tmp_path, field, value):
    (codec,) = codecs_named("octahedral", "rgba8", "nearest")
    (tmp_path / "a.json").write_text(json.dumps(programs.program(codec) | {field: value}))
    assert kept.read_live(tmp_path)[1] == {"a.json": "its file is damaged"}


def unpacked(pixels: np.ndarray) -> np.ndarray:
    """Return the normals of pixels, decoded in the same way as on a page."""
    first, second, third = (pixels[..., i].astype(np.int64) for i in range(3))
    numbers = (first << 4 | second >> 4, (second & 15) << 8 | third)
    e = Vec2(*(number / scenes.LEVELS * 2.0 - 1.0 for number in numbers))
    return np.stack([np.asarray(plane) for plane in decode(e, None)], axis=-1) @ scenes.ROTATION


def test_a_scene_round_trips_within_the_precision_of_its_codes(tmp_path):
    n = hard_directions().reshape(1, -1, 3)[:, :300].repeat(2, axis=0).astype(np.float32)
    covered = np.ones(n.shape[:2], bool)
    covered[0, :5] = False
    view = np.full_like(n, -1.0)
    scenes.write_scene("a", n, view, covered, tmp_path)
    ((name, pixels, slope),) = scenes.read_scenes(tmp_path)
    assert name == "a" and (pixels[0, :5] == 0).all()
    apart = np.degrees(np.linalg.norm(unpacked(pixels) - n, axis=-1))[covered]
    assert apart.max() < 0.06, f"{apart.max()} degrees; 12 bits of an octahedron are 0.06 at most"
    assert slope == pytest.approx((300 / 299, 2.0))
    assert abs(scenes.ROTATION @ scenes.ROTATION.T - np.eye(3)).max() < 1e-15


def test_a_damaged_scene_is_left_out(tmp_path):
    (tmp_path / "a.npz").write_bytes(b"PK\x03\x04")
    np.savez(tmp_path / "b.npz", codes=np.zeros((2, 2, 3), np.uint16), covered=np.ones((2, 2), bool), slope=np.ones(2))
    assert list(scenes.read_scenes(tmp_path)) == []
