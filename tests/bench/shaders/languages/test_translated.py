"""Users' HLSL and Slang files in every command, and one-line errors that do not affect other files."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from twins import HALF_OCTAHEDRAL

from normalbench.bench.ground.directions import directions
from normalbench.bench.run.measuring import files_of
from normalbench.bench.shaders.languages.plain import NotPlainError, plain
from normalbench.bench.subjects.codecs.doctor.exact import is_unit
from normalbench.bench.tables.quality.table import QualityOptions

pytestmark = pytest.mark.usefixtures("gl")


MINE = """
float2 EncodeNormal(float3 n) {
    float2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return float2(p.x + p.y, p.x - p.y);
}
float3 DecodeNormal(float2 e) {
    float2 p = float2(e.x + e.y, e.x - e.y) * 0.5;
    return normalize(float3(p, 1.0 - abs(p.x) - abs(p.y)));
}
"""


QUICK = ("--storage", "rg8", "--normals", "hemisphere", "--backend", "glsl", "--count", "4096", "--format", "json")


def changed(code: str) -> str:
    """Return MINE with another return statement in its encoder."""
    return MINE.replace("return float2(p.x + p.y, p.x - p.y);", code)


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    """The test's folder as working directory, so that translations cached by file name are reused in each run."""
    monkeypatch.chdir(tmp_path)


def written(folder, text, name) -> str:
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return name if folder == Path.cwd() else str(folder / name)


def test_each_of_several_pairs_is_measured(run, tmp_path, ending):
    path = written(tmp_path, MINE + MINE.replace("Normal(", "NormalOct("), f"mine.{ending}")
    _, out, _ = run("quality", "--encoding", path, *QUICK)
    assert {row["encoding"] for row in json.loads(out)} == {f"mine.{ending}:EncodeNormal{end}" for end in ("", "Oct")}
    both = f"{path}:EncodeNormal:DecodeNormal,{path}:EncodeNormalOct:DecodeNormalOct"
    _, out, _ = run("quality", "--encoding", both, *QUICK)
    assert [row["encoding"] for row in json.loads(out)] == [
        f"mine.{ending}:{name}" for name in ("EncodeNormal", "EncodeNormalOct")
    ]


@pytest.mark.usefixtures("hlsl")
def test_glsl_style_function_names_name_the_encoding(run, tmp_path):
    path = written(
        tmp_path, MINE.replace("EncodeNormal", "diamond_encode").replace("DecodeNormal", "diamond_decode"), "x.hlsl"
    )
    _, out, _ = run("quality", "--encoding", path, *QUICK)
    assert json.loads(out)[0]["encoding"] == "diamond"


@pytest.mark.usefixtures("hlsl")
def test_codes_in_0_to_1_are_stored_unchanged(run, tmp_path):
    """An unsigned storage holds the returned value itself; rows say so in a column, and `doctor` in a line."""
    text = changed("return float2(p.x + p.y, p.x - p.y) * 0.5 + 0.5;").replace(
        "float2 p = float2(e", "e = e * 2.0 - 1.0; float2 p = float2(e"
    )
    signed, other = written(tmp_path, MINE, "signed.hlsl"), written(tmp_path, text, "unsigned.hlsl")
    _, out, err = run("quality", "--encoding", f"{signed},{other}", *QUICK)
    rows = json.loads(out)
    first, second = (row["angle_mean_deg"] for row in rows)
    assert first == pytest.approx(second, rel=1e-6)
    assert [row["code_range"] for row in rows] == [None, "[0, 1]"] and "[0, 1]" not in err
    _, out, _ = run("doctor", other, "--format", "json")
    assert "are in [0, 1]; every storage holds them unchanged" in out


def test_conversion_to_signed_and_back_keeps_every_integer():
    """docs/your-encoding.md states an error of at most 2^-26, far below half a step of any storage."""
    half, unity = np.float32(0.5), np.float32(1)
    c = np.concatenate(
        [np.arange(2**bits) / (2**bits - 1) for bits in (5, 8, 10, 11, 12, 16)] + [np.linspace(0, 1, 10**6)]
    )
    c = c.astype(np.float32)
    back = (c * 2 - unity) * half + half
    assert back.dtype == np.float32 and np.abs(back - c.astype(np.float64)).max() <= 2**-26
    for bits in (5, 8, 10, 11, 12, 16):
        whole = np.arange(2**bits)
        scaled = np.float32(whole / (2**bits - 1))
        assert np.array_equal(np.rint(((scaled * 2 - unity) * half + half) * np.float32(2**bits - 1)), whole)


def test_codes_in_0_to_1_are_distinguished_from_others():
    n = directions()
    assert is_unit(n * 0.5 + 0.5) and is_unit((n[:, :2] * 0.5 + 0.5) * 1.0000001)
    assert not is_unit(n) and not is_unit(n * 0.25 + 0.5) and not is_unit(n[:, :1] * 0)
    assert not is_unit(abs(n) * [1, 1, 1] - [0, 0, 0.2])


def test_single_invalid_file_is_a_one_line_error(run, tmp_path, ending):
    path = written(tmp_path, changed("\n return n.xy * strange;"), f"mine.{ending}")
    status, out, err = run("quality", "--encoding", path, *QUICK)
    assert (status, out) == (2, "") and err.count("\n") == 1 and f"{path}:5:16: " in err, err


@pytest.mark.usefixtures("hlsl")
def test_python_twin_of_a_file_is_measured_by_jax(run, tmp_path):
    path = written(tmp_path, MINE, "mine.hlsl")
    written(tmp_path, HALF_OCTAHEDRAL, "mine.py")
    _, out, _ = run("quality", "--encoding", path, *QUICK[:4], *QUICK[6:])
    by_jax, by_gl = (row["angle_mean_deg"] for row in json.loads(out))
    assert by_jax == pytest.approx(by_gl, rel=1e-3)


def test_cached_rows_depend_on_includes_and_twin(tmp_path):
    """An interrupted command measures again if an include or the twin has changed."""
    path, seen = written(tmp_path, '#include "part.hlsli"\n' + MINE, "mine.hlsl"), set()
    for name, text in (
        ("part.hlsli", "// one"),
        ("part.hlsli", "// two"),
        ("mine.py", "one = 1"),
        ("mine.py", "two = 2"),
    ):
        written(tmp_path, text, name)
        seen.add(files_of(QualityOptions(encoding=f"{path}:EncodeNormal:DecodeNormal"))["files"][0])
    assert len(seen) == 4


def test_a_shader_becomes_functions_with_other_names():
    shader = "#version 430\nlayout(location = 0) in vec3 _8;\nlayout(location = 0) out vec2 _9;\n"
    shader += "void main()\n{\n    _9 = _8.xy;\n}\n"
    expected = "vec2 p_main(vec3 p_0, vec3 view)\n{\n    vec2 p_out;\n    p_out = p_0.xy;\n    return p_out;\n}\n"
    assert plain(shader, "p", "vec3") == expected
    with pytest.raises(NotPlainError, match="a texture or a constant buffer"):
        plain("layout(binding = 0) uniform sampler2D _7;\n" + shader, "p", "vec3")


def test_translation_imports_no_heavy_libraries():
    """The process that translates starts in a tenth of a second."""
    code = "import sys, normalbench.bench.shaders.languages.child\n"
    code += "print([name for name in ('jax', 'numpy', 'moderngl', 'torch') if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"


@pytest.mark.parametrize("version", ["", "#define __HLSL_VERSION 2016\n"])
def test_the_hlsl_version_macro_is_defined(run, ending, version):
    """Engines check the version before they use newer features; a file may still set another version."""
    Path(f"mine.{ending}").write_text(
        f"{version}#ifdef __HLSL_VERSION\n#if __HLSL_VERSION < 2021\n{MINE}\n#endif\n#endif\n"
    )
    status, out, err = run("quality", "--encoding", f"mine.{ending}", *QUICK)
    assert status == 0 and json.loads(out), err
