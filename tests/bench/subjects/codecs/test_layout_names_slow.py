"""Layout files that name users' encoders: measurement, changes and one-line errors."""

import json
from pathlib import Path

import pytest
from test_layout_names import written

pytestmark = pytest.mark.usefixtures("gl")


def test_a_layout_accepts_a_users_encoder(run, tmp_path, monkeypatch):
    """A user's octahedral encoder is as accurate as the catalogue's; its file is found relative to the layout."""
    monkeypatch.chdir(tmp_path)
    layouts = f"{written(Path('here'), 'code/mine.glsl')},{written(Path('here'), 'octahedral', 'other.toml')}"
    words = ("--scene", "room", "--size", "96x64", "--repeats", "0", "--format", "json")
    status, out, err = run("render", "--layout", layouts, *words)
    assert (status, err) == (0, "")
    own, other = json.loads(out)
    assert (own["encoding"], other["encoding"]) == ("mine", "octahedral")
    assert own["normal_psnr_db"] == pytest.approx(other["normal_psnr_db"], abs=0.1)
