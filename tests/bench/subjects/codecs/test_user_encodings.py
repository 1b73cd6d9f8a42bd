"""Users' encodings from GLSL files, and one-line errors that do not affect other files."""

import json
import re
from pathlib import Path

import pytest
from typed import examined, first_look, read_encoding

from normalbench.bench.ground.directions import directions
from normalbench.bench.ground.machine.systems import linux_forks
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs import user_encodings

pytestmark = pytest.mark.usefixtures("gl")


(MINE,) = re.findall(r"```glsl\n(.*?)```", (Path(__file__).parents[4] / "README.md").read_text(), re.S)


QUICK = ("--normals", "hemisphere", "--count", "65536", "--format", "json")


def written(folder: Path, text: str = MINE, name: str = "mine.glsl") -> str:
    (folder / name).write_text(text)
    return str(folder / name)


@pytest.mark.parametrize("words", ["quality --normals axes --encoding", "depth --depth", "lights --light-buffer"])
def test_unknown_name_next_to_a_missing_file_is_a_one_line_error(run, tmp_path, words):
    """Files that are left out are reported only if the command continues."""
    status, _, err = run(*words.split(), f"{tmp_path / 'missing.glsl'},nothing")
    assert status == 2 and err.startswith("normalbench: unknown ") and err.count("\n") == 1, err


@pytest.mark.usefixtures("gl", "slang")
def test_hlsl_in_a_glsl_file_is_read_as_hlsl(run, tmp_path):
    text = "float2 OctEncode(float3 n) { return n.xy; }\n"
    text += "float3 OctDecode(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
    status, out, _ = run("quality", "--encoding", written(tmp_path, text), "--backend", "glsl", *QUICK)
    assert status == 0 and json.loads(out)[0]["angle_mean_deg"] > 0


def test_second_file_with_the_same_encoding_name_is_left_out(run, tmp_path):
    path, other = written(tmp_path), written(tmp_path, name="other.glsl")
    status, out, err = run("quality", "--encoding", f"{path},{other}", "--backend", "glsl", *QUICK)
    assert status == 0 and len(json.loads(out)) == 1 and "another file has an encoding named mine" in err


@pytest.mark.parametrize(
    "parameters", ["in vec3 n, in vec3 view", "const in vec3 n,\n    vec3 view", "vec3 n , vec3 v"]
)
def test_parameters_are_written_as_glsl_allows(tmp_path, parameters):
    path = tmp_path / "mine.glsl"
    path.write_text(
        f"vec2 mine_encode({parameters}) {{ return n.xy; }}\n"
        "vec3 mine_decode(in vec2 e, const vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }"
    )
    assert first_look(path) == {"domain": "hemisphere", "wrong": []}


def test_unread_uniforms_and_buffers_are_ignored(tmp_path):
    told = MINE.replace("mine", "other")
    path = written(
        tmp_path,
        "uniform float unread; uniform float half_of_it = 0.5;\nbuffer B { int q; } b;\nbuffer C { float x; };\n"
        + MINE
        + told,
    )
    assert examined(path).notes[0] == "only mine is measured; move other into a separate file"


@pytest.mark.parametrize(
    "before, told",
    [
        ("layout(std140) uniform Camera { mat4 view; mat4 proj; };", ""),
        ("uniform vec3[4] kernel;", ""),
        ("#if 0\nuniform float k;\n#else\nconst float k = 2.0;\n#endif\nfloat q() { return k; }", ""),
        ("uniform vec3[4] kernel; vec3 q() { return kernel[0]; }", "the uniform kernel"),
        ("uniform U { float a[4], k; } u; float q() { return u.k; }", "the block u"),
        ("uniform U { float a[4], k; }; float q() { return a[0]; }", "a of a block"),
        ('#include "below.glsl"\nfloat q() { return below; }', "the uniform below"),
    ],
)
def test_only_uniforms_and_blocks_that_are_read_are_refused(tmp_path, before, told):
    written(tmp_path, "uniform float below;", "below.glsl")
    path = Path(written(tmp_path, f"{before}\n{MINE}"))
    if not told:
        assert read_encoding(path).name == "mine"
        return
    with pytest.raises(UsageError, match=f"mine.glsl: it reads {told}, which has no value here"):
        read_encoding(path)


def test_missing_file_is_a_one_line_error(run, tmp_path):
    status, _, err = run("quality", "--encoding", str(tmp_path / "none.glsl"), *QUICK)
    assert (status, err) == (2, f"normalbench: {tmp_path / 'none.glsl'}: there is no such file\n")


def test_a_shader_that_does_not_end_or_kills_the_process_is_reported(run, tmp_path, monkeypatch):
    path = written(tmp_path)
    monkeypatch.setattr(user_encodings, "TIME_LIMIT", 0.01)
    status, _, err = run("quality", "--encoding", path, *QUICK)
    assert status == 2 and "did not end within 0.01 s" in err
    monkeypatch.setattr(user_encodings, "TIME_LIMIT", 60.0)
    killer = tmp_path / "python"
    killer.write_text("#!/bin/sh\nkill -SEGV $$\n")
    killer.chmod(0o755)
    # What was started before is another Python.
    linux_forks._forking.end()
    monkeypatch.setattr(user_encodings.sys, "executable", str(killer))
    status, _, err = run("quality", "--encoding", path, *QUICK)
    assert status == 2 and "killed the process (SIGSEGV)" in err


def test_the_first_look_finds_the_domain(tmp_path):
    look = first_look(Path(written(tmp_path)))
    assert look == {"domain": "hemisphere", "wrong": []}
    assert len(directions()) > 4000
    assert read_encoding(Path(written(tmp_path))).components == 2
