"""Users' code that hangs, crashes, exhausts memory or lies, and loses only its own rows with a stated reason."""

import pytest
from typed import read_encoding

from normalbench.bench.ground.output.errors import UsageError
from normalbench.gbuffer.gl import shader

pytestmark = pytest.mark.usefixtures("gl")


GOOD = """
vec2 NAME_encode(vec3 n, vec3 view) { return n.xy; }
vec3 NAME_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }
"""


def test_a_file_outside_the_shaders_folder_is_not_opened(tmp_path, monkeypatch):
    """The includes of such a file would also be read, and an error message could quote them."""
    note, opened = tmp_path / "note.txt", []
    note.write_text("password\n#include SECRET_WORD\n")
    path = tmp_path / "own" / "mine.glsl"
    path.parent.mkdir()
    path.write_text(f'#include "{note}"\n' + GOOD.replace("NAME", "mine"))
    read = shader.read_shader
    monkeypatch.setattr(shader, "read_shader", lambda file: opened.append(file) or read(file))
    with pytest.raises(UsageError, match=r"note\.txt is outside the folder of the shader; move it there"):
        read_encoding(path)
    assert path in opened and note not in opened


@pytest.mark.parametrize("letter", ['"', "\n", "\x0b", "\u2028"])
def test_a_path_cannot_break_the_include_line(tmp_path, letter):
    """For codes in [0, 1], generated text includes the file."""
    path = tmp_path / f"a{letter}b" / "mine.glsl"
    path.parent.mkdir()
    path.write_text(GOOD.replace("NAME", "mine"))
    with pytest.raises(UsageError, match="its name has quotes or control characters; rename it"):
        read_encoding(path, is_unit=True)


@pytest.mark.parametrize("ending", ["glsl", "txt"])
@pytest.mark.parametrize("text", ['#include "NOTE"', '/*\n#include "NOTE"\n*/', '\u2028#include "NOTE"'])
def test_only_shader_files_in_the_repository_are_included(run, tmp_path, text, ending):
    """Neither a file outside the repository nor a file without a shader extension is compiled."""
    home, note = tmp_path / "own", tmp_path / ("elsewhere" if ending == "glsl" else "own") / f"note.{ending}"
    (home / ".git").mkdir(parents=True)
    note.parent.mkdir(exist_ok=True)
    note.write_text("float two() { return 2.0; }\n")
    path = home / "mine.glsl"
    path.write_text(
        text.replace("NOTE", str(note)) + GOOD.replace("NAME", "mine").replace("return n.xy;", "return n.xy * two();")
    )
    status, _, err = run("quality", "--encoding", str(path), "--storage", "rg8", "--count", "1000")
    assert (status, err) == (
        2,
        f"normalbench: {path}: the included file {note} is outside the folder of the shader; move it there\n",
    )
