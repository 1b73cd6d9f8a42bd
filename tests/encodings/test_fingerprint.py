"""The fingerprint of an encoding: it changes with everything that affects the figures, and with nothing else."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typed import read_encoding

from normalbench.encodings.catalogue import ENCODINGS

GLSL = """#include "scale.glsl"
vec2 mine_encode(vec3 n, vec3 view) { return n.xy * SCALE; }
vec3 mine_decode(vec2 e, vec3 view) { return vec3(e / SCALE, 1.0); }
"""
TWIN = """from normalbench.encodings.vec import Vec2, Vec3
SCALE = 0.5
def encode(n, view): return Vec2(n.x * SCALE, n.y * SCALE)
def decode(e, view): return Vec3(e.x / SCALE, e.y / SCALE, 1.0)
"""


def fingerprint(folder: Path, glsl: str = GLSL, twin: str = TWIN, scale: str = "0.5") -> str:
    folder.mkdir(exist_ok=True)
    for name, text in (("mine.glsl", glsl), ("mine.py", twin), ("scale.glsl", f"const float SCALE = {scale};\n")):
        (folder / name).write_text(text)
    return read_encoding(folder / "mine.glsl").fingerprint


def test_the_fingerprint_does_not_depend_on_the_folder(tmp_path):
    first = fingerprint(tmp_path / "one")
    assert first == fingerprint(tmp_path / "other") and len(first) == 16 and int(first, 16)


@pytest.mark.parametrize(
    "changed",
    [
        {"glsl": GLSL.replace("1.0", "0.9")},
        {"twin": TWIN.replace("SCALE = 0.5", "SCALE = 0.25")},
        {"scale": "0.25"},
    ],
    ids=("glsl", "twin", "included"),
)
def test_one_changed_constant_in_a_users_file_changes_the_fingerprint(tmp_path, changed):
    assert fingerprint(tmp_path) != fingerprint(tmp_path, **changed)


def test_an_existing_twin_is_part_of_the_fingerprint(tmp_path):
    before = fingerprint(tmp_path)
    (tmp_path / "mine.py").unlink()
    assert read_encoding(tmp_path / "mine.glsl").fingerprint != before


def test_parameters_tables_and_rounding_change_the_fingerprint():
    """The files are the same. A new name alone does not change the fingerprint."""
    octahedral, stereographic, spherical = (ENCODINGS[n] for n in ("octahedral", "stereographic", "spherical_lut"))
    (sampler, table), *_ = spherical.tables().items()
    others = [
        octahedral,
        ENCODINGS["octahedral_precise"],
        stereographic,
        stereographic.with_parameters({"scale": 1.5}),
        spherical,
        replace(spherical, tables=lambda: {sampler: np.zeros_like(table)}),
    ]
    assert len({encoding.fingerprint for encoding in others}) == len(others)
    assert replace(octahedral, name="mine", functions="octahedral").fingerprint == octahedral.fingerprint
