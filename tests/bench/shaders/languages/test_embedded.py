"""Shaders embedded in files of other languages, and in files with any extension."""

import pytest

from normalbench.bench.ground.user_files import UserFile, names_an_encoder
from normalbench.bench.shaders.languages.embedded import shader_text
from normalbench.bench.shaders.languages.items import marked_heads
from normalbench.bench.shaders.languages.language import name_of

PAIR = "vec2 f(vec3 n) { return n.xy; }"


@pytest.mark.parametrize(
    "text",
    [f"const x = 1;\nconst s = /* glsl */ `{PAIR}`;", f"// ours\nexport default `{PAIR}`;\n", f"const s = `{PAIR}`"],
)
def test_a_javascript_template_is_read_at_its_original_position(text):
    shader = shader_text(text, ".js")
    assert shader.strip() == PAIR and len(shader) == len(text) and shader.index(PAIR) == text.index(PAIR)


@pytest.mark.parametrize(
    "text", [f"f(`{PAIR}`); g();", f"const a = '{PAIR}'; const b = 2;", "", "const a = `x`, b = `y`;"]
)
def test_other_javascript_strings_are_not_read(text):
    assert not shader_text(text, ".ts").strip()


def test_only_the_body_of_a_shader_class_is_read():
    text = "namespace A.B\n{\n  shader X<int N> : Y, Z\n  {\n    override float f() { return 1; }\n  };\n}\n"
    shader = shader_text(text, ".sdsl")
    assert shader.strip() == "float f() { return 1; }" and shader.count("\n") == text.count("\n")
    assert shader_text("float f() { return 1; }", ".sdsl") == "float f() { return 1; }"


def test_existing_text_file_with_an_unknown_extension_is_read(tmp_path, monkeypatch):
    """The file must be text, and its extension must not belong to another format or language."""
    monkeypatch.chdir(tmp_path)
    for name in ("mine.code", "rows.csv", "mine.metal"):
        (tmp_path / name).write_text("fn f(n: vec3<f32>) -> vec2<f32> { return n.xy; }")
    (tmp_path / "mine.bin").write_bytes(b"\0\1")
    named = [
        name for name in ("mine.code", "rows.csv", "mine.metal", "mine.bin", "none.code") if names_an_encoder(name)
    ]
    assert named == ["mine.code"]
    assert name_of(UserFile("mine.code")) == "WGSL" and name_of(UserFile("mine.code:language=hlsl")) == "HLSL"
    assert UserFile("mine.code:f:g").functions == ("f", "g")


def test_prefix_is_added_only_to_names_of_functions():
    text = "struct S { float and; };\nbool2 and(bool2 a) { return a; }\n[a(and)] float or ( float x ) { return x; }"
    assert [line.strip() for line in marked_heads(text, "m_").split("\n")] == [
        "struct S { float and; };",
        "bool2 m_and(bool2 a) ;",
        "[a(and)] float m_or ( float x ) ;",
    ]
