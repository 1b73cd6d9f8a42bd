"""Users' encoders in WGSL: the catalogue's figures with OpenGL and with wgpu, and one-line errors."""

import json
import re

import pytest
from languages import require_runner
from test_wgsl import FIGURES, MINE, QUICK, written
from typed import codecs_named, translated

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement

pytestmark = pytest.mark.usefixtures("gl")


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
    """Return MINE with its two signs in an array."""
    text = MINE
    for axis in "xy":
        text = text.replace(f"select(t, -t, n.{axis} >= 0.0)", "t * " + read.format(f"u32(n.{axis} >= 0.0)"))
    if where == "module":
        return f"{declared}\n{text}"
    return text.replace("-> vec3f {", f"-> vec3f {{ {declared}")


def test_an_array_in_wgsl_has_elements_of_any_type(run, tmp_path, names=("typed matrices", "structures", "no name")):
    """An array gives the octahedral figures wherever it is declared, with or without an explicit type."""
    files = [written(tmp_path, with_array(*ARRAYS[name]), f"{name}.wgsl") for name in names]
    status, out, err = run("quality", "--encoding", ",".join([*files, "octahedral"]), *QUICK)
    rows = json.loads(out)
    assert (status, len(rows)) == (0, len(files) + 1), err
    ours = next(row for row in rows if row["encoding"] == "octahedral")
    for row in rows:
        assert [row[name] for name in FIGURES] == pytest.approx([ours[name] for name in FIGURES], rel=1e-6), row


@pytest.mark.parametrize(
    "array, said",
    [
        ("array(vec2f(1), 1.0)", "array elements must have the same type, not float, vec2"),
        ("array()", "array elements must have the same type, not none"),
        ("array<vec2f, 3>(vec2f(1), vec2f(1))", "an array of 3 elements has 2 values"),
        ("array(array(1.0, 2.0), array(1.0, 2.0))", "arrays of arrays are not supported"),
        ("array<array<f32, 2>, 2>()", "arrays of arrays are not supported"),
    ],
)
def test_an_unsupported_array_is_reported_with_a_reason(array, said, tmp_path):
    with pytest.raises(UsageError, match=said):
        translated(written(tmp_path, with_array("module", f"const A = {array};", "A[{}].y")))


@pytest.mark.parametrize("language", ["wgsl", "hlsl", "c"])
def test_an_encoder_in_wgsl_can_be_written_in_every_language(language, tmp_path):
    """The written code gives the same texels as the OpenGL translation in each language."""
    require_runner(language)
    (codec,) = codecs_named(written(tmp_path, MINE), "rgb10a2", "nearest")
    code = code_of(codec, language, "p")
    (tmp_path / code.name).write_text(code.body)
    verdict = agreement(codec, language, tmp_path / code.name, code.interface)
    assert verdict.holds and not verdict.differing, verdict.says


def test_a_variable_without_a_value_is_zero(tmp_path):
    """GLSL leaves such variables undefined, so numbers, vectors, arrays and structures are written with zeros."""
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
