"""Encoders in the forms that engines use, read unchanged and measured like the catalogue's encodings."""

import json
import shutil

import pytest
from manual import ROOT
from mistakes import CUT_OFF
from typed import translated

FORMS = ROOT / "tests" / "inputs" / "encoders"


# The catalogue's mean on the sphere in 8:8 bits, in degrees.
OCTAHEDRAL = 0.3356


OF_OCTAHEDRAL = ("main.glsl", "uniform.glsl", "namespace.slang", "default.hlsl", "root/gbuffer/pack.hlsl")


OF_XY = ("struct.wgsl", "import.wgsl", "real3x3.hlsl", "overloads.hlsl")


def angles(run, tmp_path, files, normals) -> dict[str, float]:
    """Return the mean angle of each file; GLSL that is named by its functions gets a unique name."""
    shutil.copytree(FORMS, tmp_path / "forms")
    for path in (tmp_path / "forms").iterdir():
        if path.is_file():
            path.write_text(path.read_text().replace("dir_", f"{path.stem}_{path.suffix[1:]}_"))
    asked = ",".join(str(tmp_path / "forms" / name) for name in files)
    storage = ("--storage", "rg8", "--backend", "glsl", "--count", "65536", "--format", "json")
    asked_of = ("--encoding", asked, "--normals", normals, "--arithmetic", "float")
    status, out, err = run("quality", *asked_of, *storage)
    assert status == 0, err
    return {row["encoding"]: row["angle_mean_deg"] for row in json.loads(out)}


@pytest.mark.usefixtures("gl")
def test_octahedral_has_the_expected_mean_in_every_form(run, tmp_path, files=OF_OCTAHEDRAL):
    """The forms cover names, main, uniforms, absent functions, namespaces, defaults, include roots and endings."""
    means = angles(run, tmp_path, files, "sphere")
    assert len(means) == len(files)
    assert means == {name: pytest.approx(OCTAHEDRAL, abs=0.002) for name in means}


@pytest.mark.usefixtures("gl")
def test_xy_has_the_expected_mean_in_every_form(run, tmp_path, files=OF_XY):
    """The forms cover half literals, overloads, Unity's types, structures and WGSL with engines' preprocessors."""
    means = angles(run, tmp_path, files, "hemisphere")
    _, out, _ = run(
        *("quality", "--encoding", "xy", "--storage", "rg8", "--backend", "glsl", "--count", "65536"),
        *("--normals", "hemisphere", "--format", "json"),
    )
    (row,) = json.loads(out)
    assert len(means) == len(files)
    assert means == {name: pytest.approx(row["angle_mean_deg"], rel=1e-4) for name in means}


@pytest.mark.usefixtures("gl", "slang")
def test_pair_that_round_trips_is_measured(run, tmp_path):
    """If several pairs round-trip, each is measured."""
    path = tmp_path / "mine.hlsl"
    path.write_text(
        "float2 MapA(float3 n) { return n.xy; }\nfloat2 MapB(float3 n) { return n.zz; }\n"
        "float3 BackA(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
    )
    words = ("--storage", "rg8", "--normals", "hemisphere", "--count", "4096", "--backend", "glsl", "--format", "json")
    _, out, _ = run("quality", "--encoding", str(path), *words)
    (row,) = json.loads(out)
    assert row["encoding"] == "mine.hlsl:MapA" and row["angle_mean_deg"] == pytest.approx(0.463, abs=0.01)
    _, out, _ = run("quality", "--encoding", str(FORMS / "many.hlsl"), *words)
    assert [row["encoding"] for row in json.loads(out)] == [f"many.hlsl:dir_to_oct_{end}" for end in ("snorm", "unorm")]


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("count", [300])
def test_hundreds_of_invalid_functions_do_not_block_a_pair(tmp_path, count):
    path = tmp_path / "mine.slang"
    wrong = "".join(f"float unused_{number}(float2 p)\n{{ return gone(p).x; }}\n" for number in range(count))
    wrong += "".join(f"Gone{number} lost_{number}(float2 p)\n{{ return gone(p).x; }}\n" for number in range(count))
    path.write_text(
        "float2 PackDir(float3 n) { return n.xy; }\n" + wrong + "float3 UnpackDir(float2 e) { return float3(e, 0); }\n"
    )
    assert "gone" not in translated(path).text


# The mean, of which normals, and the bits that are used.
PACKED = {
    "uint.hlsl:PackDir32:UnpackDir32": (0.00261, "sphere", 32),
    "uint_only.hlsl": (0.3385, "sphere", 24),
    "float.hlsl": (0.8607, "hemisphere", 16),
}


@pytest.mark.usefixtures("gl", "slang")
@pytest.mark.parametrize("name", PACKED)
def test_an_integer_code_is_measured_unchanged(run, name):
    """A packed code is stored exactly and has one row, whatever storages are requested. Mean angles are 0.00261
    degrees for octahedral truncated to 16:16, twice the error of rounding; 0.3385 for 8:8:8, truncated and
    normalised; 0.8607 for xy in 8:8."""
    mean, normals, bits = PACKED[name]
    storage = ("--storage", "rg8,rg16", "--backend", "glsl", "--count", "65536", "--format", "json")
    status, out, err = run("quality", "--encoding", str(FORMS / name), "--normals", normals, *storage)
    (row,) = json.loads(out)
    assert status == 0 and CUT_OFF in err and (row["storage"], row["bits"]) == ("bits32", bits)
    assert row["angle_mean_deg"] == pytest.approx(mean, rel=0.005)


@pytest.mark.usefixtures("gl", "slang")
def test_packed_pair_next_to_another_is_reported(run):
    storage = ("--storage", "rg8", "--backend", "glsl", "--count", "4096", "--format", "json")
    _, out, err = run("quality", "--encoding", str(FORMS / "uint.hlsl"), "--normals", "sphere", *storage)
    assert json.loads(out)[0]["storage"] == "rg8"
    assert "PackDir32:UnpackDir32, which packs into a uint, is measured only if named" in err
