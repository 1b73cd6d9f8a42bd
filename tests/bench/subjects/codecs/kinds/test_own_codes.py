"""Users' encodings of quantities other than normals: measured like the catalogue's, with one-line errors."""

import json
import re

import numpy as np
import pytest
from manual import ROOT
from typed import light_codecs_named, own_code, own_codes_named

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.languages.shapes import SHAPES
from normalbench.bench.subjects.codecs.kinds.table import OWN
from normalbench.encodings.catalogue import CURVE_ENCODINGS, FRAME_ENCODINGS, LIGHT_BUFFERS, MOTION_ENCODINGS
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.encodings.kinds import BY_NAME, CURVE, FRAME, KINDS, LIGHT, MOTION, NORMAL, kind_spoken_of
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.encodings.storages.storage import CURVE_STORAGES
from normalbench.gbuffer.codecs.curve.curve_passes import CurvePasses
from normalbench.gbuffer.gl.device import device

pytestmark = pytest.mark.usefixtures("gl", "slang")


INPUTS = ROOT / "tests" / "inputs" / "own_codes"


VECTORS = ("vectors", "--backend", "glsl", "--speed", "0.25,4", "--count", "512", "--format", "json")


KEYS = ("encoding", "device", "range")


def test_every_kind_has_a_shape_and_is_tested():
    assert set(SHAPES) == set(OWN) == set(KINDS) - {NORMAL}


def figures(out: str, name: str) -> list[dict]:
    """Return the rows of an encoding without the columns that identify the encoding."""
    rows = [row for row in json.loads(out) if row["encoding"] == name]
    return [{column: value for column, value in row.items() if column not in KEYS} for row in rows]


def test_codes_from_0_to_1_are_stored_unchanged(run, tmp_path):
    """In UNORM these codes match codes in [-1, 1]; SNORM has half as many values and no exact code for no motion."""
    (tmp_path / "biased.hlsl").write_text(
        "float2 EncodeVelocity(float2 v) { return v * 0.5 + 0.5; }"
        "float2 DecodeVelocity(float2 e) { return e * 2.0 - 1.0; }"
    )
    file = tmp_path / "biased.hlsl"
    status, out, err = run(*VECTORS, "--encoding", f"{file},linear", "--storage", "rg16,rg16_snorm")
    assert status == 0 and not err, err
    ours, theirs = figures(out, "biased.hlsl"), figures(out, "linear")
    by = {row["storage"]: row for row in ours if row["speed"] == 4}
    linear = {row["storage"]: row for row in theirs if row["speed"] == 4}
    assert by["rg16"]["error_mean_px"] == pytest.approx(linear["rg16"]["error_mean_px"], rel=1e-3)
    assert by["rg16_snorm"]["error_mean_px"] / linear["rg16_snorm"]["error_mean_px"] == pytest.approx(2, rel=0.1)
    assert by["rg16_snorm"]["still_px"] > 0 == linear["rg16_snorm"]["still_px"]


@pytest.mark.parametrize("scale, reach", [(1.0, 1.0), (0.25, 4.0), (1 / 0.4985, 0.4985)])
def test_an_encoding_without_a_range_parameter_has_its_own_range(tmp_path, scale, reach):
    """The range is the motion whose code is 1."""
    file = tmp_path / "own.hlsl"
    file.write_text(
        f"float2 EncodeMotion(float2 v) {{ return v * {scale}; }}"
        f"float2 DecodeMotion(float2 e) {{ return e / {scale}; }}"
    )
    (code,) = own_codes_named(MOTION, str(file), MOTION_ENCODINGS)
    assert code.own_range == pytest.approx(reach, rel=1e-3)
    assert not code.is_unit


def test_range_of_a_clipping_encoder_is_the_range_that_round_trips(tmp_path):
    file = tmp_path / "own.hlsl"
    file.write_text(
        "float2 EncodeMotion(float2 v) { return saturate(v * 2 + 0.5); }"
        "float2 DecodeMotion(float2 e) { return (e - 0.5) / 2; }"
    )
    look = own_code(MOTION, file).found
    assert look["own_range"] == pytest.approx(0.25, rel=2e-3) and look["is_unit"] and not look["wrong"]


PAIR = "float2 DecodeVelocity(float2 e) { return e; }"


# What each file is refused for.
BROKEN = {
    "float2 EncodeVelocity(float2 v) { return v * q; }" + PAIR: r"1:46: undefined identifier 'q'",
    "float2 EncodeVelocity(float2 v) { return v; }": "EncodeVelocity has no decoder",
    "float2 EncodeVelocity(float2 v) { while (v.x < 9) v.y += 1, v.x = min(v.x, 5); return v; }" + PAIR: (
        r"the loops of encode for .* do not end here"
    ),
    "float2 EncodeVelocity(float2 v) { return normalize(v) * sqrt(length(v)); }" + PAIR: (
        r"encode returns no number for \(0, 0\)"
    ),
    "float3 EncodeVelocity(float3 v) { return v; } float3 DecodeVelocity(float3 v) { return v; }": (
        "have the wrong types for motion vectors"
    ),
    "uint EncodeVelocity(float2 v) { return 0; } float2 DecodeVelocity(uint v) { return 0; }": (
        "returns a uint, but a code of motion vectors must be one or more floats"
    ),
    "Texture2D t; float2 EncodeVelocity(float2 v) { return t.Load(0).xy; }" + PAIR: (
        "read a texture or a constant buffer"
    ),
    "float2 EncodeNormal(float3 n) { return n.xy; } float3 DecodeNormal(float2 e) { return 0; }": (
        "EncodeNormal is of normals, not of motion vectors: `normalbench quality --encoding .*mine.hlsl` measures it"
    ),
    "float PackRoughness(float r) { return r; } float UnpackRoughness(float r) { return r; }": (
        "is of roughness and the like, not of motion vectors: `normalbench curves --encoding .*mine.hlsl` measures it"
    ),
}


@pytest.mark.parametrize("text", BROKEN)
def test_unmeasurable_file_is_a_one_line_error_and_others_are_measured(run, tmp_path, text):
    file = tmp_path / "mine.hlsl"
    file.write_text(text)
    with pytest.raises(UsageError, match=BROKEN[text]):
        own_code(MOTION, file)
    if PAIR in text:
        status, out, err = run(*VECTORS, "--encoding", f"{file},linear", "--storage", "rg8")
        assert status == 0 and f"left out: {file}" in err
        assert {row["encoding"] for row in json.loads(out)} == {"linear"}


def test_pair_that_round_trips_is_chosen_from_several(tmp_path):
    file = tmp_path / "mine.hlsl"
    names = {"EncodeMotionA": "v", "DecodeMotionA": "2 * v", "EncodeMotionB": "v * 0.5", "DecodeMotionB": "v * 2"}
    file.write_text("".join(f"float2 {name}(float2 v) {{ return {body}; }}\n" for name, body in names.items()))
    assert own_code(MOTION, file).made.named == "EncodeMotionB:DecodeMotionB"
    assert own_code(MOTION, f"{file}:EncodeMotionA:DecodeMotionB").found["error_max"] == 1


def test_jax_rows_require_a_twin(run):
    """Without a twin the rows are left out with a message, as for normals."""
    words = ("--storage", "rg16", "--speed", "1", "--count", "64")
    status, out, err = run("vectors", "--encoding", str(INPUTS / "velocity.wgsl"), *words)
    assert status == 0 and "jax" not in out
    assert "measured only by OpenGL: velocity.wgsl has no Python twin" in err
    status, _, err = run("vectors", "--encoding", str(INPUTS / "velocity.wgsl"), *words, "--backend", "jax")
    assert status == 2 and "velocity.wgsl has no Python twin" in err


@pytest.mark.parametrize("ending", ["hlsl", "slang", "glsl", "wgsl"])
def test_a_copy_of_a_depth_encoding_has_the_same_rows(run, ending):
    """Each file is the catalogue's `window`, with the planes after the depth, before it or in a structure."""
    file = INPUTS / f"depth.{ending}"
    words = ("--storage", "depth16,packed24,r16f", "--rebuild", "eye_ray", "--near", "0.1", "--distance", "1,100")
    words += ("--count", "256", "--backend", "glsl", "--format", "json")
    status, out, err = run("depth", "--depth", f"{file},window", *words)
    assert status == 0 and not err, err
    rows = {name: [row for row in json.loads(out) if row["depth"] == name] for name in (file.name, "window")}
    assert len(rows["window"]) == 9
    for ours, theirs in zip(rows[file.name], rows["window"], strict=True):
        assert ours["error_max"] == theirs["error_max"] and ours["error_mean"] == theirs["error_mean"]
        assert ours["bound"] is None and theirs["bound"] > 0


def test_depth_code_without_planes_is_measured_in_its_own_range(run, tmp_path):
    (tmp_path / "own.hlsl").write_text(
        "float EncodeDepth(float d) { return saturate((d - 2.0) / 248.0); }"
        "float DecodeDepth(float e) { return e * 248.0 + 2.0; }"
    )
    (tmp_path / "units.hlsl").write_text(
        "float EncodeDepth(float d) { return d; } float DecodeDepth(float e) { return e; }"
    )
    files = [tmp_path / "own.hlsl", tmp_path / "units.hlsl"]
    words = ("--near", "2", "--far", "250", "--count", "64", "--backend", "glsl", "--format", "json")
    status, out, err = run("depth", "--depth", ",".join(map(str, files)), *words)
    assert status == 0, err
    # Within a hundredth of its planes.
    assert re.search(r"own.hlsl: it round-trips for depths from (1.9[89]|2) to 25[0-2]", err), err
    assert "units.hlsl: its codes exceed 1: only float storages hold them" in err
    storages = {name: {row["storage"] for row in json.loads(out) if row["depth"] == name} for name in OWN_DEPTHS}
    assert storages == OWN_DEPTHS
    # 24 bits of a range of 248: half a step is 7.4e-6, along a ray of at most 1.57; and float32 adds 250 2^-23 a step.
    (row,) = (r for r in json.loads(out) if (r["depth"], r["storage"], r["distance"]) == ("own.hlsl", "packed24", 10))
    assert 5e-6 < row["error_max"] < 4e-5


OWN_DEPTHS = {"own.hlsl": set(DEPTH_STORAGES), "units.hlsl": {"r16f", "r32f"}}


@pytest.mark.parametrize("ending", ["hlsl", "slang", "glsl", "wgsl"])
def test_a_copy_of_a_curve_decodes_to_the_same_quantities(ending):
    """Each file is the catalogue's `squared`: in half types, with an out parameter, with or without a range."""
    (ours, theirs) = own_codes_named(CURVE, f"{INPUTS / f'roughness.{ending}'},squared", CURVE_ENCODINGS)
    given = np.linspace(0, 1, 4096, dtype=np.float32).reshape(64, 64)
    for name in ("r8", "r16", "r16f", "rgba8_snorm"):
        decoded = []
        for encoding in (ours, theirs):
            with CurvePasses(device(), CurveCodec(encoding, CURVE_STORAGES[name])) as passes:
                decoded.append(passes.round_trip(np.stack([given, 0 * given], axis=-1)))
        np.testing.assert_array_equal(*decoded)
    assert ours.storages == CURVE_ENCODINGS["linear"].storages and ours.inverse_error < 1e-6


def test_curve_that_leaves_its_range_or_moves_its_ends_is_reported(tmp_path):
    file = tmp_path / "own.hlsl"
    file.write_text(
        "float EncodeRoughness(float r) { return 0.9999 * r * 1.5 + 0.0001; }"
        "float DecodeRoughness(float e) { return (e - 0.0001) / 1.5; }"
    )
    look = own_code(CURVE, file).found
    (wrong,) = look["wrong"]
    assert wrong == "component 1 of the code leaves [0, 1], the range of fixed-point storages: 1.5 for 1"
    assert [line.split(",")[0] for line in look["notes"]] == ["1 is not exact"]


LIGHTS = ("lights", "--sum", "1,4", "--counts", "8", "--format", "json")


# What rows by the model alone have.
OF_MODEL = {"model", "error", "model_rms", "model_max", "bound", "rounds", "agree_percent"}


def lit(out: str, name: str) -> list[dict]:
    """Return the device's figures in the rows of a light buffer."""
    rows = [row for row in json.loads(out) if row["light_buffer"] == name]
    return [{key: value for key, value in row.items() if key not in {*OF_MODEL, "light_buffer"}} for row in rows]


@pytest.mark.parametrize("ending", ["hlsl", "slang", "frag", "wgsl"])
def test_a_copy_of_a_light_encoding_has_the_same_rows_on_the_device(run, ending):
    """Each file is the catalogue's RGBM; without a twin it has no model."""
    file = INPUTS / f"light.{ending}"
    status, out, err = run(*LIGHTS, "--experiment", "equal,random", "--light-buffer", f"{file},rgbm")
    assert status == 0 and not err, err
    assert len(lit(out, "rgbm")) == 5 and lit(out, file.name) == lit(out, "rgbm")
    assert {row["model"] for row in json.loads(out) if row["light_buffer"] == file.name} == {None}
    (ours,) = light_codecs_named(str(file))
    theirs = LIGHT_BUFFERS["rgbm"]
    assert (ours.blend, ours.has_alpha, ours.storage) == (theirs.blend, theirs.has_alpha, theirs.storage)
    assert ours.limit == pytest.approx(theirs.limit, rel=0.03)


BLENDED = {
    "l / 4": ("e * 4", "rgba8", "add", 4.0),
    "exp2(-l)": ("-log2(max(e, 1.0 / 255.0))", "rgba8", "multiply", 8.0),
    "sqrt(l / 2)": ("e * e * 2", "rgba8", "read", 2.0),
    "l * 8": ("e / 8", "rgba16f", "add", 65504.0),
}


@pytest.mark.parametrize("encode", BLENDED)
def test_blending_of_texels_is_detected(tmp_path, encode):
    """Texels are added as codes, multiplied as codes or added as lights; the largest light is also found."""
    decode, storage, blend, limit = BLENDED[encode]
    file = tmp_path / "own.hlsl"
    file.write_text(
        f"float4 EncodeLight(float4 l) {{ return {encode}; }} float4 DecodeLight(float4 e) {{ return {decode}; }}"
    )
    (codec,) = light_codecs_named(str(file))
    assert (codec.storage.name, codec.blend, codec.has_alpha) == (storage, blend, True)
    assert codec.limit == pytest.approx(limit, rel=0.05)


def test_glowing_cleared_texel_is_reported(tmp_path):
    file = tmp_path / "own.hlsl"
    file.write_text(
        "float3 EncodeLight(float3 l) { return (l + 0.5) / 8; } float3 DecodeLight(float3 e) { return e * 8 - 0.5; }"
    )
    wrong = own_code(LIGHT, file).found["wrong"]
    assert wrong == ["a cleared texel (0 in all channels) decodes to a light of 0.5, not 0"]


FRAMES = ("frames", "--count", "4096", "--backend", "glsl", "--format", "json")


@pytest.mark.parametrize("ending", ["hlsl", "slang", "glsl", "wgsl"])
def test_a_copy_of_a_tangent_frame_encoding_has_the_same_rows(run, ending):
    """Each file is the catalogue's `hexadecachoral`: with vectors and handedness, with structures, with three
    vectors in [0, 1], or with a quaternion without handedness, which describes only a rotation."""
    file = INPUTS / f"frame.{ending}"
    status, out, err = run(*FRAMES, "--encoding", f"{file},hexadecachoral", "--storage", "rgb10a2,rgba16,rgba8")
    assert status == 0 and ("its decoder returns no handedness" in err) == (ending == "wgsl"), err
    rows = {name: [r for r in json.loads(out) if r["encoding"] == name] for name in (file.name, "hexadecachoral")}
    assert len(rows["hexadecachoral"]) == 3
    storages = {name: {r["storage"]: r for r in some} for name, some in rows.items()}
    for storage, theirs in storages["hexadecachoral"].items():
        ours = storages[file.name][storage]
        angles = {key for key in theirs if key.startswith(("normal", "tangent", "rotation")) and theirs[key]}
        assert len(angles) == 9
        assert {key: ours[key] for key in angles} == pytest.approx({key: theirs[key] for key in angles}, rel=1e-3)
        if ending != "wgsl":
            assert ours["codes"] == theirs["codes"] and ours["hands_lost"] == 0
        else:
            assert ours["codes"] * 2 == theirs["codes"] and ours["hands_lost"] is None


def test_usual_storages_fit_the_encoding(tmp_path):
    """Two bits suit only a number with few values, but the fourth number of this code has many."""
    file = tmp_path / "own.hlsl"
    file.write_text(
        "float4 EncodeRotation(float4 q) { return q; } float4 DecodeRotation(float4 q) { return normalize(q); }"
    )
    (code,) = own_codes_named(FRAME, str(file), FRAME_ENCODINGS)
    assert "rgba8_snorm" in code.storages and not {"rgb10a2", "rgba8_10_10_11_1"} & set(code.storages)
    assert code.levels == (0, 0, 0, 0) and not code.is_unit


def test_flipped_handedness_is_reported(tmp_path):
    file = tmp_path / "own.hlsl"
    text = (INPUTS / "frame.hlsl").read_text()
    file.write_text(text.replace("e.w >= 0.0 ? 1.0 : -1.0", "e.w >= 0.0 ? -1.0 : 1.0"))
    assert own_code(FRAME, file).found["wrong"] == ["100% of the tangent frames decode with the opposite handedness"]


def test_swapped_axes_are_reported(tmp_path):
    file = tmp_path / "own.hlsl"
    text = (INPUTS / "frame.hlsl").read_text()
    file.write_text(text.replace("PackFrame(float3 normal, float3 tangent", "PackFrame(float3 tangent, float3 normal"))
    # Both are called by their names: this is no mistake.
    assert own_code(FRAME, file).found["wrong"] == []
    file.write_text(text.replace("Quaternion(normal, tangent)", "Quaternion(tangent, normal)"))
    (wrong,) = own_code(FRAME, file).found["wrong"]
    assert "encode and decode do not undo each other" in wrong and " degrees, " in wrong


@pytest.mark.parametrize(
    "name, kind",
    [
        ("EncodeVelocity", "motion"),
        ("pack_tbn", "tangent frame"),
        ("QuatToCode", "tangent frame"),
        ("encodeLinearDepth", "depth"),
        ("PackRough", "curve"),
        ("EncodeHDR", "light"),
        ("EncodeRGBM", "light"),
        ("PassThroughEncode", ""),
        ("EncodeEquatorial", ""),
        ("EncodeSlightly", ""),
        ("EncodeNormal", ""),
    ],
)
def test_kind_of_a_function_follows_from_its_name(name, kind):
    assert kind_spoken_of(name) is BY_NAME.get(kind)


def test_two_curves_in_a_file_require_a_choice(tmp_path):
    file = tmp_path / "mine.hlsl"
    text = "float EncodeX(float r) { return r * r; } float DecodeX(float e) { return sqrt(e); }"
    file.write_text(text.replace("X", "Roughness") + text.replace("X", "Metalness"))
    with pytest.raises(UsageError, match=r"2 of its pairs round-trip; name one: .*EncodeRoughness:DecodeRoughness"):
        own_code(CURVE, file)
    (code,) = own_codes_named(CURVE, f"{file}:EncodeMetalness:DecodeMetalness", CURVE_ENCODINGS)
    assert code.name == "mine.hlsl:EncodeMetalness"


def test_format_applies_only_to_light_buffers(run):
    status, _, err = run(*VECTORS, "--encoding", f"{INPUTS / 'velocity.hlsl'}:format=rg16f")
    assert status == 2 and "format applies only to light buffers; for others use --storage" in err


def test_wgsl_structures_are_bound(tmp_path):
    """Other fields of a structure are set to 0.5, as in other languages."""
    file = tmp_path / "mine.wgsl"
    file.write_text(
        "struct Motion { weight: f32, v: vec2f }\n"
        "struct Back { v: vec2f }\n"
        "fn encode_velocity(m: Motion) -> vec2f { return m.v * (0.5 * m.weight); }\n"
        "fn decode_velocity(e: vec2f) -> Back { return Back(e * 4.0); }\n"
    )
    look = own_code(MOTION, file).found
    assert look["error_max"] == 0 and look["own_range"] == pytest.approx(4)
