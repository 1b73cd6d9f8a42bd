"""Code of motion vectors, depth, light and curves: run in each language, and equal to the catalogue's."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from languages import require_runner

from normalbench.bench.door import code_command
from normalbench.bench.shaders.code.files import code_of, stem_of
from normalbench.bench.shaders.code.kinds.normal import is_catalogues
from normalbench.bench.shaders.code.reference import reference
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.subjects.codecs.kinds.codecs import NAMED, codecs_of_kind, kinds_named
from normalbench.encodings.catalogue import ENCODINGS


def codec_of(kind, names, storage):
    (codec,) = codecs_of_kind(NAMED[kind], names, storage, ["nearest"])
    assert not codec.misfit
    return codec


def agreement_of(codec, language, folder: Path, text=None):
    code = code_of(codec, language, "p")
    for name, data in code.files([]).items():
        (folder / name).write_bytes(data)
    if text is not None:
        (folder / code.name).write_text(text(code.body))
    return agreement(codec, language, folder / code.name, code.interface)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("storage", ["rg16_snorm", "rg8_centred", "float:4:5", "unorm:9:7"])
def test_motion_is_rounded_as_it_is_said(storage, tmp_path):
    """Cut off toward zero; the file's name says so, and the texels are not those of the nearest."""
    require_runner("c")
    (codec,) = codecs_of_kind(NAMED["motion"], "cube_root", storage, ["truncate"])
    found = agreement_of(codec, "c", tmp_path)
    assert found.holds, found.says
    assert stem_of(codec).endswith("_truncate")
    nearest = reference(codec_of("motion", "cube_root", storage))
    assert np.mean((reference(codec).words != nearest.words).any(axis=1)) > 0.25


# What is changed in C, and what must notice.
MUTANTS = {
    "a scale": (("motion", "linear", "rg16_snorm"), "* 32767.0f", "* 32766.0f"),
    "swapped numbers": (("motion", "linear", "rg16_snorm"), "x | (y << 16)", "y | (x << 16)"),
    "a range": (("curve", "log", "r8"), "log2f(1.0f + 31.0f)", "log2f(1.0f + 30.0f)"),
    "a plane": (("depth", "linear", "r32f"), "return number;", "return number * 1.001f;"),
    "a byte": (("depth", "linear", "packed16"), "x >> 8", "x >> 7"),
    "an exponent": (("light", "rgb9e5", "rgba8"), "(1.0f + (float)P_BIAS)", "(2.0f + (float)P_BIAS)"),
    "a matrix": (("light", "nao32", "rgba8"), "0.7319f", "0.7219f"),
    "a channel": (("light", "rgbm", "rgba8"), "code.y, 0.0f", "code.x, 0.0f"),
}


@pytest.mark.parametrize("fault", MUTANTS)
def test_a_wrong_number_in_the_code_of_a_kind_is_noticed(fault, tmp_path):
    """Each fault alone makes the comparison fail."""
    require_runner("c")
    named, old, new = MUTANTS[fault]

    def changed(text: str) -> str:
        assert old in text, text
        return text.replace(old, new)

    found = agreement_of(codec_of(*named), "c", tmp_path, changed)
    assert not found.holds, found.says


def test_a_setting_that_nothing_reads_is_no_parameter():
    """A range of 1 is left out with its quotient; `near` is not taken where the far plane is enough."""
    roughness = code_of(codec_of("curve", "linear", "r8"), "glsl", "p").body
    assert "float p_encode(float x)" in roughness and "return x;" in roughness
    assert "p_encode(float depth, float far)" in code_of(codec_of("depth", "linear", "packed16"), "glsl", "p").body
    assert "p_encode(float depth)" in code_of(codec_of("depth", "linear", "r32f"), "glsl", "p").body
    assert "vec4 p_encode(vec3 light)" in code_of(codec_of("light", "rgbm", "rgba8"), "glsl", "p").body


def test_hlsl_unrolls_loops_over_constants_alone():
    """The polynomials of a logarithm and a power; no loop of another kind."""
    codec = codec_of("motion", "cube_root", "rg16_snorm")
    assert code_of(codec, "hlsl", "p").body.count("    [unroll]\n    for (int i = ") == 2
    assert "[unroll]" not in code_of(codec, "glsl", "p").body


OWN_MOTION = """
float2 EncodeVelocity(float2 velocity) { return velocity * 0.499 + 0.5; }
float2 DecodeVelocity(float2 code) { return (code - 0.5) / 0.499; }
"""


OWN_ROUGHNESS = "float PackRoughness(float roughness) { return sqrt(roughness); }\n"


OWN_ROUGHNESS += "float UnpackRoughness(float code) { return code * code; }\n"


OWN = {"motion": (OWN_MOTION, "rg16"), "curve": (OWN_ROUGHNESS, "r8")}


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind", OWN)
def test_a_users_code_of_a_kind_is_written(kind, tmp_path):
    """HLSL of a user in C, compared with what OpenGL makes of it; the kind is what its names say."""
    require_runner("c")
    text, storage = OWN[kind]
    path = tmp_path / "mine.hlsl"
    path.write_text(text)
    assert [one.word for one in kinds_named(str(path), "")] == [kind]
    codec = codec_of(kind, str(path), storage)
    found = agreement_of(codec, "c", tmp_path)
    assert found.holds, found.says


@pytest.mark.usefixtures("gl")
def test_a_users_light_is_of_light_and_stays_theirs(tmp_path, monkeypatch, run):
    """One that gives unit vectors back is not of normals for that; with its functions named it is no code of ours."""
    monkeypatch.chdir(tmp_path)
    text = "float4 EncodeLight(float3 light) { return float4(light * 0.25, 1.0); }\n"
    Path("mine.hlsl").write_text(text + "float3 DecodeLight(float4 code) { return code.rgb * 4.0; }\n")
    for word in ("mine.hlsl", "mine.hlsl:EncodeLight:DecodeLight"):
        assert [one.word for one in kinds_named(word, "")] == ["light"]
        _, out, err = run("code", word, "--storage", "rgba8", "--to", "glsl")
        assert "Encode and decode are yours." in out, err


@pytest.mark.usefixtures("gl")
def test_the_command_finds_the_kind_and_says_it(run):
    """A name that one kind has needs no --of; the head has the kind, and the command that was typed."""
    status, out, err = run("code", "cube_root", "--storage", "rg16_snorm", "--to", "c")
    assert (status, err) == (0, "")
    head = " ".join(line.removeprefix("//").strip() for line in out.partition("\n\n")[0].splitlines())
    assert "normalbench code cube_root --of motion --storage rg16_snorm --to c" in head
    assert re.search(r"texels of (\d+ of )?65536 motions", head) and "in screens a frame" in head


@pytest.mark.usefixtures("gl")
def test_a_kind_is_checked_as_normals_are(run):
    """A row of each codec."""
    status, out, _ = run("code", "--check", "srgb,gamma_2_2", "--of", "curve", "--storage", "r8", "--to", "c")
    assert status == 0 and {"srgb", "gamma_2_2", "equal"} <= set(out.split()), out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["linear"], "say which with --of"),
        (["linear", "--of", "sound"], "unknown kind 'sound'"),
        (["rgbm", "--rounding", "truncate"], "rounded to the nearest"),
        (["plain", "--of", "light", "--storage", "srgb8_a8"], "made for"),
        (["linear", "--of", "light", "--storage", "srgb8_a8"], "by itself"),
        (["linear_sign", "--storage", "depth16"], "no room for a sign"),
        (["octahedral,cube_rot"], "did you mean cube_root?"),
        (["octahedral,nonsense,rgbm"], "unknown encoding 'nonsense'"),
        (["octahedral,linear"], "say which with --of"),
        (["cube_root:range=4"], "its functions take the range"),
        (["rgbm:range=0"], "a range is 0.001 to 10000"),
        (["log:4"], "say which with --of"),
    ],
)
def test_what_cannot_be_written_of_a_kind_is_a_line(run, arguments, said):
    status, out, err = run("code", *arguments)
    assert (status, out) == (2, "")
    assert said in err and err.count("\n") == 1, err


@pytest.mark.usefixtures("gl")
def test_names_of_several_kinds_are_written(run, tmp_path, monkeypatch):
    """Each in what its kind usually lies in; what a kind does not take is named, and spares the others."""
    # Errors take a search for the worst case; test_code.py has a file that says them.
    monkeypatch.setattr(code_command, "figures", lambda _: [])
    status, _, err = run("code", "octahedral,cube_root,rgbm:range=8,Octahedral-Angle", "--to", "c", "-o", str(tmp_path))
    made = sorted(path.name for path in tmp_path.iterdir())
    assert status == 0 and made == [
        "frame_octahedral_angle_rgb10a2.h",
        "light_rgbm_8_rgba8.h",
        "motion_cube_root_rg8.h",
        "octahedral_rgba8.h",
    ], err
    assert "normalbench code rgbm:8 --of light" in (tmp_path / "light_rgbm_8_rgba8.h").read_text()
    status, out, err = run("code", "octahedral,rgbm", "--storage", "rg8", "--to", "c", "--check")
    assert status == 0 and "octahedral" in out and "left out: rgbm/rg8: rgbm is made for rgba8" in err


def test_a_range_is_a_constant_of_the_code():
    """Of light another encoding, of a curve another number; the curve's name has it."""
    assert "8.0" in code_of(codec_of("light", "rgbm:8", "rgba8"), "glsl", "p").body
    log = codec_of("curve", "log:range=4", "r8")
    assert log.range == 4 and stem_of(log) == "curve_log_4_r8"


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name", [("light", "rgbm:8"), ("curve", "log:4")])
def test_the_code_over_another_range_gives_the_catalogues_texels(kind, name, tmp_path):
    require_runner("c")
    found = agreement_of(codec_of(kind, name, ""), "c", tmp_path)
    assert found.holds, found.says


def test_a_name_makes_nobodys_file_the_catalogues():
    """Whose an encoder is decides whether it is walled in: another file with a name of the catalogue's is not ours."""
    known = ENCODINGS["octahedral"]
    assert is_catalogues(known) and is_catalogues(replace(known, name="octahedral:sign=0"))
    assert not is_catalogues(replace(known, glsl=Path("octahedral.glsl")))
    assert not is_catalogues(replace(known, name="octahedral:HALF=1", glsl=Path("mine.hlsl")))
