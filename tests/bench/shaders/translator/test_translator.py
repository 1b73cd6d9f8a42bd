"""Programs read as syntax trees and written in every language, with their meaning, comments and positions."""

import re
import sys

import pytest

from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.files import commented
from normalbench.bench.shaders.isa.nvidia.cuda_writer import CudaWriter
from normalbench.bench.shaders.translator.c_writer import CWriter
from normalbench.bench.shaders.translator.glsl_parser import read_glsl
from normalbench.bench.shaders.translator.glsl_writer import GlslWriter
from normalbench.bench.shaders.translator.hlsl_writer import HlslWriter
from normalbench.bench.shaders.translator.msl_writer import MslWriter
from normalbench.bench.shaders.translator.reduce import reduced
from normalbench.bench.shaders.translator.tokens import in_a_comment
from normalbench.bench.shaders.translator.tree import TranslationError, one_error_type
from normalbench.bench.shaders.translator.wgsl_parser import read_wgsl
from normalbench.bench.shaders.translator.wgsl_writer import WgslWriter

SOURCE = """
#define STEPS 3
#define SCALES float[2](0.5, 2.0)
#define CODE vec2
float unit(float v) { return v < 0.0 ? -1.0 : 1.0; }

vec2 unit(vec2 v) { return vec2(unit(v.x), unit(v.y)); }
float unused(float x) { return x; }
// Above the function.
CODE mine_encode(vec3 n, vec3 view) {
    const float scales[] = SCALES;
    float sum = 0.0;  // behind it
    for (int i = 0; i < STEPS - 1; ++i) sum += scales[i] * float(i << 1 & 3);
    return n.xy * (1.0 / (sum + n.z)) - unit(n.xy);
}
vec3 mine_decode(CODE e, vec3 view) {
#if STEPS
    return vec3(e, clamp(e.x, 0.0, 1.0));
#else
    return e;
#endif
}
"""


ROOTS = {"mine_encode": "encode", "mine_decode": "decode"}


def written(writer, source=SOURCE):
    return writer("p", {}).program(reduced(read_glsl(source), ROOTS, "p", "mine"))


def test_a_program_keeps_only_the_functions_its_roots_need_under_one_prefix():
    """Overloads get distinct names; an unused view and uncalled functions are removed."""
    text = written(GlslWriter)
    assert re.findall(r"^\w+ (\w+)\(", text, re.MULTILINE) == ["p_unit1", "p_unit2", "p_encode", "p_decode"]
    assert "view" not in text and "unused" not in text


@pytest.mark.parametrize(
    "text", ["a\nb", "a\r\nb", "a\u2028b", "a\x85b", "a\fb", "a \\", "a ??/ ", "  a\nb", "a\\ " * 90]
)
def test_no_comment_ends_or_continues_where_it_should_not(text):
    """This holds in every language, whatever text a name or a title has."""
    line = in_a_comment(text)
    assert line.isprintable() and not line.endswith(("\\", "/"))
    for language in LANGUAGES:
        lines = commented("body", language, "guard", [text]).splitlines()
        assert all(comment.startswith("//") for comment in lines[: lines.index("")]), lines


def test_comments_keep_their_positions():
    """The output has the source's comments above a function and after a statement."""
    text = written(GlslWriter)
    assert "// Above the function.\nvec2 p_encode(vec3 n)" in text
    assert "float sum = 0.0;  // behind it" in text


@pytest.mark.parametrize(
    ("writer", "expected"),
    [
        (GlslWriter, "p_SCALES[i] * float((i << 1) & 3)"),
        (HlslWriter, "static const float P_SCALES[2] = {0.5, 2.0};"),
        (MslWriter, "inline float2 p_encode(float3 n)"),
        (WgslWriter, "sum += P_SCALES[i] * f32((i << 1u) & 3);"),
        (CWriter, "return v < 0.0f ? -1.0f : 1.0f;"),
    ],
)
def test_each_language_uses_its_own_syntax(writer, expected):
    """One line is typical of each language."""
    assert expected.lower() in written(writer).lower()


def test_wgsl_uses_select_and_declares_assigned_names_as_var():
    """`?:` becomes `select` with swapped arguments, and assigned names become `var`."""
    text = written(WgslWriter)
    assert "return select(1.0, -1.0, v < 0.0);" in text
    assert "var sum = 0.0;" in text
    assert "for (var i = 0; i < P_STEPS - 1; i++) {" in text


def test_c_computes_a_scalar_factor_of_a_vector_once():
    """A vector times a quotient divides once."""
    text = written(CWriter)
    assert text.count("/") - text.count("//") * 2 == 1, text
    assert "const float t1 = 1.0f / (sum + n.z);" in text


def test_a_matrix_of_columns_is_its_transpose_in_hlsl():
    """HLSL builds matrices of rows: n * M becomes mul(M, n), which gives the same dot products."""
    source = "vec3 mine_encode(vec3 n) { mat3 m = mat3(n, n, n); return n * m + m * n; }"
    text = written(HlslWriter, source + "vec3 mine_decode(vec3 e) { return e; }")
    assert "return mul(m, n) + mul(n, m);" in text


def test_names_that_a_language_reserves_get_an_underscore():
    """`line` is reserved in HLSL, but not in GLSL."""
    source = "vec2 mine_encode(vec3 n) { float line = n.x; return vec2(line); }"
    source += "vec3 mine_decode(vec2 e) { return vec3(e, 0.0); }"
    assert "float line_ = n.x;" in written(HlslWriter, source)
    assert "float line = n.x;" in written(GlslWriter, source)


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("float f(float x) {\n  return y;\n}", r"^2:10: unknown name y$"),
        ("float f(float x) { return frob(x); }", r"^1:27: unknown function frob"),
        ("float f(vec2 x) { return x.z; }", r"^1:28: vec2 has no member z$"),
        ("vec3 f(vec2 x, vec3 y) { return x + y; }", r"vec2 and vec3 cannot be combined"),
        ("float f(float x) { return " + "(" * 99 + "x" + ")" * 99 + "; }", r"nested more than 60 levels deep"),
        ("#define F(x) x\nfloat f() { return 1.0; }", r"^1:1: macros with arguments"),
        ("#if A\n", r"A is not a whole number"),
        ("#define A\n#if A\n", r"A is not a whole number"),
        ("#define A B\n#if A\n", r"A is not a whole number"),
        ("#ifdef A\n", r"#if without #endif"),
        ("#define A B\n#define B A\nfloat f() { return A; }", r"A is defined as itself|B is defined as itself"),
        ("float f(float x) { return x $ 1; }", r"^1:29: unexpected character '\$'$"),
        ("struct S { float x[2]; };", r"^1:19: arrays in structures are not supported"),
        ("struct S { float x; }; S f(S a[2]) { return a[0]; }", r"^1:34: arrays of structures are not supported"),
        ("struct S { float x; }; float f(S a) { return a.y; }", r"^1:48: S has no member y"),
        ("struct S { float x; }; S f() { return S(1.0, 2.0); }", r"S has 1 fields, not 2"),
        ("struct S { float x; }; bool f(S a, S b) { return a == b; }", r"compare structures field by field"),
        ("float f(", r"expected a name"),
        ("", ""),
    ],
)
def test_unreadable_glsl_error_has_line_and_column(source, said):
    """The error is one line; an empty file is an empty program."""
    if not said:
        assert read_glsl(source).functions == []
        return
    with pytest.raises(TranslationError, match=said) as error:
        read_glsl(source)
    assert "\n" not in str(error.value)


def test_a_power_too_large_for_a_float_stays_a_call():
    """For literal numbers 2^x becomes a number only if a float can hold it."""
    text = written(GlslWriter, SOURCE.replace("n.xy * (", "vec2(exp2(2000.0), exp2(3.0)) * ("))
    assert "vec2(exp2(2000.0), 8.0)" in text


WGSL = """
alias Code = vec2<f32>;
const K = array<f32, 2>(1.0, 2.0);
fn mineEncode(n: vec3f) -> Code { return helper(n.xy, select(1.0, -1.0, n.z < 0.0)); }
fn helper(p: vec2f, s: f32) -> Code {
    var sum = vec2(0.0, 0.0);
    for (var i = 0u; i < 2u; i++) { sum += p * K[i] * s; }
    if sum.x > 1.0 { return saturate(sum); } else if (sum.y > 1) { return sum % 2.0; }
    return bitcast<vec2f>(bitcast<vec2u>(sum) | vec2u(1u));
}
fn mineDecode(e: Code) -> vec3<f32> { let z = inverseSqrt(dot(e, e)); return vec3f(e, z); }
"""


def test_wgsl_is_translated_to_glsl():
    """The WGSL has functions used before their definition, splats, select, saturate, bitcast and % of floats."""
    text = GlslWriter("p", {}).program(
        reduced(read_wgsl(WGSL), {"mineEncode": "encode", "mineDecode": "decode"}, "p", "mine")
    )
    assert text.index("vec2 p_helper") < text.index("vec2 p_encode")
    assert "return p_helper(n.xy, n.z < 0.0 ? -1.0 : 1.0);" in text
    assert "return clamp(sum, 0.0, 1.0);" in text
    assert "return sum - 2.0 * trunc(sum / 2.0);" in text
    assert "return uintBitsToFloat(floatBitsToUint(sum) | uvec2(1u));" in text
    assert "float z = inversesqrt(dot(e, e));" in text


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("fn f(x: f32) -> f32 { return y; }", "1:30: unknown name y"),
        ("@group(0) @binding(0) var<uniform> t: f32; fn f() -> f32 { return t; }", "1:23: t is set from outside"),
        ("fn g(p: ptr<function, f32>) {} fn f(x: f32) { g(x); }", "1:47: unknown function g"),
        ("fn f(x: vec5f) -> f32 { return 1.0; }", "1:9: vec5f is not a type"),
        (
            "fn f(x: i32) -> i32 { switch x { case 1 { if x > 0 { break; } } default {} } return x; }",
            "break inside a case",
        ),
        (
            "fn f(x: i32) -> i32 { loop { if x > 0 { continue; } continuing {} } }",
            "a loop with both continue and continuing",
        ),
        ("fn f(x: f32) -> f32 { return x", "expected ;"),
    ],
)
def test_unsupported_wgsl_is_an_error(source, said):
    """Bindings and pointers are not part of an encoder."""
    with pytest.raises(TranslationError, match=re.escape(said)):
        reduced(read_wgsl(source), {"f": "encode"}, "p", "")


def test_wgsl_loop_may_break_before_its_continuing_block():
    source = "fn f(x: f32) -> f32 { var i = x; loop { if i > 3 { break; } continuing { i += 1; } } return i; }"
    assert "break;" in GlslWriter("p", {}).program(reduced(read_wgsl(source), {"f": "encode"}, "p", ""))


def test_step_in_c_is_1_at_its_edge():
    """As in GLSL, the result is 0 only if x is less than the edge."""
    source = "vec2 mine_encode(vec3 n) { return vec2(step(0.5, n.x), n.y); } vec3 mine_decode(vec2 e) { return e.xyx; }"
    assert " < 0.5f ? 0.0f : 1.0f" in written(CWriter, source), written(CWriter, source)


MODULE = """
/* A comment may /* hold */ others. // */
struct Settings { scale: f32, @align(16) bias: vec4<f32> };
@group(0) @binding(0) var<uniform> settings: Settings;
@group(0) @binding(1) var sheet: texture_2d<f32>;
struct Given { @builtin(position) p: vec4<f32>, @location(0) n: vec3<f32> };
@compute @workgroup_size(8, 8) fn cs(@builtin(local_invocation_index) i: u32) { settings.scale; }
@fragment fn fs(given: Given) -> @location(0) vec2<f32> { return mineEncode(given.n) * settings.scale; }
fn shade(given: Given) -> vec3<f32> { return given.n; }
fn bump(p: ptr<function, f32>) { *p = *p + 1.0; }
fn texel(at: vec2<i32>) -> vec3<f32> { return textureLoad(sheet, at, 0).xyz; }
"""


def test_unrelated_parts_of_a_wgsl_module_are_left_out():
    """Entry points, bindings and pointers do not prevent the pair from being read."""
    written = [
        GlslWriter("p", {}).program(
            reduced(read_wgsl(text), {"mineEncode": "encode", "mineDecode": "decode"}, "p", "mine")
        )
        for text in (WGSL, MODULE + WGSL, WGSL + MODULE)
    ]
    assert written[0] == written[1] == written[2]


ARRAYS = """
#define COUNT 2
void turn(int at, inout float numbers[COUNT]) { numbers[at] = -numbers[at]; }
vec4[COUNT] both(float numbers[COUNT]) {
    vec4 found[COUNT];
    for (int i = 0; i < COUNT; ++i) found[i] = vec4(numbers[i]);
    return found;
}
vec2 mine_encode(vec3 n, vec3 view) {
    float numbers[COUNT];
    for (int i = 0; i < numbers.length(); ++i) numbers[i] = n[i] * float(n.length());
    turn(1, numbers);
    return n.z < 0.0 ? both(numbers)[0].xy : n.yx;
}
vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, 1.0); }
"""


def test_cuda_supports_array_and_inout_parameters():
    """Arrays are values, as in GLSL; both sides of a ternary are computed, and loops have an unroll pragma."""
    text = written(CudaWriter, ARRAYS)
    assert "__forceinline__ void p_turn(int at, Array<float, 2> &numbers) {" in text
    assert "__forceinline__ Array<vec4, 2> p_both(Array<float, 2> numbers) {" in text
    assert "p_turn(1, numbers);" in text and "numbers[i] = n[i] * 3.0f;" in text
    assert "chosen(n[2] < 0.0f, swizzled<0, 1>(p_both(numbers)[0]), swizzled<1, 0>(n))" in text
    assert text.count("#pragma unroll\n    for (") == 2


@pytest.mark.parametrize("writer", [CWriter, GlslWriter, HlslWriter, MslWriter, WgslWriter])
def test_other_languages_refuse_array_and_inout_parameters(writer):
    with pytest.raises(TranslationError, match="turn has an array as a parameter or a result; use separate numbers"):
        written(writer, ARRAYS)
    changed = "void turn(inout float x) { x = -x; }\n" + SOURCE.replace(
        "float sum = 0.0;", "float sum = 0.0; turn(sum);"
    )
    with pytest.raises(TranslationError, match="turn changes its argument; return the result instead"):
        written(writer, changed)


def test_cuda_assigns_to_several_components_and_shadows_no_function():
    text = written(CudaWriter, SOURCE.replace("float sum", "vec2 max = n.xy; max.yx = max; max.xy += n.yz; float sum"))
    assert "assign<1, 0>(max_, max_);" in text
    assert "assign<0, 1>(max_, swizzled<0, 1>(max_) + swizzled<1, 2>(n));" in text


@pytest.mark.parametrize("length", ["n", "int(n.x)"])
def test_array_with_a_variable_length_is_an_error_with_its_position(length):
    with pytest.raises(TranslationError, match=r"^2:\d+: the length of an array must be a constant integer"):
        read_glsl(f"vec2 f(vec3 n) {{\n    float x[{length}];\n    return n.xy;\n}}")


def test_the_last_thread_restores_the_recursion_limit():
    """All threads share the recursion limit: two overlapping readers leave it unchanged."""
    before, first, second = sys.getrecursionlimit(), one_error_type(), one_error_type()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert sys.getrecursionlimit() > before
    second.__exit__(None, None, None)
    assert sys.getrecursionlimit() == before
