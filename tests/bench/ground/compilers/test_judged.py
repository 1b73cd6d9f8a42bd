"""The texts that compilers may be given."""

import re
import time

import pytest

from normalbench.bench.ground.compilers import slang
from normalbench.bench.ground.compilers import text as texts
from normalbench.bench.ground.compilers.lines import bare, joined, with_known_directives, without_comments
from normalbench.bench.ground.compilers.text import RefusedError, judged, own
from normalbench.encodings.catalogue import ENCODINGS

REFUSED = {
    "a line that goes on": ("float x; \\\nfloat y;", 1),
    "a line that goes on behind spaces": ("float x;\nfloat y; \\ \t\nz", 2),
    "a \\ at the end": ("float x;\n\\", 2),
    "a comment": ("float x;\n// no", 2),
    "a comment that is closed": ("float x; /* no */", 1),
    "an include": ('\n#include "a"', 2),
    "an include of a macro": ("#define A <a>\n#include A", 2),
    "an import": ("#import <a>", 1),
    "a file as bytes": ('#embed "a"', 1),
    "the number of a line": ("#line 5", 1),
    "a pragma": ("#pragma once", 1),
    "a directive without a name": ("# ", 1),
    "a directive behind a letter that is no space": ('\f#include "a"', 1),
    "a # in a line": ('x # include "a"', 1),
    "another # in a directive": ("#if 1 # include", 1),
    "a digraph": ('%:include "a"', 1),
    "a trigraph": ('??=include "a"', 1),
    "a line that other systems end": ('x\u2028#include "a"', 1),
    "a carriage return": ("x\r#include", 1),
    "a zero": ("x\0", 1),
}


@pytest.mark.parametrize("language", [name for name in texts.RULES if name != "wgsl"])
@pytest.mark.parametrize("name", REFUSED)
def test_ambiguous_preprocessor_input_is_refused_with_its_line(name, language):
    text, line = REFUSED[name]
    with pytest.raises(RefusedError) as refused:
        judged(text, language, lambda plain: plain.content)
    assert refused.value.line == line, refused.value


def test_macros_conditionals_and_messages_are_kept():
    text = (
        "#define A(x) x\n#if A(1) == 1 && !defined(B)\n# error no\n#elif 0\n\t#\twarning w\n#else\n#endif\n#undef A\n"
    )
    assert judged(text, "slang").content == text


WORDS = ["import", "__include", "implementing", "__target_switch", "__intrinsic_asm", "spirv_asm", "__requirePrelude"]
WORDS += ["spirv_instruction", "ext_instruction"]


@pytest.mark.parametrize("word", [*WORDS, "__anything", "DllImport", "syntax"])
def test_words_that_read_or_write_other_text_are_refused(word):
    with pytest.raises(RefusedError, match=f"line 2: {word} is not supported"):
        judged(f"float x;\n{word} y;", "slang")


def test_a_refused_word_is_also_refused_if_macros_join_it():
    """The preprocessor's output decides; without it, joining words is refused."""
    text = "float x;\n#define P(a, b) a##b\nP(im, port) y;"
    with pytest.raises(RefusedError, match="line 2: import is not supported"):
        judged(text, "slang", lambda _: "float x ; import y ;")
    assert judged(text, "slang", lambda _: "float x ; importer y ;").content == text
    with pytest.raises(RefusedError, match="line 2: a ## macro that joins words"):
        judged(text, "slang")


def test_users_names_may_begin_with_two_underscores():
    """Words that the compiler knows are still refused."""
    assert judged("float __OctWrap(float __x) { return __x; }", "slang", knows={"__include"}.__contains__)
    with pytest.raises(RefusedError, match="line 1: __include is not supported"):
        judged("float __x; __include y;", "slang", knows={"__include"}.__contains__)


@pytest.mark.usefixtures("slang")
def test_slangs_compiler_knows_the_words_that_are_refused():
    """The compiler does not know a made-up name."""
    for word in (*texts.OTHER_FILES, *WORDS, *texts.RULES["slang"].refused):
        assert not word.startswith("__") or slang.knows(word), word
    assert not slang.knows("__OctWrap") and not slang.knows("__unused")


def test_compiler_words_in_generics_are_accepted():
    assert judged("T f<T : __BuiltinFloatingPointType>(T x) { return x; }", "slang")


@pytest.mark.parametrize(
    "text",
    [
        'asm("x");',
        "__asm__(x);",
        "int x = __builtin_trap();",
        'char *x = "a";',
        "int x = 'a';",
        "_Pragma(x)",
        "\\u005f",
        "[[gnu::constructor]] void f();",
        "[ [noreturn]] void f();",
        "#if __has_include(<math.h>)\n#endif",
    ],
)
@pytest.mark.parametrize("language", ["c", "cuda"])
def test_native_code_may_not_contain_strings_or_compiler_extensions(text, language):
    with pytest.raises(RefusedError):
        judged(text, language)


@pytest.mark.parametrize("head", ["#include <math.h>", '#include "code.h"', "#pragma STDC FP_CONTRACT OFF"])
def test_a_listed_head_is_accepted_only_in_its_own_language(head):
    assert judged(head, "c")
    for language in set(texts.RULES) - {"c"}:
        with pytest.raises(RefusedError):
            judged(head, language)


@pytest.mark.parametrize(
    "head", ['#include "stdlib.h"', "#include <stdio.h>", '#include "../code.h"', '#include "/etc/passwd"', "#pragma x"]
)
def test_other_heads_are_refused(head):
    for language in texts.RULES:
        with pytest.raises(RefusedError):
            judged(head, language)


def test_wgsl_has_no_directives():
    with pytest.raises(RefusedError, match="# is not supported"):
        judged("#define A 1", "wgsl")


def test_only_files_of_normalbench_count_as_its_own(tmp_path):
    (tmp_path / "mine.c").write_text("int x;")
    with pytest.raises(ValueError, match=r"mine\.c is not a file of normalbench"):
        own(tmp_path / "mine.c")
    file = ENCODINGS["octahedral"].glsl
    with pytest.raises(ValueError, match="is neither a number nor a name"):
        own(file, A='1\n#include "x"')
    source = own(file, A=1)
    assert source.is_own and source.content == f"#define A 1\n{file.read_text()}"
    assert not (source + judged("x", "c")).is_own


@pytest.mark.parametrize("text", ["/* " * 10**6, "\\ " * 10**6, "\\\n" * 10**6, "# " * 10**6, "#\n" * 10**5])
def test_judging_takes_linear_time(text):
    began = time.process_time()
    for language in ("slang", "c"):
        with pytest.raises(RefusedError):
            judged(text, language)
    with_known_directives(without_comments(joined(text)))
    assert time.process_time() - began < 4, f"{time.process_time() - began:.1f} s"


def test_a_string_does_not_hide_a_comment():
    """Comment marks in a string are removed as well."""
    assert bare('string a = "http://x /* y */"; // z') == 'string a = "http:  x    y   ";     '
    assert judged(bare('#define Q "\n//" x\n'), "slang").content == '#define Q "\n' + " " * 5 + "\n"


def test_each_line_keeps_its_number():
    text = "a \\\nb // c \\\nd\n/* e\n*/ f\n#line 3\n#foo x\ng"
    cleaned = with_known_directives(without_comments(joined(text)))
    assert [re.sub(" +", " ", line).strip() for line in cleaned.split("\n")] == [
        *("a b", "", "", "", "f", "", "#error #foo is not supported", "g")
    ]
