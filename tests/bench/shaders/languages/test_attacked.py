"""Forbidden actions of a file, and obstacles to finding a pair, collected from attempted attacks."""

import itertools
import re

import pytest
from typed import translated

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import child
from normalbench.bench.shaders.languages.items import heads, items

pytestmark = pytest.mark.usefixtures("slang", "in_this_process")
ENCODE = "float2 PackDir(float3 n) { return CODE; }\n"
DECODE = "float3 UnpackDir(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
WGSL = "fn f_encode(n: vec3f) -> vec2f { return n.xy * two(); }\n"
WGSL += "fn f_decode(e: vec2f) -> vec3f { return vec3f(e, 0.0); }\n"
UNREAD = r"mine\.\w+:\d+(:\d+)?: .*(\w+ is not (?:read|supported)|other.slang is outside the folder)"
PLAIN = ENCODE.replace("CODE", "n.xy") + DECODE


@pytest.mark.parametrize("ending", ["hlsl", "slang", "frag"])
@pytest.mark.parametrize(
    "text",
    [
        'float f(float a) { __target_switch { case cpp: __intrinsic_asm "exit(1)"; case glsl: return a; } }\n',
        '__target_intrinsic(cpp, "exit(1)") float f(float a);\n',
        '#define P(a, b) a##b\nfloat f(float a) { P(__intrin, sic_asm) "exit(1)"; }\n',
        '__intrin\\\nsic_asm "exit(1)";\n',
        'import "../other.slang";\n',
        '#define I import\nI "../other.slang";\n',
        'imp\\\nort "../other.slang";\n',
        '#define J(x) x "../other.slang"\nJ(import);\n',
        '#define P(a, b) a##b\nP(imp, ort) "../other.slang";\n',
    ],
)
def test_a_file_cannot_write_a_program_or_read_another_file(tmp_path, text, ending):
    """Slang keywords can put a string into the C++ that is run, or read a module. However they are written, code that
    needs them is refused, and other code is measured as if they were absent."""
    (tmp_path / "other.slang").write_text("float f(float a) { return 1.0; }\n")
    path = tmp_path / "own" / f"mine.{ending}"
    (path.parent / ".git").mkdir(parents=True)
    path.write_text(PLAIN)
    plain = translated(path).texts
    path.write_text(text + PLAIN)
    try:
        assert translated(path).texts == plain
    except UsageError as error:
        assert re.search(UNREAD, str(error)), error
    if "f(" in text or "other" in text:
        path.write_text(text + ENCODE.replace("CODE", "n.xy * f(1.0)") + DECODE)
        with pytest.raises(UsageError, match=UNREAD):
            translated(path)


# What hides an include from whoever looks at lines one by one. JOIN is a line's end that is none.
DISGUISES = [
    '#line JOIN#incJOINlude "NOTE"',
    '#pragma JOIN#incJOINlude "NOTE"',
    '#version JOIN#include "NOTE"',
    '#extension JOIN#include "NOTE"',
    '#line JOIN#pragma JOIN#include "NOTE"',
    '#line 1 JOIN/* JOIN*/ #includeJOIN "NOTE"',
    '#line JOIN  #  include JOIN"NOTE"',
    '#define include include\n#include "NOTE"',
    '#define I include\n#I "NOTE"\n# I "NOTE"',
    '#define H "NOTE"\n#include H',
    '%:include "NOTE"',
    '??=include "NOTE"',
    '// JOIN\n#line JOIN#include "NOTE"',
    '/JOIN/ JOIN\n/JOIN* JOIN*JOIN/ #incJOINlude "NOTE"',
    '#embed "NOTE"',
    '#import "NOTE"',
    '#include_next "NOTE"',
]
JOINS = {"plain": "\\\n", "crlf": "\\\r\n", "spaces": "\\ \t\n", "feed": "\\\f\n", "twice": "\\\n\\\n"}


WAYS = [*itertools.product(["hlsl", "slang", "frag", "wgsl"], ["file", "include", "prelude"])]
# Slang and frag have the rules of HLSL, and the file itself is judged as what it includes: these have every join.
JOINED = [("hlsl", "file"), ("wgsl", "file")]


@pytest.mark.parametrize("ending, by, joins", [(*way, [*JOINS] if way in JOINED else ["plain"]) for way in WAYS])
def test_a_disguised_include_cannot_read_a_file_elsewhere(tmp_path, ending, by, joins):
    """The encoder calls a function of a forbidden file, so it compiles only if that file was read."""
    folders = [tmp_path / name for name in ("elsewhere", "own", "work")]
    for folder in folders:
        folder.mkdir()
    note, path, part = folders[0] / "note.txt", folders[1] / f"mine.{ending}", folders[1] / f"part.{ending}"
    note.write_text("fn two() -> f32 { return 2.0; }" if ending == "wgsl" else "float two() { return 2.0; }\n")
    code = WGSL if ending == "wgsl" else ENCODE.replace("CODE", "n.xy * two()") + DECODE
    word = f"{path}:prelude={part}" if by == "prelude" else path
    for text, join in itertools.product(DISGUISES, [JOINS[name] for name in joins]):
        attack = text.replace("NOTE", str(note)).replace("JOIN", join) + "\n"
        path.write_text({"file": attack, "include": f'#include "{part.name}"\n', "prelude": ""}[by] + code)
        part.write_text(attack)
        answer = child.answer(UserFile(str(word)), folders[2])
        assert answer.get("error", "").startswith(str(folders[1])), (attack, answer)


def test_a_refusal_gives_the_line_whatever_branches_precede_it(tmp_path):
    path = tmp_path / "mine.hlsl"
    needs = ENCODE.replace("CODE", "n.xy * f(1.0)") + DECODE
    path.write_text("#ifdef A\n#else\n#endif\n#if B\n#endif\nimport x;\n" + needs)
    with pytest.raises(UsageError, match=r"mine\.hlsl:6:1: import is not supported; #include a file next to it"):
        translated(path)
    path.write_text("#ifdef A\n#else\n#endif\n#define B a # b\n#if C # 1\n#endif\n" + PLAIN)
    with pytest.raises(UsageError, match=r"mine\.hlsl:5: a # inside a line is not supported"):
        translated(path)


@pytest.mark.parametrize(
    "text",
    [
        "float __OctWrap(float x) { return x; }\nstruct __VSOut { float __unused; };\n",
        "#ifdef __cplusplus\n#if __has_include(<cmath>)\n#include <cmath>\n#endif\n#endif\n",
        "#if defined(__cplusplus) && defined(__has_feature)\n#endif\n",
        'string Url = "http://a.b/c"; /* "never */ // closed \\\n behind it\n',
        "#define PASTED(a, b) a##b\nfloat PASTED(hel, per)(float i, float m, float p, float o) { return i; }\n",
        "#pragma once\n#line 3\n#define LONG(x) \\\n    (x)\n\f#define FEED\n",
    ],
)
def test_harmless_constructs_are_read(tmp_path, text):
    path = tmp_path / "mine.hlsl"
    path.write_text(text + PLAIN)
    assert translated(path).named == "PackDir:UnpackDir"


@pytest.mark.parametrize("ending", ["hlsl", "slang", "frag"])
@pytest.mark.parametrize(
    "value", ["\\", "1 \\ ", "//", "/*", '#include "NOTE"', '%:include "NOTE"', "import", "__include"]
)
def test_a_macro_on_the_command_line_is_checked_like_a_line_of_the_file(tmp_path, ending, value):
    """A value in `-D A=VALUE` can neither hide the next line nor read a file."""
    (tmp_path / "note.txt").write_text("float two() { return 2.0; }\n")
    path = tmp_path / f"mine.{ending}"
    path.write_text("A\n" + ENCODE.replace("CODE", "n.xy * two()") + DECODE)
    word = f"{path}:define=A={value.replace('NOTE', str(tmp_path / 'note.txt'))}"
    (tmp_path / "work").mkdir()
    assert child.answer(UserFile(str(word)), tmp_path / "work").get("error", "")


@pytest.mark.parametrize(
    "value", ['0.3+\n#include "/etc/hostname"\n', "{0.5}", "0/0", "gone", "n + 1", '"x"', "system(1)", "wired_n_given"]
)
def test_a_wiring_may_contain_only_numbers_and_names(tmp_path, value):
    path = tmp_path / "mine.hlsl"
    path.write_text(
        "float4 PackDir(float3 n, float r) { return float4(n, r); }\nfloat3 UnpackDir(float4 t) { return t.xyz; }\n"
    )
    with pytest.raises(UsageError):
        translated(f"{path}:PackDir(n=n; r={value})->xyz:UnpackDir(t.xyz=e)")


def test_error_names_an_input_that_a_side_does_not_have(tmp_path):
    path = tmp_path / "mine.hlsl"
    path.write_text(
        "float4 PackDir(float3 n, float r) { return float4(n, r); }\nfloat3 UnpackDir(float4 t) { return t.xyz; }\n"
    )
    with pytest.raises(UsageError, match="n is not available here; use e"):
        translated(f"{path}:PackDir(n=n)->xyz:UnpackDir(t=n)")


@pytest.mark.parametrize(
    "text",
    [
        "#define SIGN float2 sign(float2 v) { return v * 2.0; }\nSIGN\nfloat unused(Gone a) { return 0; }\n",
        "#define CALL(x) Helper##x\nfloat HelperOf(float x) { return sign(float2(x, x)).x; }\n"
        "float2 sign(float2 v) { return v * 2.0; }\n",
        'string Widget = "slider{";\nfloat2 sign(float2 v) { return v * 2.0; }\n',
    ],
)
def test_code_that_a_pair_needs_is_kept(tmp_path, text):
    """Examples are a macro's definition before a removed function, names made by token pasting and quoted braces."""
    path = tmp_path / "mine.hlsl"
    code = "float2(CALL(Of)(n.x), sign(n.xy).y)" if "CALL" in text else "sign(n.xy)"
    path.write_text(text + ENCODE.replace("CODE", code) + DECODE)
    assert "* 2.0" in translated(path).texts[0]


def test_invalid_global_is_the_reported_error(tmp_path):
    """The error is not reported at the function that uses the global."""
    path = tmp_path / "mine.hlsl"
    path.write_text("static const float H = Something(3);\n" + ENCODE.replace("CODE", "n.xy * H") + DECODE)
    with pytest.raises(UsageError, match=r"mine\.hlsl:1:\d+: undefined identifier 'Something'"):
        translated(path)


def test_a_macro_before_a_function_is_a_separate_item():
    text = "DEFINED\n[numthreads(1, 1, 1)]\nvoid main(uint3 id) { }\n"
    text += "float3\nf(float3 n) { return n; }\nSIGN(x)\nfloat g() { }\n"
    assert [item.function for item in items(text)] == ["main", "f", "", "g", ""]
    assert heads(text).count(";") == 3


def test_a_files_own_packer_takes_precedence_over_an_included_helper(tmp_path):
    """Unity's HDRP is such a case. In a single file, a note names the packer."""
    helper = PLAIN.replace("CODE", "n.xy")
    packer = (
        "struct Data { float3 normalWS; float roughness; };\n"
        "void EncodeIntoBuffer(Data d, out float4 o) { o = float4(PackDir(d.normalWS), d.normalWS.z, d.roughness); }\n"
        "void DecodeFromBuffer(float4 b, out Data d) { d.normalWS = float3(b.xy, b.z); d.roughness = b.w; }\n"
    )
    (tmp_path / "helper.hlsl").write_text(helper)
    (tmp_path / "mine.hlsl").write_text('#include "helper.hlsl"\n' + packer)
    (tmp_path / "both.hlsl").write_text(helper + packer)
    with pytest.raises(UsageError, match=r"EncodeIntoBuffer\(d.normalWS=n; d.roughness=0.5\)->o.xy:"):
        translated(tmp_path / "mine.hlsl")
    translation = translated(tmp_path / "both.hlsl")
    assert translation.named == "PackDir:UnpackDir"
    assert "EncodeIntoBuffer:DecodeFromBuffer is measured only if named" in translation.notes
