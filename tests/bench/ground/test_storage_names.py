"""Storages defined by their bits: catalogue names if they match, ranges, and impossible storages."""

import pytest
from typed import roundings_named, storages_named

from normalbench.bench.door.python.codecs import codec_of
from normalbench.bench.ground.options.option import fields_of
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import (
    CURVE_ENCODINGS,
    ENCODINGS,
    FRAME_ENCODINGS,
    LIGHT_ENCODINGS,
    MOTION_ENCODINGS,
)
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.codecs.light_codec import LightCodec
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.rules import rule_of, storage_of
from normalbench.encodings.storages.storage import DITHERED, MOTION_STORAGES, ROUNDINGS_AND_DITHERED, STORAGES


@pytest.mark.parametrize(
    "said, names",
    [
        ("unorm:8:8,snorm:16:16,unorm:10:10:10:2", "rg8 rg16_snorm rgb10a2"),
        ("unorm:9:7", "rg8_9_7"),
        ("10:10,5:6:5", "rgb8_10_10 rgb565"),
        ("snorm:7:7", "rg8_7_7_snorm"),
        ("unorm:12:12:7:1", "rgba8_12_12_7_1"),
        ("unorm:6:6..9:9", "rg8_6_6 rg8_7_7 rg8 rgb8_9_9"),
        ("unorm:10:10:2..12:12:4", "rgb8_10_10_2 rgba8_11_11_3 rgba8_12_12_4"),
        ("rg8,unorm:8:8", "rg8"),
        ("centred:8:8,rg16_centred", "rg8_centred rg16_centred"),
        ("UNORM:9:7", "rg8_9_7"),
        ("unorm:8:8:4..10:10:4", "rgb8_8_8_4 rgb8_9_9_4 rgb8_10_10_4"),
        ("unorm:8,unorm:5", "r8 r8_5"),
        ("unorm:20:20:20:4", "rgba16_20_20_20_4"),
        ("uint:8:8,sint:8:8", "r16_uint_8_8 r16_uint_8_8_snorm"),
        ("uint:16:16,r32_uint_16_16,uint:4:3", "r32_uint_16_16 r8_uint_4_3"),
        ("uint:16:16:16", "rgb16_16_16_16"),
        ("snorm_full:8:8,snorm_gl2:8:8", "rg8_8_8_snorm_full rg8"),
        ("float:5:10,float:8:23,float:8:7,ufloat:5:6", "rgba16f rgba32f float_8_7 ufloat_5_6"),
        ("float:5:2..5:4", "float_5_2 float_5_3 float_5_4"),
        # As APIs print formats, also such that the catalogue has no name for.
        ("R16G16_SNORM,DXGI_FORMAT_R10G10B10A2_UNORM", "rg16_snorm rgb10a2"),
        ("snorm10-10-10-2,unorm10-10-10-2", "rgba8_10_10_10_2_snorm rgb10a2"),
        ("unorm8x4,snorm16x2,float16x2,float32x4", "rgba8 rg16_snorm rg16f rgba32f"),
        ("B5G6R5_UNORM_PACK16,unorm:5:6:5", "rgb565"),
    ],
)
def test_bits_name_a_storage(said, names):
    assert " ".join(storage.name for storage in storages_named(said)) == names


@pytest.mark.parametrize("storage", [*STORAGES.values(), *MOTION_STORAGES.values()], ids=lambda s: s.name)
def test_every_storage_has_a_name_by_its_bits(storage):
    """The rule names the storage, or a storage with the same numbers: `rg16f` has two of the four of `rgba16f`."""
    if storage.name != "r11g11b10f":
        parsed = storage_of(rule_of(storage))
        assert (parsed.kind, parsed.is_centred, parsed.is_full) == (storage.kind, storage.is_centred, storage.is_full)
        assert parsed.bits[: storage.channels] == storage.bits


@pytest.mark.parametrize(
    "said, message",
    [
        ("unorm:0:8", "unorm:0:8: expected one to four components of 1 to 20 bits"),
        ("unorm:33:2", "unorm:33:2: expected one to four components of 1 to 20 bits"),
        ("unorm:20:20:20:20", "64 bits in total"),
        ("unorm:8:8..6:6", "the bit counts must grow equally or not at all, as in unorm:4:4..16:16"),
        ("unorm:8:8..10:12", "the bit counts must grow equally"),
        ("unorm:8:8..10", "the bit counts must grow equally"),
        ("centred:9:7", "centred numbers need a GPU format, such as centred:8:8, not 9:7"),
        ("unorms:8:8", "unknown storage 'unorms:8:8'"),
        ("snorm:1:8", "snorm:1:8: a signed component needs at least 2 bits"),
        ("unorm:8:8..", "write bits as unorm:9:7"),
        ("float:5", "float:EXPONENT:MANTISSA, of 2 to 8 and of 1 to 23 bits, such as float:5:10, not float:5"),
        ("float:9:10", "not float:9:10"),
        ("rg9", "unknown storage 'rg9'"),
    ],
)
def test_an_impossible_storage_is_a_one_line_error(said, message):
    with pytest.raises(UsageError, match=message):
        storages_named(said)


def test_python_takes_one_codec_at_a_time():
    with pytest.raises(UsageError, match="names 3 codecs; name exactly one"):
        codec_of("octahedral/unorm:4:4..6:6")


@pytest.mark.parametrize(
    "encoding, said, name, sizes",
    [
        ("octahedral", "float:5:10", "rg16f", (16, 16)),
        ("xyz", "float:5:10", "rgba16f", (16, 16, 16, 16)),
        ("octahedral", "float:8:23", "rg32f", (32, 32)),
        ("octahedral", "float:4:3", "float_4_3", (8, 8)),
        ("xyz", "float_4_3", "float_4_3", (8, 8, 8)),
        ("octahedral", "rgba16f", "rgba16f", (16, 16, 16, 16)),
    ],
)
def test_floats_have_as_many_components_as_the_encoding(encoding, said, name, sizes):
    """A format that is given by name keeps its own number of components."""
    (storage,) = storages_named(said)
    stored = Codec(ENCODINGS[encoding], storage).storage
    assert (stored.name, stored.bits) == (name, sizes)


def test_floats_have_as_many_components_as_an_encoding_of_any_kind():
    (storage,) = storages_named("float:5:10")
    assert CurveCodec(CURVE_ENCODINGS["linear"], storage).storage.name == "r16f"
    assert MotionCodec(MOTION_ENCODINGS["linear"], storage).storage.name == "rg16f"
    assert FrameCodec(FRAME_ENCODINGS["qtangent"], storage).storage == STORAGES["rgba16f"]
    assert LightCodec(LIGHT_ENCODINGS["plain"], storage).storage == STORAGES["rgba16f"]


def test_the_error_about_dithering_names_the_tables_that_support_it():
    for table in ("quality", "render"):
        assert DITHERED in fields_of(TABLES[table].options)["rounding"].option.help
    assert roundings_named("nearest,dithered", ROUNDINGS_AND_DITHERED) == ["nearest", DITHERED]
    with pytest.raises(UsageError, match=r"^--rounding dithered: .* use quality or render$"):
        roundings_named("nearest, dithered")
