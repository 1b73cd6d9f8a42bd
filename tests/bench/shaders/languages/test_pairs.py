"""The encoder and the decoder in a file, found by their types and their names."""

import tempfile
from pathlib import Path

import pytest
from typed import Source

from normalbench.bench.shaders.languages import slang
from normalbench.bench.shaders.languages.pairs import (
    Function,
    NoPairError,
    Parameter,
    Place,
    SeveralPairsError,
    pair_of,
    role,
    stem,
)

pytestmark = pytest.mark.usefixtures("slang")


OF = "{ return 0; }"


BACK = f"float3 DecodeNormal(float2 e) {OF}"


def functions(text: str) -> list[Function]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mine.hlsl")
        path.write_text(text)
        return list(slang.read(Source(path), Path(folder)).functions)


def pair(text: str, asked=None) -> str:
    return pair_of(functions(text), asked, "mine.hlsl").named


@pytest.mark.parametrize(
    "text, named",
    [
        (f"float2 EncodeNormal(float3 n) {OF} {BACK}", "EncodeNormal:DecodeNormal"),
        (
            f"half2 EncodeNormal(in half3 n : NORMAL, const float3 view) : SV_Target {OF} {BACK}",
            "EncodeNormal:DecodeNormal",
        ),
        (
            f"float2 PackNormalOctRectEncode(float3 n) {OF} float3 UnpackNormalOctRectEncode(float2 f) {OF}",
            "PackNormalOctRectEncode:UnpackNormalOctRectEncode",
        ),
        (f"vector<float, 2> f(vector<float,3> n) {OF} float3 g(float2 e, float3 v) {OF}", "f:g"),
        (f"typedef float3 Normal; float2 oct(Normal n) {OF} Normal ndir(float2 e) {OF}", "oct:ndir"),
        (
            f"float3 PackNormal(float3 n) {OF} float3 UnpackNormal(float3 c) {OF} float3 rotate(float3 v) {OF}",
            "PackNormal:UnpackNormal",
        ),
        (f"func enc(n : float3) -> float2 {{ }} func dec(e : float2) -> float3 {OF}", "enc:dec"),
        (
            f"float2 EncodeNormal(float3 n) {OF} float2 EncodeNormal(float3 n, float3 v) {OF} {BACK}",
            "EncodeNormal:DecodeNormal",
        ),
        (
            f"struct S {{ float2 EncodeOther(float3 n) {OF} }}; float2 EncodeNormal(float3 n) {OF} {BACK}",
            "EncodeNormal:DecodeNormal",
        ),
        (
            f"float2 mine_encode(float3 n) {OF} float3 mine_decode(float2 e) {OF} float2 OctWrap(float2 v) {OF}",
            "mine_encode:mine_decode",
        ),
        (
            f"float2 EncodeNormal(float3 n) {OF} {BACK} void PackNormal(float3 n, out float2 e) {OF}",
            "EncodeNormal:DecodeNormal",
        ),
        (
            f"float3 EncodeColor(float3 c) {OF} float3 DecodeColor(float3 c) {OF} float2 EncodeMotion(float3 v) {OF}"
            f"float3 DecodeMotion(float2 v) {OF} float2 EncodeOct(float3 n) {OF} float3 DecodeOct(float2 e) {OF}",
            "EncodeOct:DecodeOct",
        ),
        (f"float2 NormalToOct(float3 n) {OF} float3 OctToNormal(float2 e) {OF}", "NormalToOct:OctToNormal"),
        (f"float2 oct_from_vec(float3 v) {OF} float3 vec_from_oct(float2 p) {OF}", "oct_from_vec:vec_from_oct"),
        (f"uint PackNormal(float3 n) {OF} float3 UnpackNormal(uint p) {OF}", "PackNormal:UnpackNormal"),
        (
            f"uint PackNormal(float3 n) {OF} float3 UnpackNormal(uint p) {OF}"
            f"float2 OctEncode(float3 n) {OF} float3 OctDecode(float2 e) {OF}",
            "OctEncode:OctDecode",
        ),
    ],
)
def test_the_pair_in_a_file_is_found(text, named):
    assert pair(text) == named


@pytest.mark.parametrize(
    "text, asked, said",
    [
        ("", None, "no encoder and decoder found; the two functions must be float2 (or float3) ENCODE(float3 n)"),
        (f"float2 EncodeNormal(float3 n) {OF}", None, "EncodeNormal has no decoder"),
        (BACK, None, "DecodeNormal has no encoder"),
        (
            f"void EncodeNormal(float3 n, out float2 e) {OF} {BACK}",
            None,
            "EncodeNormal returns nothing; write a function",
        ),
        (
            # A helper that returns the code is not the partner of the decoder by its name.
            f"float2 octEncodeImpl(float3 n) {OF} void PackNormal(in float3 n, out float2 e) {OF} "
            f"float3 UnpackNormal(float2 e) {OF}",
            None,
            "PackNormal returns nothing; write a function that returns the value of the output parameter$",
        ),
        (
            f"float2 PackNormal(float3 n) {OF} void UnpackNormal(float2 e, out float3 n) {OF} "
            f"float3 octDecodeImpl(float2 e) {OF}",
            None,
            "UnpackNormal returns nothing; write a function",
        ),
        (f"uint PackNormal(float3 n) {OF} {BACK}", None, "PackNormal returns a uint, but a code must have two"),
        (
            "".join(f"float2 Encode{x}(float3 n) {OF} float3 Decode{x}(float2 e) {OF}" for x in "AB"),
            None,
            "several encoders; name one: mine.hlsl:EncodeA:DecodeA, mine.hlsl:EncodeB:DecodeB",
        ),
        (
            f"float2 EncodeA(float3 n) {OF} {BACK}",
            ("EncodeA", "DecodeB"),
            "unknown function DecodeB; known: EncodeA, DecodeNormal",
        ),
        (f"float3 EncodeA(float3 n) {OF} {BACK}", ("EncodeA", "DecodeNormal"), "EncodeA must take a float3"),
    ],
)
def test_error_for_a_file_without_a_unique_pair_describes_its_functions(text, asked, said):
    with pytest.raises(NoPairError, match=said.replace("(", r"\(").replace(")", r"\)")):
        pair(text, asked)


def function(name: str, made: int, given: int) -> Function:
    """Return a function that is known only by its types."""
    parameter = Parameter("p", f"float{given}", True, False, False, (Place("p", "float", given),))
    kind, results = f"float{made}", (Place("", "float", made),)
    return Function(name, made, (given,), kind, parameters=(parameter,), results=results)


def many(count: int, decoder: str) -> list[Function]:
    """Return a given number of encoders and of decoders."""
    encoders = [function(f"Encode{number}", 2, 3) for number in range(count)]
    return [*encoders, *(function(decoder.format(number), 3, 2) for number in range(count))]


def test_too_many_functions_without_matching_names_are_refused_early():
    with pytest.raises(SeveralPairsError):
        pair_of(many(100, "UnpackOf{}"), None, "mine.hlsl")
    message = "300 functions may encode and 300 may decode, but no two have matching names; name two: "
    message += "mine.hlsl:ENCODE:DECODE"
    with pytest.raises(NoPairError, match=message):
        pair_of(many(300, "UnpackOf{}"), None, "mine.hlsl")


def test_name_identifies_a_pair_if_types_cannot():
    """An encoder to three numbers has the same types as its decoder."""
    assert [role(name) for name in ("UnpackNormalOctRectEncode", "PackNormalOctRectEncode", "Wrap")] == [
        "decode",
        "encode",
        "",
    ]
    assert stem("UnpackNormalOctRectEncode") == stem("PackNormalOctRectEncode") == "normaloctrect"


def test_types_are_reduced_to_numbers_of_components():
    assert functions(f"min16float2 f(float3 n, uint k) {OF}") == [Function("f", 2, (3, 0))]
