"""Files whose names have a comma or a plus."""

import json
import shutil

import pytest
from manual import ROOT

from normalbench.bench.ground.choose import file_names
from normalbench.bench.shaders.languages.words import files_in, split_names, with_files

FORMS = ROOT / "tests" / "inputs" / "encoders"
OCTAHEDRAL = 0.3356


def test_a_comma_in_a_files_name_is_a_part_of_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my,file.hlsl").touch()
    (tmp_path / "a,b").mkdir()
    (tmp_path / "a,b" / "c.npy").touch()
    assert split_names("octahedral,my,file.hlsl:A:B, xyz") == ["octahedral", "my,file.hlsl:A:B", "xyz"]
    assert split_names("my,file.hlsl:define=X,your,file.hlsl") == ["my,file.hlsl:define=X", "your", "file.hlsl"]
    assert file_names("sphere,a,b/c.npy") == ["sphere", "a,b/c.npy"]
    assert files_in("my,file.hlsl:A:B") == ["my,file.hlsl"]
    assert with_files("my,file.hlsl:A:B", {"my,file.hlsl": "x/my,file.hlsl"}) == "x/my,file.hlsl:A:B"


@pytest.mark.slow
@pytest.mark.usefixtures("gl", "slang")
@pytest.mark.parametrize("more", [(), ("--on", "local:1")])
def test_files_of_such_names_are_measured(run, tmp_path, monkeypatch, more):
    """By their functions as well, and by workers."""
    monkeypatch.chdir(tmp_path)
    names = ("comma/mine.hlsl", "my,file.hlsl", "a,b/other.hlsl", "a+b/plus.hlsl", "c+d/named.hlsl:PackDir:UnpackDir")
    for name in names:
        path = tmp_path / name.partition(":")[0]
        path.parent.mkdir(exist_ok=True)
        shutil.copy(FORMS / "a+b" / "mine.hlsl", path)
    asked = ("--storage", "rg8", "--backend", "glsl", "--count", "65536", "--normals", "sphere", "--format", "json")
    status, out, err = run("quality", "--encoding", ",".join(names), *asked, *more)
    assert status == 0, err
    found = {row["encoding"]: row["angle_mean_deg"] for row in json.loads(out)}
    assert len(found) == len(names)
    assert found == {name: pytest.approx(OCTAHEDRAL, abs=0.002) for name in found}
    for word in ("my,file.hlsl", "c+d/named.hlsl:PackDir:UnpackDir"):
        status, out, err = run("doctor", word)
        assert status == 0, err


def test_normals_of_such_a_name_are_measured(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "tests" / "inputs" / "normals" / "points.ply", tmp_path / "my,points.ply")
    words = ("--normals", "my,points.ply,axes", "--backend", "jax", "--encoding", "xyz", "--format", "json")
    status, out, err = run("quality", *words)
    assert status == 0, err
    assert {row["normals"] for row in json.loads(out)} == {"my,points.ply", "axes"}
