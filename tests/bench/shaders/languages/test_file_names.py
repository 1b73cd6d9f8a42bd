"""Files whose names have a comma or a plus."""

import json
import shutil

from manual import ROOT

from normalbench.bench.ground.user_files import file_names, files_in, with_files


def test_a_comma_may_be_part_of_a_file_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my,file.hlsl").touch()
    (tmp_path / "a,b").mkdir()
    (tmp_path / "a,b" / "c.npy").touch()
    assert file_names("octahedral,my,file.hlsl:A:B, xyz") == ("octahedral", "my,file.hlsl:A:B", "xyz")
    assert file_names("my,file.hlsl:define=X,your,file.hlsl") == ("my,file.hlsl:define=X", "your", "file.hlsl")
    assert file_names("sphere,a,b/c.npy") == ("sphere", "a,b/c.npy")
    assert files_in("my,file.hlsl:A:B") == ["my,file.hlsl"]
    assert with_files("my,file.hlsl:A:B", {"my,file.hlsl": "x/my,file.hlsl"}) == "x/my,file.hlsl:A:B"


def test_normals_file_with_a_comma_is_measured(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "tests" / "inputs" / "normals" / "points.ply", tmp_path / "my,points.ply")
    words = ("--normals", "my,points.ply,axes", "--backend", "jax", "--encoding", "xyz", "--format", "json")
    status, out, err = run("quality", *words)
    assert status == 0, err
    assert {row["normals"] for row in json.loads(out)} == {"my,points.ply", "axes"}
