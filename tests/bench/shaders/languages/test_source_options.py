"""Settings for reading users' files, given after the file name: macros, preludes, include folders and languages."""

from pathlib import Path

import pytest
from typed import Source, translated, word_with

from normalbench.bench.door.gates.measured import located
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.user_files import UserFile, files_in
from normalbench.bench.tables.quality.table import QualityOptions
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.codecs.variants import settings_in

pytestmark = pytest.mark.usefixtures("in_this_process")


PAIR = """float2 PackDir(float3 n) { return n.xy * SCALE; }
float3 UnpackDir(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }
"""


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "own" / "mine.hlsl"
    path.parent.mkdir()
    (path.parent / ".git").mkdir()
    path.write_text(PAIR)
    return path


@pytest.mark.parametrize(
    "word", ["mine.hlsl", "mine.hlsl:A:B", "a+b/mine.hlsl.h:A::B:C", "my,file.hlsl", "mine.hlsl:Foo", "octahedral"]
)
def test_settings_follow_the_file_name(word):
    more = word_with(word, define="A=1,B", prelude="pre.hlsl", include="x,Packages=../y", language="slang")
    if "Foo" in word or word == "octahedral":
        assert more == word
        return
    assert (UserFile(more).path, UserFile(more).functions) == (UserFile(word).path, UserFile(word).functions)
    settings = UserFile(more).settings
    assert settings.defines == ("A=1", "B") and settings.preludes == ("pre.hlsl",)
    assert settings.roots == (("", "x"), ("Packages", "../y")) and settings.language == "Slang"
    assert word_with(more, define="B,A=1") == more


def test_define_applies_only_to_users_files():
    options = QualityOptions(encoding="octahedral,mine.hlsl", define="A=1")
    assert options.encoding == ("octahedral", "mine.hlsl:define=A=1")
    with pytest.raises(UsageError, match="--define applies only to your own shader files"):
        QualityOptions(define="A=1")


@pytest.mark.parametrize(
    "settings, why",
    [
        ({"define": "A=f(1,2)"}, r"-D '2\)': must be NAME or NAME=VALUE"),
        ({"define": "A=1\r#error"}, "not a valid value"),
        ({"define": "A=b:c"}, "the value must not contain a colon"),
        ({"language": "metal"}, "must be one of hlsl, slang, wgsl, glsl"),
        ({"prelude": "gone.hlsl"}, "gone.hlsl: there is no such file"),
        ({"prelude": "\0.hlsl"}, "not a valid value"),
        ({"include": "gone"}, "--include gone: no such folder; name the folder that holds the included files"),
        ({"include": "Packages=gone"}, "--include gone: no such folder"),
        ({"prelude": "/etc/hostname"}, "must end in a shader's extension"),
    ],
)
def test_invalid_setting_is_an_error(mine, settings, why):
    with pytest.raises(UsageError, match=why):
        Source(word_with(str(mine), **settings))


@pytest.mark.parametrize(
    "name, root",
    [("lib/part.hlsl", ""), ("Packages/lib/part.hlsl", "Packages="), ("/Engine/lib/part.hlsl", "/Engine=")],
)
def test_includes_are_read_from_the_given_folders(tmp_path, mine, name, root):
    """Angle brackets work the same way; no other folder is read."""
    library = tmp_path / "library" / "lib"
    library.mkdir(parents=True)
    (library / "part.hlsl").write_text('#include "next.hlsl"\n#include "../../secret.hlsl"\n#include "notes.txt"\n')
    (library / "next.hlsl").write_text("next")
    (library / "notes.txt").write_text("secret")
    (tmp_path / "secret.hlsl").write_text("secret")
    (library / "link.hlsl").symlink_to(tmp_path / "secret.hlsl")
    for mark in ('"{}"', "<{}>"):
        mine.write_text(f"#include {mark.format(name)}\n#include {mark.format(name.replace('part', 'link'))}\n" + PAIR)
        first = name.strip("/").split("/")[0]
        assert f"name its folder with --include {f'{first}=' * bool(root)}FOLDER" in Source(mine).lines[0].wrong
        source = Source(word_with(str(mine), include=f"{root}{library.parent}"))
        assert "next" in source.text and "secret" not in source.text
        assert {path.name for path in source.files.values()} == {"mine.hlsl", "part.hlsl", "next.hlsl"}
        assert len([line for line in source.lines if "is outside the folder" in line.wrong]) == 3


@pytest.mark.usefixtures("slang")
def test_file_is_read_in_the_given_language(tmp_path):
    path = tmp_path / "mine.h"
    path.write_text("func PackDir(n : float3) -> float2 { return n.xy; }\n" + PAIR.split("\n")[1])
    assert translated(word_with(str(path), language="slang")).components == 2


def test_files_in_settings_are_found(tmp_path, mine):
    (tmp_path / "pre.hlsl").write_text("")
    word = f"{mine}:prelude={tmp_path / 'pre.hlsl'}:include=X={tmp_path}:define=A"
    assert files_in(word) == [str(mine), str(tmp_path / "pre.hlsl"), str(tmp_path)]


def test_gates_resolve_files_and_folders_relative_to_their_own_folder(tmp_path, mine):
    (mine.parent / "pre.hlsl").touch()
    options = {"encoding": "mine.hlsl", "prelude": "pre.hlsl", "include": ("Packages=library", str(tmp_path))}
    resolved = located(TABLES["quality"], options, mine.parent)
    assert {
        name: {Path(word.removeprefix("Packages=")).resolve() for word in words} for name, words in resolved.items()
    } == {
        "encoding": {mine},
        "prelude": {mine.parent / "pre.hlsl"},
        "include": {mine.parent / "library", tmp_path},
    }
    assert resolved["include"][0].startswith("Packages=")


def test_a_windows_path_may_have_a_drive():
    """A colon before a slash does not end a word."""
    word = r"C:\shaders\mine.hlsl:Pack:Unpack:include=C:\library:define=ROUND=1"
    settings = UserFile(word).settings
    assert (str(UserFile(word).path), UserFile(word).functions) == (r"C:\shaders\mine.hlsl", ("Pack", "Unpack"))
    assert [root for _, root in settings.roots] == [r"C:\library"] and settings.defines == ("ROUND=1",)
    assert settings_in(r"best_fit:table=C:\tables\scales.npy:axis=y") == (
        "best_fit",
        {"table": r"C:\tables\scales.npy", "axis": "y"},
    )
