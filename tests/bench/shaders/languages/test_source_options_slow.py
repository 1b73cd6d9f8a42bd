"""How users' files are read: macros, preludes, folders of includes and languages, as a part of their names."""

import json

import pytest
import test_source_options
from test_source_options import PAIR

mine = test_source_options.mine


@pytest.mark.usefixtures("gl", "slang")
@pytest.mark.parametrize(
    "command",
    [
        ("doctor",),
        ("code", "--to", "glsl", "--storage", "rg8"),
        ("run", "--tables", "quality", "--storage", "rg8", "--normals", "axes", "--backend", "glsl", "--encoding"),
    ],
    ids=lambda command: command[0],
)
def test_every_command_takes_them(run, mine, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    status, _, err = run(*command, str(mine), "-D", "SCALE=1.0", "-o", "out")
    assert status == 0, err


@pytest.mark.usefixtures("gl", "slang")
def test_rows_say_what_they_were_read_with(run, mine, tmp_path):
    """Another macro is another row; workers are sent the same at night."""
    rows_by_macros(run, mine, tmp_path)


def rows_by_macros(run, mine, tmp_path) -> tuple:
    """What is asked of `quality`, and the mean angle where a macro is 1."""
    library = tmp_path / "library"
    library.mkdir()
    (library / "half.hlsl").write_text("#define SCALE (HALF)\n")
    mine.write_text('#include "Library/half.hlsl"\n' + PAIR)
    asked = ("quality", "--encoding", str(mine), "--storage", "rg8", "--backend", "glsl", "--count", "4096")
    asked += ("--normals", "hemisphere", "--include", f"Library={library}", "--format", "json")
    means = {}
    for half in ("1.0", "0.5"):
        status, out, err = run(*asked, "-D", f"HALF={half}")
        assert status == 0, err
        (row,) = json.loads(out)
        assert row["encoding"] == f"mine.hlsl:HALF={half}" and f"{library / 'half.hlsl'}" in err
        means[half] = row["angle_mean_deg"]
    assert means["0.5"] > 10 * means["1.0"], means
    return asked, means["1.0"]
