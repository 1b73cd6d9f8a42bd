"""Shaders in files of something else, and in files of any ending."""

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
def test_a_template_of_javascript_is_read_where_it_stood(text):
    found = shader_text(text, ".js")
    assert found.strip() == PAIR and len(found) == len(text) and found.index(PAIR) == text.index(PAIR)


@pytest.mark.parametrize(
    "text", [f"f(`{PAIR}`); g();", f"const a = '{PAIR}'; const b = 2;", "", "const a = `x`, b = `y`;"]
)
def test_other_strings_are_not(text):
    assert not shader_text(text, ".ts").strip()


def test_what_stands_in_a_shader_class_is_read_alone():
    text = "namespace A.B\n{\n  shader X<int N> : Y, Z\n  {\n    override float f() { return 1; }\n  };\n}\n"
    found = shader_text(text, ".sdsl")
    assert found.strip() == "float f() { return 1; }" and found.count("\n") == text.count("\n")
    assert shader_text("float f() { return 1; }", ".sdsl") == "float f() { return 1; }"


def test_a_file_that_is_there_is_read_whatever_its_ending(tmp_path, monkeypatch):
    """Text alone, and none of another thing's or language's ending."""
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


def test_a_mark_stands_before_the_names_of_functions_alone():
    text = "struct S { float and; };\nbool2 and(bool2 a) { return a; }\n[a(and)] float or ( float x ) { return x; }"
    assert [line.strip() for line in marked_heads(text, "m_").split("\n")] == [
        "struct S { float and; };",
        "bool2 m_and(bool2 a) ;",
        "[a(and)] float m_or ( float x ) ;",
    ]
