"""Users' encoders in WGSL: the catalogue's figures, by OpenGL and by wgpu, and one line for what is wrong."""

import json
import re

import numpy as np
import pytest
from languages import require_runner

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.shaders.languages.translated import translated
from normalbench.bench.subjects.codecs.names import codecs_named

MINE = """
alias Code = vec2f;
// The sphere, folded into a square.
fn wrap(p: Code) -> Code { return (1.0 - abs(p.yx)) * select(Code(-1), Code(1), p >= Code(0)); }
@must_use
fn EncodeNormal(n: vec3<f32>) -> Code {
    let p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if n.z < 0.0 { return wrap(p); }
    return p;
}
fn DecodeNormal(e: Code) -> vec3f {
    var n = vec3(e, 1 - abs(e.x) - abs(e.y));
    let t = saturate(-n.z);
    n.x += select(t, -t, n.x >= 0.0);
    n.y += select(t, -t, n.y >= 0.0);
    return normalize(n);
}
"""
QUICK = ("--storage", "rgb10a2", "--normals", "sphere", "--backend", "glsl", "--count", "65536", "--format", "json")
FIGURES = ("mse", "angle_mean_deg", "angle_max_deg")

pytestmark = pytest.mark.usefixtures("gl")


def written(folder, text, name="mine.wgsl"):
    (folder / name).write_text(text)
    return str(folder / name)


def test_an_encoder_in_wgsl_has_the_figures_of_the_catalogues(run, tmp_path):
    """The octahedral map in WGSL's words is the catalogue's, digit by digit where roots are rounded alike."""
    status, out, err = run("quality", "--encoding", f"{written(tmp_path, MINE)},octahedral", *QUICK)
    assert status == 0, err
    mine, ours = sorted(json.loads(out), key=lambda row: row["encoding"] == "octahedral")
    assert mine["encoding"] == "mine.wgsl"
    assert [mine[name] for name in FIGURES] == pytest.approx([ours[name] for name in FIGURES], rel=1e-6)


# Where an array stands, how it is declared, and how its two signs are read.
ARRAYS = {
    "vectors": ("module", "const A = array(vec2f(9.0, 1.0), vec2f(9.0, -1.0));", "A[{}].y"),
    "vectors of a type": ("module", "const A = array<vec2f, 2>(vec2f(9.0, 1.0), vec2f(9.0, -1.0));", "A[{}].y"),
    "a declared type": ("module", "const A: array<vec3f, 2> = array(vec3f(1.0), vec3f(-1.0));", "A[{}].zyx.x"),
    "mixed numbers": ("module", "const A = array(vec2(9, 1), vec2(9.5, -1));", "A[{}].y"),
    "a value": ("function", "let A = array(vec4f(1.0), vec4f(-1.0));", "A[{}].w"),
    "a variable": ("function", "var A = array(vec3f(), vec3f(-1.0)); A[0].y = 1.0;", "A[{}].y"),
    "a constant": ("function", "const A = array<vec2<f32>, 2u>(vec2f(1.0), vec2f(-1.0),);", "A[{}].x"),
    "matrices": ("module", "const A = array(mat2x2f(0, 1, 9, 9), mat2x2f(0, -1, 9, 9));", "A[{}][0].y"),
    "typed matrices": (
        "module",
        "const A = array<mat2x2f, 2>(mat2x2f(0, 1, 9, 9), mat2x2f(0, -1, 9, 9));",
        "A[{}][0][1]",
    ),
    "structures": (
        "module",
        "struct S { a: f32, b: vec2f }\nconst A = array(S(9, vec2f(1)), S(9, vec2f(-1)));",
        "A[{}].b.x",
    ),
    "whole numbers": ("module", "const A = array(vec2i(1, 9), vec2i(-1, 9));", "f32(A[{}].x)"),
    "no name": ("module", "", "array(vec2f(9.0, 1.0), vec2f(9.0, -1.0))[{}].y"),
}


def with_array(where, declared, read):
    """MINE, with its two signs in an array."""
    text = MINE
    for axis in "xy":
        text = text.replace(f"select(t, -t, n.{axis} >= 0.0)", "t * " + read.format(f"u32(n.{axis} >= 0.0)"))
    if where == "module":
        return f"{declared}\n{text}"
    return text.replace("-> vec3f {", f"-> vec3f {{ {declared}")


def test_an_array_in_wgsl_has_elements_of_any_type(run, tmp_path):
    """Wherever it stands, and with its type written or not: the figures of the octahedral map."""
    files = [written(tmp_path, with_array(*how), f"{name}.wgsl") for name, how in ARRAYS.items()]
    status, out, err = run("quality", "--encoding", ",".join([*files, "octahedral"]), *QUICK)
    rows = json.loads(out)
    assert (status, len(rows)) == (0, len(files) + 1), err
    ours = next(row for row in rows if row["encoding"] == "octahedral")
    for row in rows:
        assert [row[name] for name in FIGURES] == pytest.approx([ours[name] for name in FIGURES], rel=1e-6), row


@pytest.mark.parametrize(
    "array, said",
    [
        ("array(vec2f(1), 1.0)", "an array of float, vec2; its elements have one type"),
        ("array()", "an array of nothing; its elements have one type"),
        ("array<vec2f, 3>(vec2f(1), vec2f(1))", "2 values of an array of 3"),
        ("array(array(1.0, 2.0), array(1.0, 2.0))", "an array of arrays is not read"),
        ("array<array<f32, 2>, 2>()", "an array of arrays is not read"),
    ],
)
def test_an_array_that_is_not_read_says_why(array, said, tmp_path):
    with pytest.raises(UsageError, match=said):
        translated(written(tmp_path, with_array("module", f"const A = {array};", "A[{}].y")))


@pytest.mark.parametrize("language", ["wgsl", "hlsl", "c"])
def test_an_encoder_in_wgsl_can_be_written_in_every_language(language, tmp_path):
    """Its own WGSL by wgpu gives the texels that its translation gives by OpenGL: two translations that agree."""
    require_runner(language)
    (codec,) = codecs_named(written(tmp_path, MINE), "rgb10a2", "nearest")
    code = code_of(codec, language, "p")
    (tmp_path / code.name).write_text(code.body)
    found = agreement(codec, language, tmp_path / code.name, code.interface)
    assert found.holds and not found.differing, found.says


def test_the_users_own_text_by_wgpu_gives_the_codes_of_its_translation(tmp_path):
    """The text as it was typed, compiled by naga: the functions of a codec's code call it."""
    require_runner("wgsl")
    (codec,) = codecs_named(written(tmp_path, MINE), "rgb10a2", "nearest")
    code = code_of(codec, "wgsl", "p")
    mine = re.sub(
        r"fn p_encode\(.*?\n}\n", "fn p_encode(n: vec3f) -> vec2f { return EncodeNormal(n); }\n", code.body, flags=re.S
    )
    mine = re.sub(
        r"fn p_decode\(.*?\n}\n", "fn p_decode(e: vec2f) -> vec3f { return DecodeNormal(e); }\n", mine, flags=re.S
    )
    assert mine.count("EncodeNormal") == 1 and mine.count("DecodeNormal") == 1
    (tmp_path / code.name).write_text(MINE + mine)
    found = agreement(codec, "wgsl", tmp_path / code.name, code.interface)
    assert found.holds and not found.differing, found.says


WRONG = {
    "syntax": ("fn EncodeNormal(n: vec3f) -> vec2f { return n.xy", r"\.wgsl:\d+:\d+: .* expected"),
    "unknown": (MINE.replace("wrap(p); }", "warp(p); }"), r"\.wgsl:8:27: warp is not a function"),
    "missing": (
        MINE.replace("fn DecodeNormal", "fn other").replace("vec3f {", "f32 {").replace("(n);", "(n).x;"),
        "no decoder",
    ),
    "kind": (
        MINE.replace("let t =", "let k: i32 = 2; let t = k *"),
        r"\.wgsl:13:\d+: (int|float) where (int|float) is expected",
    ),
    "binding": (
        "@group(0) @binding(0) var<uniform> t: f32;" + MINE.replace("return p;", "return p * t;"),
        r"\.wgsl:1:\d+: t is set from outside",
    ),
    "endless": (MINE.replace("let p =", "loop { } let p ="), "do not end|did not end|killed|must|declaration"),
    "nan": (MINE.replace("return p;", "return p * sqrt(-1.0 - n.z * n.z);"), "no number"),
    "deep": (MINE.replace("return p;", f"return {'(' * 3000}p{')' * 3000};"), "nested more than"),
    "empty": ("", "no encoder"),
    "junk": ("\x00\x01\x02" * 99, "begins nothing known"),
    "large": ("// " + "x" * 17_000_000 + "\n" + MINE, "larger than"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_one_line_and_status_2(run, tmp_path, name):
    """The user's file is named, with line and column where they are known."""
    text, said = WRONG[name]
    status, out, err = run("quality", "--encoding", written(tmp_path, text), *QUICK)
    assert (status, out) == (2, "") and err.count("\n") == 1, err
    assert "mine.wgsl" in err and re.search(said, err), err


def test_a_wrong_file_loses_its_own_rows_alone(run, tmp_path):
    """The other's row is there, and the status is 0."""
    wrong = written(tmp_path, WRONG["syntax"][0], "wrong.wgsl")
    status, out, err = run("quality", "--encoding", f"{wrong},{written(tmp_path, MINE)}", *QUICK)
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["mine.wgsl"]
    assert err.count("left out: ") == 1 and np.isfinite(json.loads(out)[0]["mse"])


def test_a_variable_without_a_value_is_zero(tmp_path):
    """GLSL leaves it undefined, so that each is written with its zero: of numbers, vectors, arrays and structures."""
    (tmp_path / "mine.wgsl").write_text(
        "struct S { a: f32, b: vec2f }\n"
        "fn encode_normal(n: vec3f) -> vec2f { var s: S; var f: f32; var l: array<f32, 2>; var v: vec2f;\n"
        "    v.x = n.x; return v + s.b + vec2f(f + l[1] + s.a, n.y); }\n"
        "fn decode_normal(e: vec2f) -> vec3f { return vec3f(e, sqrt(max(1.0 - dot(e, e), 0.0))); }\n"
    )
    text = translated(tmp_path / "mine.wgsl").texts[0]
    # A structure's fields stand before the function.
    body = re.search(r"^vec2 user_mine_wgsl_e_wgsl_\d+\(.*?^}", text, re.S | re.M)
    assert body and len(re.findall(r"^    [^=;\n.]+ = [^;]*\b0\.0\b[^;]*;", body[0], re.M)) == 4, text
