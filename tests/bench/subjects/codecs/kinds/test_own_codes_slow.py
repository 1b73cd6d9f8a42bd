"""Users' encodings of quantities other than normals: measured like the catalogue's, with one-line errors."""

import json

import pytest
from test_own_codes import INPUTS, LIGHTS, PAIR, VECTORS, figures, lit
from typed import translated

pytestmark = pytest.mark.usefixtures("gl", "slang")


@pytest.mark.parametrize("ending", ["hlsl", "slang", "glsl", "wgsl"])
def test_a_copy_of_a_motion_encoding_has_the_same_rows(run, ending):
    """Each file is the catalogue's `sqrt`: with a range, a structure, an out parameter or a stage around it."""
    file = INPUTS / f"velocity.{ending}"
    words = ("--storage", "rg16,rg8_snorm,rg16f", "--range", "0.5,1")
    status, out, err = run(*VECTORS, "--encoding", f"{file},sqrt", *words)
    assert status == 0 and not err, err
    assert len(figures(out, "sqrt")) == 12
    assert figures(out, file.name) == figures(out, "sqrt")


def test_decoder_of_another_encoder_is_measured_and_reported(run, tmp_path):
    file = tmp_path / "mine.hlsl"
    file.write_text(PAIR.replace("return e", "return 2 * e") + "float2 EncodeVelocity(float2 v) { return v; }")
    status, out, err = run(*VECTORS, "--encoding", str(file), "--storage", "rg16")
    assert status == 0 and len(json.loads(out)) == 2
    assert "encode and decode do not undo each other: (1, 0) is off by 1 screens" in err


def test_format_follows_the_file_name(run, tmp_path):
    file = tmp_path / "own.hlsl"
    file.write_text("float3 EncodeLight(float3 l) { return l; } float3 DecodeLight(float3 e) { return e; }")
    words = (*LIGHTS, "--experiment", "equal", "--light-buffer")
    status, out, err = run(*words, f"{file}:format=r11g11b10f,r11g11b10f")
    assert status == 0 and not err, err
    # Channels share a row where the device and the model agree in them.
    left = [{(row["sum"], row["gl"]) for row in lit(out, name)} for name in ("own.hlsl", "r11g11b10f")]
    assert left[0] == left[1] and len(left[0]) >= 2
    status, _, err = run(*words, f"{INPUTS / 'light.hlsl'}:format=r11g11b10f")
    assert status == 2 and "its code has 4 components, but R11F G11F B10F has 3 channels" in err
    status, _, err = run(*words, f"{file}:format=rgba9")
    assert status == 2 and "unknown format 'rgba9'" in err


def test_a_direction_to_a_light_is_still_measured_as_a_normal(tmp_path):
    """The code has two numbers; codes of light never have two."""
    file = tmp_path / "mine.hlsl"
    file.write_text(
        "float2 EncodeLightDir(float3 n) { return n.xy; }"
        "float3 DecodeLightDir(float2 e) { return float3(e, sqrt(saturate(1 - dot(e, e)))); }"
    )
    assert translated(file).named == "EncodeLightDir:DecodeLightDir"
