"""Encoders in the forms that engines use, read unchanged and measured like the catalogue's encodings."""

from pathlib import Path

import pytest
from typed import Source, translated

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.languages.items import functions_in, items, without

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.mark.usefixtures("slang")
def test_error_gives_the_position_and_the_missing_include(tmp_path):
    """The error has the line and column that the compiler refuses, and the missing include."""
    path = tmp_path / "mine.slang"
    path.write_text(
        '#include "gone.hlsli"\n'
        "float2 PackDir(float3 n) { return gone(n).xy; }\n"
        "float3 UnpackDir(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
    )
    with pytest.raises(UsageError) as error:
        translated(path)
    text = str(error.value)
    assert f"{path}:2:35: undefined identifier 'gone'" in text and f"{path}:1: gone.hlsli is not next to" in text, text


@pytest.mark.usefixtures("slang")
def test_a_refused_overload_is_not_replaced_by_another(tmp_path):
    path = tmp_path / "mine.slang"
    path.write_text(
        "float helped(float x) { return gone(x); }\nfloat helped(int x) { return float(x); }\n"
        "float2 PackDir(float3 n) { return float2(helped(n.x), n.y); }\n"
        "float3 UnpackDir(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
    )
    with pytest.raises(UsageError, match=":1:32: undefined identifier 'gone'"):
        translated(path)


@pytest.mark.usefixtures("slang")
def test_code_that_the_pair_does_not_need_is_not_compiled(tmp_path):
    """The file has invalid functions, globals and branches, a head inside a branch and a wrongly bound buffer."""
    path = tmp_path / "mine.hlsl"
    path.write_text(
        "#if NOT_DEFINED\n#error no\nfloat2 PackDir(float x) {\n#else\nfloat2 PackDir(float3 n) {\n#endif\n"
        "return n.xy; }\nGone lost;\nfloat4 lit(Gone g) { return g.x; }\nfloat3 dim(float3 c) { return gone(c); }\n"
        "cbuffer Wrong : register(c0) { float4 k; }\n"
        "namespace A { float z(float2 e) { return sqrt(saturate(1.0 - dot(e, e))); } float w() { return gone(); } }\n"
        "float3 UnpackDir(float2 e) { return float3(e, A::z(e)); }\n"
    )
    text = translated(path).text
    assert "gone" not in text and "Gone" not in text and "Wrong" not in text and "A::z(e)" in text


def test_items_are_top_level_declarations():
    text = "#define A {\nstruct S { int x; };\n"
    text += "float2 f(float3 n) : A { if (n.x > 0) { return n.xy; } return n.yx; }\nint g;\n"
    pieces = items(text)
    assert "".join(text[item.start : item.end] for item in pieces) == text
    assert functions_in(text) == ["f"]
    cut = without(text, [item for item in pieces if "f(" in text[item.start : item.end]])
    assert cut.count("\n") == text.count("\n") and "f(" not in cut and "int g;" in cut and "#define A {" in cut
    assert functions_in("namespace A { namespace B { int f(int x) { return x; } } }") == ["A::B::f"]


def test_includes_are_searched_up_to_the_repository_and_no_further(tmp_path):
    """At most eight folders below the home folder are searched, only for shader files and never through links."""
    deep = tmp_path / "outer" / "repository" / "a" / "b"
    deep.mkdir(parents=True)
    (tmp_path / "outer" / "repository" / ".git").mkdir()
    for folder in (tmp_path / "outer", tmp_path / "outer" / "repository"):
        (folder / "inc").mkdir()
        (folder / "inc" / f"{folder.name}.hlsl").write_text(f"// {folder.name}\nint {folder.name};\n")
    (tmp_path / "outer" / "repository" / "inc" / "secret.txt").write_text("int secret;\n")
    (tmp_path / "outer" / "repository" / "inc" / "link.hlsl").symlink_to(tmp_path / "outer" / "inc" / "outer.hlsl")
    path = deep / "mine.hlsl"
    names = ("inc/repository.hlsl", "inc/outer.hlsl", "inc/secret.txt", "inc/link.hlsl")
    path.write_text("".join(f'#include "{name}"\n' for name in names))
    source = Source(path)
    assert "int repository;" in source.text and "int outer;" not in source.text and "secret" not in source.text
    assert [line.wrong.split()[0] for line in source.lines if line.wrong] == list(names[1:])


def test_home_folder_is_not_searched(tmp_path, monkeypatch):
    home = tmp_path / "home"
    (home / "project").mkdir(parents=True)
    monkeypatch.setattr(Path, "home", lambda: home)
    (home / "own.hlsl").write_text("int own;\n")
    (home / "project" / "mine.hlsl").write_text('#include "own.hlsl"\n')
    assert "int own;" not in Source(home / "project" / "mine.hlsl").text
