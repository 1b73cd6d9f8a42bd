"""Code of motion vectors, depth, light and curves, run in each language and compared with the catalogue."""

import re
from pathlib import Path

import numpy as np
import pytest
from languages import RUN, require_runner
from slowly import a_tenth
from test_code_kinds import codec_of
from typed import codecs_of_kind, kinds_named

from normalbench.bench.door import code_command
from normalbench.bench.shaders.code.files import code_of, stem_of
from normalbench.bench.shaders.code.reference import reference
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.subjects.codecs.kinds.codecs import NAMED
from normalbench.encodings.catalogue import BY_KIND


def agreement_of(codec, language, folder: Path, text=None):
    code = code_of(codec, language, "p")
    for name, data in code.files([]).items():
        (folder / name).write_bytes(data)
    if text is not None:
        (folder / code.name).write_text(text(code.body))
    return agreement(codec, language, folder / code.name, code.interface)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("storage", ["rg16_snorm", "rg8_centred", "float:4:5", "unorm:9:7"])
def test_motion_is_rounded_as_requested(storage, tmp_path):
    """Motion is truncated toward zero: the file name says so, and the texels differ from rounding to nearest."""
    require_runner("c")
    (codec,) = codecs_of_kind(NAMED["motion"], "cube_root", storage, ["truncate"])
    verdict = agreement_of(codec, "c", tmp_path)
    assert verdict.holds, verdict.says
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
def test_a_wrong_number_in_code_for_a_kind_is_noticed(fault, tmp_path):
    """Each fault alone makes the comparison fail."""
    require_runner("c")
    named, old, new = MUTANTS[fault]

    def changed(text: str) -> str:
        assert old in text, text
        return text.replace(old, new)

    verdict = agreement_of(codec_of(*named), "c", tmp_path, changed)
    assert not verdict.holds, verdict.says


OWN_MOTION = """
float2 EncodeVelocity(float2 velocity) { return velocity * 0.499 + 0.5; }
float2 DecodeVelocity(float2 code) { return (code - 0.5) / 0.499; }
"""


OWN_ROUGHNESS = "float PackRoughness(float roughness) { return sqrt(roughness); }\n"


OWN_ROUGHNESS += "float UnpackRoughness(float code) { return code * code; }\n"


OWN = {"motion": (OWN_MOTION, "rg16"), "curve": (OWN_ROUGHNESS, "r8")}


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind", OWN)
def test_a_users_hlsl_for_a_kind_is_written_in_c(kind, tmp_path):
    """A user's HLSL, written in C, agrees with the OpenGL result; its function names give the kind."""
    require_runner("c")
    text, storage = OWN[kind]
    path = tmp_path / "mine.hlsl"
    path.write_text(text)
    assert [named_kind.word for named_kind in kinds_named(str(path), "")] == [kind]
    codec = codec_of(kind, str(path), storage)
    verdict = agreement_of(codec, "c", tmp_path)
    assert verdict.holds, verdict.says


@pytest.mark.usefixtures("gl")
def test_a_users_light_encoder_is_recognised_and_remains_user_code(tmp_path, monkeypatch, run):
    """A light encoder may preserve unit vectors. It remains the user's code if its functions are named."""
    monkeypatch.chdir(tmp_path)
    text = "float4 EncodeLight(float3 light) { return float4(light * 0.25, 1.0); }\n"
    Path("mine.hlsl").write_text(text + "float3 DecodeLight(float4 code) { return code.rgb * 4.0; }\n")
    for word in ("mine.hlsl", "mine.hlsl:EncodeLight:DecodeLight"):
        assert [kind.word for kind in kinds_named(word, "")] == ["light"]
        _, out, err = run("code", word, "--storage", "rgba8", "--to", "glsl")
        assert "Encode and decode are yours." in out, err


@pytest.mark.usefixtures("gl")
def test_command_infers_and_reports_the_kind(run):
    """A name that only one kind has needs no `--of`; the file's header gives the command with the kind."""
    status, out, err = run("code", "cube_root", "--storage", "rg16_snorm", "--to", "c")
    assert (status, err) == (0, "")
    head = " ".join(line.removeprefix("//").strip() for line in out.partition("\n\n")[0].splitlines())
    assert "normalbench code cube_root --of motion --storage rg16_snorm --to c" in head
    assert re.search(r"texels of (\d+ of )?65536 motions", head) and "in screens per frame" in head


@pytest.mark.usefixtures("gl")
def test_another_kind_is_checked_in_the_same_way_as_normals(run):
    """The table has a row for each codec."""
    status, out, _ = run("code", "--check", "srgb,gamma_2_2", "--of", "curve", "--storage", "r8", "--to", "c")
    assert status == 0 and {"srgb", "gamma_2_2", "equal"} <= set(out.split()), out


@pytest.mark.usefixtures("gl")
def test_codecs_of_several_kinds_are_written_by_one_command(run, tmp_path, monkeypatch):
    """Each codec uses its kind's default storage; an unsupported storage is reported and affects no other codec."""
    # Errors take a search for the worst case; test_code.py has a file that says them.
    monkeypatch.setattr(code_command, "figures", lambda _: [])
    status, _, err = run("code", "octahedral,cube_root,rgbm:range=8,Octahedral-Angle", "--to", "c", "-o", str(tmp_path))
    files = sorted(path.name for path in tmp_path.iterdir())
    assert status == 0 and files == [
        "frame_octahedral_angle_rgb10a2.h",
        "light_rgbm_8_rgba8.h",
        "motion_cube_root_rg8.h",
        "octahedral_rgba8.h",
    ], err
    assert "normalbench code rgbm:8 --of light" in (tmp_path / "light_rgbm_8_rgba8.h").read_text()
    status, out, err = run("code", "octahedral,rgbm", "--storage", "rg8", "--to", "c", "--check")
    assert status == 0 and "octahedral" in out and "left out: rgbm/rg8: rgbm is made for rgba8" in err


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name", [("light", "rgbm:8"), ("curve", "log:4")])
def test_code_for_another_range_gives_the_catalogues_texels(kind, name, tmp_path):
    require_runner("c")
    verdict = agreement_of(codec_of(kind, name, ""), "c", tmp_path)
    assert verdict.holds, verdict.says


# Of each kind, codes and storages that are made otherwise: shares, polynomials, powers, floats, and integers.
CODECS = (
    ("motion", "cube_root", "rg16_snorm"),
    ("motion", "linear", "rg16f"),
    ("motion", "log", "rg8_centred"),
    ("motion", "sqrt", "float:4:5"),
    ("curve", "srgb", "r8"),
    ("curve", "log", "r16f"),
    ("curve", "ray_bits", "rgb10a2"),
    ("curve", "squared", "unorm:5"),
    ("light", "plain", "rgba16f"),
    ("light", "plain", "r11g11b10f"),
    ("light", "rgbm", "rgba8"),
    ("light", "nao32", "rgba8"),
    ("light", "rgb9e5", "rgba8"),
    ("depth", "linear", "r32f"),
    ("depth", "linear", "unorm:20"),
    ("depth", "linear_sign", "packed24"),
    ("depth", "window", "packed24"),
    ("depth", "reversed_window", "depth32f"),
    ("depth", "logarithmic", "packed16"),
)


def pairs() -> list:
    """Return each codec with each language."""
    return [(*codec, language) for codec in CODECS for language in RUN]


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name, storage, language", a_tenth(pairs()))
def test_code_for_a_kind_gives_the_catalogues_texels(kind, name, storage, language, tmp_path):
    """Texels, decoded numbers and render targets are compared for 2^16 values."""
    require_runner(language)
    verdict = agreement_of(codec_of(kind, name, storage), language, tmp_path)
    assert verdict.holds, verdict.says


@pytest.mark.parametrize("kind", ["motion", "curve", "light", "depth"])
def test_code_for_every_encoding_of_a_kind_is_written(kind, tmp_path):
    """Each encoding is written in C, in its default storage."""
    require_runner("c")
    for name in BY_KIND[NAMED[kind]]:
        verdict = agreement_of(codec_of(kind, name, ""), "c", tmp_path)
        assert verdict.holds, f"{name}: {verdict.says}"
