"""Files whose names have a comma or a plus."""

import json
import shutil

import pytest
from manual import ROOT

FORMS = ROOT / "tests" / "inputs" / "encoders"


OCTAHEDRAL = 0.3356


@pytest.mark.usefixtures("gl", "slang")
def test_files_with_commas_and_pluses_are_measured(run, tmp_path, monkeypatch):
    """Files are also named with their functions; the nightly test sends the files to workers."""
    check_measured(run, tmp_path, monkeypatch)


def check_measured(run, tmp_path, monkeypatch, *more: str) -> None:
    monkeypatch.chdir(tmp_path)
    names = ("comma/mine.hlsl", "my,file.hlsl", "a,b/other.hlsl", "a+b/plus.hlsl", "c+d/named.hlsl:PackDir:UnpackDir")
    for name in names:
        path = tmp_path / name.partition(":")[0]
        path.parent.mkdir(exist_ok=True)
        shutil.copy(FORMS / "a+b" / "mine.hlsl", path)
    asked = ("--storage", "rg8", "--backend", "glsl", "--count", "65536", "--normals", "sphere", "--format", "json")
    status, out, err = run("quality", "--encoding", ",".join(names), *asked, *more)
    assert status == 0, err
    means = {row["encoding"]: row["angle_mean_deg"] for row in json.loads(out)}
    assert len(means) == len(names)
    assert means == {name: pytest.approx(OCTAHEDRAL, abs=0.002) for name in means}
    for word in ("my,file.hlsl", "c+d/named.hlsl:PackDir:UnpackDir"):
        status, out, err = run("doctor", word)
        assert status == 0, err
