"""Encoders whose codes are in [0, 1], recognised alike in every language and stored as an engine writes them."""

import json

import numpy as np
import pytest

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES, of_unit
from normalbench.encodings.vec import Vec2

pytestmark = pytest.mark.usefixtures("gl")


GLSL = """vec2 dir_encode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 w = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return (n.z >= 0.0 ? n.xy : w) * 0.5 + 0.5;
}
vec3 dir_decode(vec2 e) {
    e = e * 2.0 - 1.0;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -t : t;
    n.y += n.y >= 0.0 ? -t : t;
    return normalize(n);
}
"""


WGSL = """fn side(x: f32) -> f32 { return select(-1.0, 1.0, x >= 0.0); }
fn dir_encode(given: vec3<f32>) -> vec2<f32> {
    let n = given / (abs(given.x) + abs(given.y) + abs(given.z));
    let w = (1.0 - abs(n.yx)) * vec2<f32>(side(n.x), side(n.y));
    return select(w, n.xy, n.z >= 0.0) * 0.5 + 0.5;
}
fn dir_decode(given: vec2<f32>) -> vec3<f32> {
    let e = given * 2.0 - 1.0;
    let z = 1.0 - abs(e.x) - abs(e.y);
    let t = max(-z, 0.0);
    return normalize(vec3<f32>(e.x - side(e.x) * t, e.y - side(e.y) * t, z));
}
"""


TEXTS = {"glsl": GLSL, "hlsl": GLSL.replace("vec", "float"), "slang": GLSL.replace("vec", "float"), "wgsl": WGSL}


SPHERE = ("--normals", "sphere", "--count", "65536", "--format", "json")


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    """Files in the working directory, because translations are cached by file name."""
    monkeypatch.chdir(tmp_path)
    for ending, text in TEXTS.items():
        (tmp_path / f"unit.{ending}").write_text(text)


def figures(run, encodings: str, storages: str, *words: str) -> dict[tuple[str, str], dict]:
    status, out, err = run("quality", "--encoding", encodings, "--storage", storages, *SPHERE, *words)
    assert status == 0, err
    return {(row["encoding"], row["storage"]): row for row in json.loads(out)}


@pytest.mark.parametrize("ending", TEXTS)
def test_every_language_gives_the_catalogues_figures(run, ending, request):
    if ending in ("hlsl", "slang"):
        request.getfixturevalue(ending)
    rows = figures(run, f"unit.{ending},octahedral", "rg8", "--backend", "glsl")
    own, catalogues = rows.values()
    assert own["angle_mean_deg"] == pytest.approx(catalogues["angle_mean_deg"], rel=1e-5)
    assert own["psnr_db"] == pytest.approx(catalogues["psnr_db"], abs=1e-3)


@pytest.mark.parametrize("name", ["rg8_snorm", "rg16_snorm", "rg16f", "rgba32f"])
def test_a_signed_storage_preserves_unsigned_numbers(name):
    """Numbers return within half a step, and a SNORM channel has one number per code in [0, 1]."""
    storage = of_unit(STORAGES[name])
    codec = Codec(ENCODINGS["octahedral"], storage)
    c = np.linspace(-1, 1, 1001, dtype=np.float32)
    stored = np.asarray(codec.store(Vec2(c, c)).x)
    step = 2 / (storage.levels(0) - 1) if storage.kind == "snorm" else 2.0**-10
    assert np.abs(stored - c).max() <= step / 2 + 1e-7
    if storage.kind == "snorm":
        assert storage.levels(0) == storage.count(0) == 2 ** (storage.bits[0] - 1)
        assert len(storage.numbers(0)) == storage.levels(0)


def test_unsigned_storages_are_unchanged():
    assert of_unit(STORAGES["rg8"]) is STORAGES["rg8"]
