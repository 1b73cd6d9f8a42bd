"""Translations, confirmed by a second compiler before they are measured."""

import re
from contextlib import nullcontext

import numpy as np
import pytest
import test_second
from everyday import WGSL
from languages import require_runner
from typed import first_look, read_encoding, translated

from normalbench.bench.ground.directions import directions
from normalbench.bench.ground.output import cache as kept
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import second
from normalbench.bench.shaders.translator.wgsl_parser import WgslParser
from normalbench.bench.subjects.codecs import second_look
from normalbench.gbuffer.codecs.codec_passes import exact_values
from normalbench.gbuffer.gl.device import device

pytestmark = pytest.mark.usefixtures("gl", "in_this_process")
empty_cache = test_second.empty_cache


DECODE = "float3 MineDecode(float2 e) { return normalize(float3(e, 1.0 - abs(e.x) - abs(e.y))); }"


SUM = "n /= abs(n.x) + abs(n.y) + abs(n.z);"


MATRICES = "static const float2x2 A = { 1, 5, 5, 1 };\nstatic const float2x2 B = { 1, 0, 0, 0.5 };\n"


def codes(path, by=""):
    n = np.pad(directions(), ((0, 0), (0, 1)))
    return exact_values(device(), read_encoding(path, "", by=by), n, n, n)[0][:, :2]


def hlsl_of(folder, name, body):
    path = folder / f"{name}.hlsl"
    path.write_text(f"{MATRICES}float2 MineEncode(float3 n) {{ {SUM} {body} }}\n{DECODE}\n")
    return path


UNDEFINED = "it divides an integer by 0 for some normals, which its language does not define"


@pytest.mark.usefixtures("hlsl", "slang")
def test_integer_division_by_zero_is_a_one_line_error(tmp_path):
    error = first_look(hlsl_of(tmp_path, "mine", "int k = int(n.x * 0.0); return n.xy + (7 / k) * 1e-12;"))["error"]
    assert error.endswith(UNDEFINED)


# HLSL that glslang reads otherwise than HLSL defines, beside the same written out.
MISREAD = {
    "fmod": ("return fmod(n.xy * 1.5, 1.0);", "return n.xy * 1.5 - trunc(n.xy * 1.5);"),
    "remainder": ("return (n.xy * 1.5) % 1.0;", "return n.xy * 1.5 - trunc(n.xy * 1.5);"),
    "product of matrices": ("return mul(A * B, n.xy);", "return mul(float2x2(1, 0, 0, 0.5), n.xy);"),
}


@pytest.mark.usefixtures("hlsl", "slang")
# To glslang a remainder is an fmod.
@pytest.mark.parametrize("name", [name for name in MISREAD if name != "remainder"])
def test_hlsl_that_glslang_misreads_is_measured_as_hlsl_defines_it(name, tmp_path):
    """A note names the function, the normal and both codes; Slang's code equals that of the formula written out."""
    misread, plain = (hlsl_of(tmp_path, f"f{index}", body) for index, body in enumerate(MISREAD[name]))
    (note,) = first_look(misread)["notes"]
    assert note.startswith("MineEncode of [") and " with Slang and [" in note and "with glslang; the first" in note
    assert "notes" not in first_look(plain)
    assert np.allclose(codes(misread), codes(plain), atol=2e-6)
    assert not np.allclose(codes(misread, "glslang"), codes(plain), atol=0.1)


def test_a_translation_that_naga_contradicts_is_refused(tmp_path, monkeypatch):
    """The translator is given a fault: the remainder of a negative number takes the divisor's sign."""
    require_runner("wgsl")
    path = tmp_path / "mine.wgsl"
    path.write_text(WGSL["remainder of floats"])
    assert "error" not in first_look(path)
    path.write_text(WGSL["remainder of floats"] + "\n")
    own = WgslParser._modulus
    monkeypatch.setattr(WgslParser, "_modulus", lambda self, _, x, y: own(self, "floor", x, y))
    line = first_look(path)["error"]
    assert "two compilers disagree: mine_encode of [" in line and "this program and [" in line and "with naga" in line


@pytest.mark.usefixtures("hlsl", "slang")
def test_second_compiler_runs_once_per_text(tmp_path, monkeypatch):
    """The result is cached by the text; another text is checked again."""
    path, ways = hlsl_of(tmp_path, "mine", "return n.xy;"), []
    own = second.second_way
    monkeypatch.setattr(second_look, "second_way", lambda *given: ways.append(given) or own(*given))
    for count in (1, 1):
        first_look(path)
        assert len(ways) == count
    hlsl_of(tmp_path, "mine", "return n.yx;")
    first_look(path)
    assert len(ways) == 2


@pytest.mark.usefixtures("hlsl", "slang")
def test_missing_second_compiler_is_noted(tmp_path, monkeypatch):
    """The file is still measured, and is checked again the next time; glslang also serves as a second compiler."""
    path = hlsl_of(tmp_path, "mine", "return n.xy;")
    with monkeypatch.context() as patched:
        patched.setenv("MESA_EXTENSION_OVERRIDE", "-GL_ARB_gl_spirv")
        assert "notes" not in first_look(path)
        kept.folder().rename(tmp_path / "gone")
        patched.setattr(second_look, "_by_glslang", lambda *_: None)
        (note,) = first_look(path)["notes"]
    assert note == "no second compiler has checked its translation: the OpenGL driver does not support GL_ARB_gl_spirv"
    assert "notes" not in first_look(path)


@pytest.mark.usefixtures("hlsl", "slang")
@pytest.mark.parametrize("used, body", [("fmod", "fmod(p, 0.7)")])
def test_code_that_glslang_misreads_is_not_measured_by_glslang_alone(tmp_path, used, body):
    """Slang refuses to truncate a float3 silently. Without fmod a note says that only glslang can read the file."""
    plain = hlsl_of(tmp_path, "plain", "float2 p = n; return p;").name
    path = tmp_path / plain
    path.write_text(path.read_text().replace(MATRICES, ""))
    assert "notes" not in first_look(path) and "error" not in first_look(path)
    assert "only glslang can read it; Slang's compiler cannot" in translated(path).notes
    path.write_text(path.read_text().replace("return p;", f"return {body};"))
    error = first_look(path)["error"]
    assert (
        f"it uses {used}, which glslang interprets differently from HLSL" in error
        and "no second compiler can read the file" in error
    )


@pytest.mark.usefixtures("hlsl", "slang")
def test_error_in_code_that_neither_compiler_reads_is_reported_by_slang(tmp_path):
    """Only Slang reads `select()` of HLSL 2021, which Unreal uses."""
    path = hlsl_of(tmp_path, "mine", "return select(n.z >= 0.0, n.xy, n.yx);")
    assert "error" not in first_look(path)
    wrong = hlsl_of(tmp_path, "wrong", "return select(nothing, n.xy, n.yx);")
    assert re.search(r"wrong\.hlsl:3:\d+: undefined identifier 'nothing'", first_look(wrong)["error"])


# Divisions of whole numbers, and whether they are undefined: k is 0 and m is -1, which compilers do not know.
DIVISIONS = {
    "of a number": ("(7 / k)", True),
    "of a vector": ("(int3(7, 8, 9) / int3(1, k + 1, k)).x", True),
    "without a sign": ("(uint2(7u, 8u) / uint2(1u, uint(k))).y", True),
    "a remainder": ("(7 % k)", True),
    "a remainder without a sign": ("(7u % uint(k))", True),
    # llvmpipe ends the process at it, but does not divide what is multiplied by 0.
    "of the lowest number": ("((-2147483647 + m) / m * 0)", True),
    "in a branch that is not taken": ("(k != 0 ? 7 / k : 0)", False),
    "of large numbers without a sign": ("(2147483648u / uint(m))", False),
    "of what is not 0": ("(7 / (k + m) + (int2(7, 8) % int2(m, k + 3)).y)", False),
}


# Of numbers, of what has no sign, what ends the process, and what is not taken; the others at night.
FEW = ("of a number", "a remainder without a sign", "of the lowest number", "in a branch that is not taken")


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("name", FEW)
def test_integer_divisions_are_noted(name, tmp_path):
    """The second translation finds the division, whatever the driver returns."""
    division, is_undefined = DIVISIONS[name]
    path = tmp_path / "mine.slang"
    body = f"{SUM} int k = int(n.x * 0.0); int m = k - 1; return n.xy + float({division}) * 1e-12;"
    path.write_text(f"float2 MineEncode(float3 n) {{ {body} }}\n{DECODE}\n")
    way = second.second_way(UserFile(str(path)), translated(path), tmp_path)
    given = directions()
    with pytest.raises(second.UndefinedError) if is_undefined else nullcontext():
        encoded, _ = way(given, np.zeros_like(given), np.zeros(3, np.float32))
        sums = np.abs(given).sum(axis=1, keepdims=True)
        assert np.allclose(encoded[:, :2], given[:, :2] / sums, atol=1e-6)


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize(
    "body",
    [
        "return n.xy + float2(uint2(n.xy * 1000.0) & 255u) * 1e-3;",
        "float s; if (n.x > 0.0) s = n.y; return float2(n.x, s);",
    ],
    ids=["negative as unsigned", "not set"],
)
def test_driver_dependent_results_are_refused(body, tmp_path):
    """Slang's GLSL and SPIR-V differ although the same driver runs both."""
    error = first_look(hlsl_of(tmp_path, "mine", body))["error"]
    assert "two compilers disagree: MineEncode of [" in error and "with its SPIR-V" in error
