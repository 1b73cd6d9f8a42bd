"""Storages by rule: the catalogue's where there is one, ranges, and what cannot be."""

import json

import pytest

from normalbench.bench.door.python.codecs import codec_of
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.names import storages_named


@pytest.mark.parametrize(
    "said, names",
    [
        ("unorm:8:8,snorm:16:16,unorm:10:10:10:2", "rg8 rg16_snorm rgb10a2"),
        ("unorm:9:7", "rg8_9_7"),
        ("snorm:7:7", "rg8_7_7_snorm"),
        ("unorm:12:12:7:1", "rgba8_12_12_7_1"),
        ("unorm:6:6..9:9", "rg8_6_6 rg8_7_7 rg8 rgb8_9_9"),
        ("unorm:10:10:2..12:12:4", "rgb8_10_10_2 rgba8_11_11_3 rgba8_12_12_4"),
        ("rg8,unorm:8:8", "rg8"),
        ("centred:8:8,rg16_centred", "rg8_centred rg16_centred"),
    ],
)
def test_bits_name_a_storage(said, names):
    assert " ".join(storage.name for storage in storages_named(said)) == names


@pytest.mark.parametrize(
    "said, message",
    [
        ("unorm:0:8", "numbers of 1 to 20 bits, 32 altogether, not 0:8"),
        ("unorm:33:2", "numbers of 1 to 20 bits, 32 altogether, not 33:2"),
        ("unorm:16:17", "32 altogether, not 16:17"),
        ("unorm:8", "two to four numbers"),
        ("unorm:8:8..6:6", "each number grows by as many bits, as in unorm:4:4..16:16"),
        ("unorm:8:8..10:12", "each number grows by as many bits"),
        ("unorm:8:8..10", "each number grows by as many bits"),
        ("centred:9:7", "centred numbers lie in a format of a GPU, such as centred:8:8, not 9:7"),
        ("unorms:8:8", "unknown storage 'unorms:8:8'"),
        ("snorm:1:8", "a signed number has at least 2 bits, not 1:8"),
        ("UNORM:9:7", "bits are said as unorm:9:7"),
        ("unorm:8:8..", "bits are said as unorm:9:7"),
        ("float:5:10", "bits are said as unorm:9:7"),
    ],
)
def test_what_cannot_be_is_a_line(said, message):
    with pytest.raises(UsageError, match=message):
        storages_named(said)


def test_centred_numbers_are_measured_and_not_written_or_laid_out(run):
    """In both languages: axes are exact, as in SNORM, and in a UNORM target. What cannot have them says so."""
    words = ("--encoding", "octahedral", "--storage", "centred:8:8", "--format", "json")
    status, out, err = run("quality", *words, "--normals", "axes")
    assert status == 0 and {row["backend"] for row in json.loads(out)} == {"jax", "glsl"}, err
    assert all(row["angle_max_deg"] < 1e-4 and row["storage"] == "rg8_centred" for row in json.loads(out))
    status, _, err = run("render", "--scene", "gloss", *words)
    assert status == 2 and err == "normalbench: layout fp32: RG8 centred: a layout keeps no centred numbers\n"
    status, _, err = run("code", "octahedral", "--storage", "centred:8:8")
    assert status == 2 and err.count("\n") == 1 and "code writes none" in err


def test_python_takes_one_codec_at_a_time():
    with pytest.raises(UsageError, match="one codec at a time, not 3"):
        codec_of("octahedral/unorm:4:4..6:6")
