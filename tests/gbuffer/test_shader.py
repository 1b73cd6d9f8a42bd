"""The shader loader: single inclusion, and errors that name the file and the line."""

from dataclasses import replace

import pytest

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.codecs.codec_passes import CodecPasses
from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError, Source, glsl_value


def test_an_include_is_pasted_once(tmp_path):
    (tmp_path / "a.glsl").write_text("float a;  // X\n")
    (tmp_path / "b.glsl").write_text('#include "a.glsl"\nfloat b;\n')
    (tmp_path / "main.frag").write_text('#version 430\n#include "a.glsl"\n#include "b.glsl"\n#include NAMED\n')
    text = Source(tmp_path / "main.frag", {"X": "Y", "Y": 1.5, "Z": 2}, {"NAMED": tmp_path / "b.glsl"}).text
    assert text.count("float a;") == text.count("float b;") == 1
    assert text.startswith("#version 430\n#define X Y\n#define Y 1.5\n"), "what nothing mentions is left out"


@pytest.mark.parametrize("broken", ["return nonsense;", "return no_such_function(n.xy);", "return n;", "retrun n.xy;"])
def test_error_in_an_encoding_names_its_file_and_line(gl, tmp_path, broken):
    """This holds for every mistake: Mesa omits the source string in some messages, but the loader does not."""
    original = ENCODINGS["octahedral"]
    mine = tmp_path / "octahedral.glsl"
    decode = "vec3 octahedral_decode(vec2 e, vec3 view) { return vec3(e, 0.0); }"
    mine.write_text(f"// Mine.\n\nvec2 octahedral_encode(vec3 n, vec3 view) {{\n    {broken}\n}}\n{decode}\n")
    with (
        pytest.raises(ShaderError, match=r"octahedral\.glsl:4"),
        CodecPasses(gl, Codec(replace(original, glsl=mine), STORAGES["rg8"])),
    ):
        pass


@pytest.mark.parametrize("wrong", ["vec3 octahedral_encode(vec3 n, vec3 view)", "vec2 mine_encode(vec3 n, vec3 view)"])
def test_missing_function_is_reported_before_compilation(gl, tmp_path, wrong):
    original = ENCODINGS["octahedral"]
    mine = tmp_path / "octahedral.glsl"
    mine.write_text(original.glsl.read_text().replace("vec2 octahedral_encode(vec3 n, vec3 view)", wrong))
    with pytest.raises(ShaderError, match=r"octahedral\.glsl: no function vec2 octahedral_encode\(vec3 n, vec3 view\)"):
        CodecPasses(gl, Codec(replace(original, glsl=mine), STORAGES["rg8"]))


def test_values_are_written_in_glsl_syntax():
    assert glsl_value(2.0**-120) == "7.52316384526264e-37"
    assert glsl_value((1.0, 0.5)) == "float[2](1.0, 0.5)"
    assert glsl_value(3) == "3"


def test_a_compile_error_names_the_included_file_and_its_line(gl, tmp_path):
    (tmp_path / "mine.glsl").write_text("float fine;\n\nvec2 broken() { return nonsense; }\n")
    (tmp_path / "main.frag").write_text(
        '#version 430\n#include "mine.glsl"\nout vec4 o;\nvoid main() { o = vec4(0); }\n'
    )
    with pytest.raises(ShaderError, match=r"mine\.glsl:3"):
        gl.fragment_pass(tmp_path / "main.frag")
    (tmp_path / "mine.glsl").write_text("float fine;\n")
    (tmp_path / "main.frag").write_text('#version 430\n#include "mine.glsl"\nout vec4 o;\nvoid main() { o = oops; }\n')
    with pytest.raises(ShaderError, match=r"main\.frag:4"):
        gl.fragment_pass(tmp_path / "main.frag")


def test_missing_include_is_a_one_line_error(tmp_path):
    (tmp_path / "main.frag").write_text('#version 430\n#include "nowhere.glsl"\n')
    with pytest.raises(ShaderError, match=r"nowhere\.glsl: there is no such file"):
        Source(tmp_path / "main.frag")
    (tmp_path / "main.frag").write_text("#version 430\n#include NOBODY\n")
    with pytest.raises(ShaderError, match=r"main\.frag:2: unknown include name NOBODY"):
        Source(tmp_path / "main.frag")


def test_every_shader_has_a_unique_name(tmp_path, monkeypatch):
    """An include is found by name alone; two files with the same name are a one-line error."""
    assert shader.shaders()["gbuffer.glsl"].parent.name == "glsl"
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "same.glsl").write_text("float same;\n")
    monkeypatch.setattr(shader, "ROOM", tmp_path)
    with pytest.raises(ShaderError, match=r"two shaders have the same name: .*a/same\.glsl and .*b/same\.glsl"):
        shader.shaders.__wrapped__()
