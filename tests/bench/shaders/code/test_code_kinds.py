"""Code of motion vectors, depth, light and curves, run in each language and compared with the catalogue."""

from dataclasses import replace
from pathlib import Path

import pytest
from typed import codecs_of_kind

from normalbench.bench.shaders.code.files import code_of, stem_of
from normalbench.bench.shaders.code.kinds.normal import is_catalogues
from normalbench.bench.subjects.codecs.kinds.codecs import NAMED
from normalbench.encodings.catalogue import ENCODINGS


def codec_of(kind, names, storage):
    (codec,) = codecs_of_kind(NAMED[kind], names, storage, ["nearest"], slice(1))
    assert not codec.misfit
    return codec


def test_unused_setting_is_not_a_parameter():
    """A range of 1 is left out with its division, and `near` is left out if the far plane is enough."""
    roughness = code_of(codec_of("curve", "linear", "r8"), "glsl", "p").body
    assert "float p_encode(float x)" in roughness and "return x;" in roughness
    assert "p_encode(float depth, float far)" in code_of(codec_of("depth", "linear", "packed16"), "glsl", "p").body
    assert "p_encode(float depth)" in code_of(codec_of("depth", "linear", "r32f"), "glsl", "p").body
    assert "vec4 p_encode(vec3 light)" in code_of(codec_of("light", "rgbm", "rgba8"), "glsl", "p").body


def test_hlsl_unrolls_only_loops_over_constants():
    """The unrolled loops are the polynomials of a logarithm and of a power; GLSL has no `[unroll]`."""
    codec = codec_of("motion", "cube_root", "rg16_snorm")
    assert code_of(codec, "hlsl", "p").body.count("    [unroll]\n    for (int i = ") == 2
    assert "[unroll]" not in code_of(codec, "glsl", "p").body


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["linear"], "choose one with --of"),
        (["linear", "--of", "sound"], "unknown kind 'sound'"),
        (["rgbm", "--rounding", "truncate"], "round to nearest"),
        (["plain", "--of", "light", "--storage", "srgb8_a8"], "made for"),
        (["linear", "--of", "light", "--storage", "srgb8_a8"], "converts colours itself; write the curve srgb in r8"),
        (["linear_sign", "--storage", "depth16"], "no room for a sign"),
        (["octahedral,cube_rot"], "did you mean cube_root?"),
        (["octahedral,nonsense,rgbm"], "unknown encoding 'nonsense'"),
        (["octahedral,linear"], "choose one with --of"),
        (["cube_root:range=4"], "only light and curves take a range"),
        (["rgbm:range=0"], "the range must be 0.001 to 10000"),
        (["log:4"], "choose one with --of"),
    ],
)
def test_unsupported_request_for_a_kind_is_a_one_line_error(run, arguments, said):
    status, out, err = run("code", *arguments)
    assert (status, out) == (2, "")
    assert said in err and err.count("\n") == 1, err


def test_a_range_is_a_constant_in_the_code():
    """For light, another range makes another encoding; for a curve the range is a number in the file name."""
    assert "8.0" in code_of(codec_of("light", "rgbm:8", "rgba8"), "glsl", "p").body
    log = codec_of("curve", "log:range=4", "r8")
    assert log.range == 4 and stem_of(log) == "curve_log_4_r8"


def test_a_users_file_with_a_catalogue_name_is_still_treated_as_user_code():
    """Code from users runs in a sandbox, so a user's file with a catalogue name must not pass as the catalogue's."""
    known = ENCODINGS["octahedral"]
    assert is_catalogues(known) and is_catalogues(replace(known, name="octahedral:sign=0"))
    assert not is_catalogues(replace(known, glsl=Path("octahedral.glsl")))
    assert not is_catalogues(replace(known, name="octahedral:HALF=1", glsl=Path("mine.hlsl")))
