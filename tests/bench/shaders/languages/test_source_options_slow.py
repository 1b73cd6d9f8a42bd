"""Settings for reading users' files, given after the file name: macros, preludes, include folders and languages."""

import json

import pytest
import test_source_options
from test_source_options import PAIR
from typed import layouts_named, translated, word_with

from normalbench.bench.ground.output.errors import UsageError

pytestmark = pytest.mark.usefixtures("in_this_process")
mine = test_source_options.mine


OWN_LAYOUT = """
encoding = "octahedral"
targets = [{ format = "rg8", holds = "normal.x normal.y" }]
"""


@pytest.mark.usefixtures("slang")
def test_macros_and_preludes_are_read_first(tmp_path, mine):
    with pytest.raises(UsageError, match=r"SCALE.*; define missing macros with -D or --prelude"):
        translated(mine)
    (tmp_path / "pre.hlsl").write_text("#define SCALE 1.0\n")
    by_macro = translated(word_with(str(mine), define="SCALE=1.0"))
    by_prelude = translated(word_with(str(mine), prelude=str(tmp_path / "pre.hlsl")))
    assert [by_macro.name, by_prelude.name] == ["mine.hlsl:SCALE=1.0", "mine.hlsl"]
    assert "read with -D SCALE=1.0" in by_macro.notes
    assert f"read with {tmp_path / 'pre.hlsl'}" in by_prelude.notes
    with pytest.raises(UsageError, match=r"--define:1:.*oops.*-D or --prelude"):
        translated(word_with(str(mine), define="SCALE=oops"))


@pytest.mark.usefixtures("gl", "slang")
def test_layout_accepts_settings_after_the_file_name(mine):
    """The files must be in the layout's folder or below it."""
    (mine.parent / "pre.hlsl").write_text("#define SCALE 1.0\n")
    layout, text = mine.parent / "mine.toml", OWN_LAYOUT.replace('"octahedral"', '"mine.hlsl:prelude=pre.hlsl"')
    layout.write_text(text)
    (parsed,) = layouts_named(str(layout))
    assert parsed.encoding.name == "mine.hlsl"
    layout.write_text(text.replace("=pre", "=../pre"))
    with pytest.raises(UsageError, match="is not in the layout's folder"):
        layouts_named(str(layout))


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
def test_every_command_accepts_macros(run, mine, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    status, _, err = run(*command, str(mine), "-D", "SCALE=1.0", "-o", "out")
    assert status == 0, err


@pytest.mark.usefixtures("gl", "slang")
def test_rows_record_the_settings_they_were_read_with(run, mine, tmp_path):
    """Each macro value gives another row; the nightly test sends the same options to workers."""
    rows_by_macros(run, mine, tmp_path)


def rows_by_macros(run, mine, tmp_path) -> tuple:
    """Return the arguments of `quality`, and the mean angle with the macro set to 1."""
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
