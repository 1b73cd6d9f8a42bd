"""What a page's laboratory is given of a run: programs of codecs, their files, scenes, and damaged files."""

import json
import re

import numpy as np
import pytest
from directions import hard_directions

from normalbench.bench.measures.live import kept, programs, scenes
from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.normals.octahedral import decode
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec2

# Of GLSL ES 3.10 and later: a browser's 3.00 has none of them.
LATER = re.compile(r"\b(bitfield\w+|fma|frexp|ldexp|(un)?pack[US]norm4x8|findMSB|findLSB|textureGather)\(")


MINE = "vec2 mine_encode(vec3 n) { return n.xy; }\nvec3 mine_decode(vec2 e) { return vec3(e, 0.5); }\n"


def test_every_codec_is_written_in_what_browsers_know():
    found = {}
    for encoding in ENCODINGS.values():
        codec = Codec(encoding, STORAGES["rgba8"], "nearest")
        try:
            found[encoding.name] = programs.program(codec)
        except programs.NotLiveError as error:
            assert str(error) == programs.TABLES_TOO_LARGE, encoding.name
    assert set(ENCODINGS) - set(found) == {"best_fit", "spherical_lut"}
    for name, record in found.items():
        assert not LATER.search(record["source"]), name
        kept.KEPT.validate_python({**record, "checks": None})


def test_a_users_encoding_brings_its_text(tmp_path):
    (tmp_path / "mine.glsl").write_text(MINE)
    (codec,) = codecs_named(str(tmp_path / "mine.glsl"), "rg16f", "nearest")
    record = programs.program(codec)
    assert (record["text"], record["size"], record["title"]) == (MINE, 2, "RG16F")
    assert "vec2 codec_encode(vec3 n)" in record["source"]


def test_files_are_read_as_they_were_written(tmp_path):
    codecs = codecs_named("octahedral,best_fit", "rgba8", "nearest")
    kept.write_live(codecs, tmp_path)
    found, left_out = kept.read_live(tmp_path)
    (checks,) = (one.pop("checks") for one in found)
    assert checks and found == [programs.program(codecs[0])]
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
def test_a_damaged_file_is_left_out_by_name(tmp_path, damage):
    text = DAMAGED[damage]
    (tmp_path / "a.json").write_bytes(text if isinstance(text, bytes) else text.encode())
    assert kept.read_live(tmp_path) == ([], {"a.json": "its file is damaged"})


@pytest.mark.parametrize(("field", "value"), [("size", 5), ("words", 3), ("source", 1), ("more", 1), ("channels", [])])
def test_a_field_that_is_not_what_it_should_be_is_refused(tmp_path, field, value):
    (codec,) = codecs_named("octahedral", "rgba8", "nearest")
    (tmp_path / "a.json").write_text(json.dumps(programs.program(codec) | {field: value}))
    assert kept.read_live(tmp_path)[1] == {"a.json": "its file is damaged"}


def unpacked(pixels: np.ndarray) -> np.ndarray:
    """The normals of pixels, as a page reads them."""
    first, second, third = (pixels[..., i].astype(np.int64) for i in range(3))
    numbers = (first << 4 | second >> 4, (second & 15) << 8 | third)
    e = Vec2(*(number / scenes.LEVELS * 2.0 - 1.0 for number in numbers))
    return np.stack([np.asarray(plane) for plane in decode(e, None)], axis=-1) @ scenes.ROTATION


def test_a_scene_comes_back_within_the_steps_of_its_numbers(tmp_path):
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
