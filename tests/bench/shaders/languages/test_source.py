"""A file with its includes: the folders that may be read, and the original position of each line."""

import pytest
from typed import Source

from normalbench.bench.ground.compilers.lines import bare, without_comments
from normalbench.bench.ground.output.errors import UsageError


def written(folder, text, name="mine.hlsl"):
    (folder / name).write_text(text)
    return folder / name


def test_lines_keep_their_file_and_number(tmp_path):
    written(tmp_path, "one\ntwo", "part.hlsli")
    path = written(tmp_path, '/* a\ncomment */ first\n#include "part.hlsli"\nlast')
    source = Source(path)
    assert source.text.split() == ["first", "one", "two", "last"]
    assert [(line.path.name, line.number) for line in source.lines if line.text.strip()] == [
        ("mine.hlsl", 2),
        ("part.hlsli", 1),
        ("part.hlsli", 2),
        ("mine.hlsl", 4),
    ]
    # "last" stands once in its line, so its column is known.
    assert source.explained(5, "wrong", "last") == f"{path}:4:1: wrong"
    assert source.explained(99, "wrong") == f"{path}:4: at the end of the file: wrong"


@pytest.mark.parametrize("guard", ["#pragma once\n", ""])
def test_a_file_does_not_include_itself(tmp_path, guard):
    """With `#pragma once` a file is also included only once."""
    written(tmp_path, f'{guard}#include "mine.hlsl"\npart', "part.hlsli")
    words = Source(written(tmp_path, '#include "part.hlsli"\n#include <part.hlsli>\nmine')).text.split()
    assert [word for word in words if word in ("part", "mine")] == ["part"] * (1 if guard else 2) + ["mine"]


ONCE, GUARD = "#pragma once\npart", "\n#ifndef PART\n#define PART\npart\n#endif"


@pytest.mark.parametrize("part, times", [("part", 2), (ONCE, 2), (GUARD, 2)])
def test_each_branch_has_its_own_includes(tmp_path, part, times):
    """Every branch keeps its include, whichever is compiled; a guarded file that was read before is left out."""
    written(tmp_path, part, "part.hlsli")
    text = '#if A\n#include "part.hlsli"\n#else\n#include <part.hlsli>\n#endif\n#include "part.hlsli"'
    count = Source(written(tmp_path, text)).text.split().count("part")
    assert count == times + 1
    assert Source(written(tmp_path, '#include "part.hlsli"\n' + text)).text.split().count("part") == (
        1 if part != "part" else times + 2
    )


def test_include_guard_is_not_a_branch(tmp_path):
    """Later files also see the includes of a guarded file, so a library is read once, not once per path."""
    for number in range(30):
        inner = f'#include "{number + 1}.hlsli"\n' * 2 if number < 29 else "part"
        guard = f"#ifndef G{number}\n#define G{number}\n{inner}\n#endif" if number % 2 else f"#pragma once\n{inner}"
        written(tmp_path, guard, f"{number}.hlsli")
    assert Source(written(tmp_path, '#include "0.hlsli"\n#include "7.hlsli"')).text.split().count("part") == 1


def test_a_list_of_macros_is_included_each_time_it_is_requested(tmp_path):
    written(tmp_path, "KIND(a)\nKIND(b)", "list.hlsli")
    text = '#define KIND(x) float x;\n#include "list.hlsli"\n#undef KIND\n#define KIND(x) x,\n#include "list.hlsli"\n'
    assert Source(written(tmp_path, text)).text.split().count("KIND(a)") == 2


@pytest.mark.parametrize(
    "name, why",
    [
        ("/etc/hostname", "is outside the folder of mine.hlsl"),
        ("../outside.hlsli", "is outside the folder of mine.hlsl"),
        ("link.hlsli", "is outside the folder of mine.hlsl"),
        ("Packages/Common.hlsl", "is not next to mine.hlsl"),
    ],
)
def test_files_elsewhere_are_not_read(tmp_path, name, why):
    """Such an include becomes an #error, which is harmless in an inactive branch."""
    written(tmp_path, "secret", "outside.hlsli")
    folder = tmp_path / "folder"
    (folder / ".git").mkdir(parents=True)
    (folder / "link.hlsli").symlink_to(tmp_path / "outside.hlsli")
    source = Source(written(folder, f'\n#include "{name}"'))
    assert source.text == "\n#error not read\n" and "secret" not in source.text
    assert source.explained(2, "#error :").startswith(f"{folder / 'mine.hlsl'}:2: {name} {why}")


def test_macro_is_not_accepted_as_an_included_file(tmp_path):
    """Some engines write file names without quotation marks."""
    written(tmp_path, "int part;", "part.hlsli")
    source = Source(written(tmp_path, "#define FILE <part.hlsli>\n#include FILE\n#include part.hlsli"))
    assert source.text == "#define FILE <part.hlsli>\n#error not read\nint part;\n"


def test_a_disguised_include_is_refused(tmp_path):
    with pytest.raises(UsageError, match="on one line"):
        Source(written(tmp_path, '#/**/include "a" "b"'))


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ('#inc\\\nlude "part.hlsli"\nx', ["int part;", "", "x"]),
        ("#line \\ \t\n#include \\\n", ["#line #include", "", ""]),
        ("// gone \\\ngone\nint x; \\", ["", "", "int x;"]),
    ],
)
def test_a_continued_line_is_read_as_one_line(tmp_path, text, lines):
    """As in compilers, spaces may follow the backslash; later lines keep their numbers."""
    written(tmp_path, "int part;", "part.hlsli")
    assert Source(written(tmp_path, text)).text.splitlines() == lines


def test_removing_comments_does_not_move_any_column():
    text = 'a /* b\nc */ d // e\n"// f" g'
    bare = without_comments(text)
    assert len(bare) == len(text) and bare == 'a     \n     d     \n"   f" g'


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("a /* b /* c */ d */ e", "a                   e"),
        ("a // b \\\nc", "a       \nc"),
        ("a // b\u2028c", "a      c"),
        ("/* // */ a", "         a"),
        ("// /*\na", "     \na"),
        ("a /* b /* */", "a /* b /* */"),
    ],
)
def test_wgsl_comments_follow_their_own_rules(text, left):
    """Comments can be nested, a backslash does not continue a line, and an unclosed comment stays."""
    assert bare(text, is_wgsl=True) == left


def test_an_unclosed_comment_is_reported(tmp_path):
    with pytest.raises(UsageError, match=r"mine\.hlsl:2: a comment that begins with /\* is not closed"):
        Source(written(tmp_path, "float x;\n/* never"))
