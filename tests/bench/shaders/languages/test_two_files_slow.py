"""An encoder and its decoder in two files: FILE:ENCODE,FILE:DECODE."""

import json

import pytest
import test_two_files
from typed import Source, translated

two = test_two_files.two


@pytest.mark.usefixtures("slang")
def test_shared_definitions_of_two_files_do_not_clash(two):
    translation = translated(two)
    assert translation.name == "enc.hlsl:PackDir:dec.hlsl" and translation.components == 2
    assert [name for name, _ in translation.functions] == ["PackDir", "UnpackDir"]
    places = {line.path.name for line in Source(two).lines}
    assert places == {"enc.hlsl", "dec.hlsl", "common.hlsl"}


@pytest.mark.usefixtures("gl", "slang", "two")
def test_two_files_have_the_figures_of_xy(run, tmp_path, monkeypatch):
    check_figures(run, tmp_path, monkeypatch)


def check_figures(run, tmp_path, monkeypatch, *more: str) -> None:
    monkeypatch.chdir(tmp_path)
    asked = ("--storage", "rg8", "--backend", "glsl", "--count", "65536", "--normals", "hemisphere", "--format", "json")
    words = "enc.hlsl:PackDir,dec.hlsl:UnpackDir,xy"
    status, out, err = run("quality", "--encoding", words, *asked, *more)
    assert status == 0, err
    mine, xy = (row["angle_mean_deg"] for row in json.loads(out))
    assert mine == pytest.approx(xy, rel=1e-4)
    status, out, err = run("doctor", "enc.hlsl:PackDir,dec.hlsl:UnpackDir")
    assert status == 0, err
