"""Generated code of whole layouts, compared with the renderer's own GLSL."""

import re

import pytest
from pasted import LONGEST, loops_without_unrolling, names_in
from typed import layouts_named

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.fold import WIDTH, folded
from normalbench.bench.shaders.code.whole.bits import packed_texts, parts_of, taken_text
from normalbench.bench.shaders.code.whole.emit import gbuffer_code
from normalbench.bench.shaders.code.whole.head import table
from normalbench.bench.shaders.code.whole.surface import Contents
from normalbench.encodings.storages.storage import TARGET_FORMATS
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import Word

pytestmark = pytest.mark.usefixtures("gl")


# As `budget --layouts` writes them, into whole numbers.
WORDS = """
title = "16 bytes"
encoding = "octahedral"
space = "world"

[[targets]]
format = "rg32_uint"
holds = "normal.x:12 normal.y:12 square_root(roughness):8 metallic:5 square_root(base_color.r):7 \
square_root(base_color.g):7 square_root(base_color.b):6 linear:0.08(f0):4 other:3"

[[targets]]
format = "r32_uint"
holds = "sqrt(motion.x):14 sqrt(motion.y):14 other:4"

[[targets]]
format = "rgba8"
holds = "ao other shading_model:4 other:12"
"""


SIGNED = """
encoding = "xyz_renormalised"
packing = "signed"

[[targets]]
format = "r32_uint"
holds = "normal.x:10 normal.y:11 normal.z:10 other:1"

[[targets]]
format = "rgba16_uint"
holds = "albedo:9 roughness:12 metalness:11 instance:8 other:6"

[[targets]]
format = "r11g11b10f"
holds = "emission"

[[targets]]
format = "rg16_snorm"
holds = "motion.x motion.y"

[[targets]]
format = "rgb10a2"
holds = "occlusion:7 other:9 other:14 other"
"""


# A sign in a depth of 24 bits, which lies across the bytes of two targets' formats; a sign in the roughness, on a curve
# and in bits; a logarithmic depth, tables and a view.
DEPTH_SIGN = """
encoding = "signed_octahedral"

[[targets]]
format = "rg16"
holds = "normal.x normal.y"

[[targets]]
format = "rgba8"
holds = "depth*normal.z:24 roughness"
"""


ROUGHNESS_SIGN = """
encoding = "signed_octahedral"

[[targets]]
format = "r32_uint"
holds = "normal.x:10 normal.y:10 squared(roughness)*normal.z:9 other:3"

[[targets]]
format = "rgba16f"
holds = "depth albedo"
"""


PLANES = """
encoding = "spherical_lut"
depth = "logarithmic"

[[targets]]
format = "rgba8"
holds = "depth:24 roughness"

[[targets]]
format = "rgba16"
holds = "normal.x normal.y metalness occlusion"
"""


SEEN = """
encoding = "per_pixel_view"
depth = "window"

[[targets]]
format = "rg16f"
holds = "normal.x normal.y"

[[targets]]
format = "rg32_uint"
holds = "depth:24 roughness:8 metalness:8 other:24"
"""


HALVES = """
encoding = "octahedral"
rounding = "truncate_half"

[[targets]]
format = "rgba16"
holds = "normal.x normal.y roughness metalness"

[[targets]]
format = "rgba16f"
holds = "albedo occlusion"
"""


FILES = {
    "halves": HALVES,
    "words": WORDS,
    "signed": SIGNED,
    "depth_sign": DEPTH_SIGN,
    "roughness_sign": ROUGHNESS_SIGN,
    "planes": PLANES,
    "seen": SEEN,
}


PRESETS = ("unreal4", "bevy", "unity_hdrp", "nrd", "xy_depth_sign", "cryengine3", "wicked_truncated")


@pytest.fixture
def layouts(tmp_path) -> dict:
    """Layouts by name, from presets and files."""
    for name, text in FILES.items():
        (tmp_path / f"{name}.toml").write_text(text)
    named = layouts_named(",".join(str(tmp_path / f"{name}.toml") for name in FILES))
    return {layout.name: layout for layout in (*named, *(LAYOUTS[name] for name in PRESETS))}


@pytest.mark.parametrize("language", LANGUAGES)
def test_lines_and_names_are_short(language, layouts):
    """Lines have at most 99 characters and names 24; loops over constants are unrolled. Layouts take the languages in
    turn, and nightly tests check all languages."""
    names = [*LANGUAGES]
    check_short(
        [layout for turn, layout in enumerate(layouts.values()) if names[turn % len(names)] == language], language
    )


def check_short(several, language) -> None:
    """Check every line, name and loop of the code of some layouts."""
    assert several
    for layout in several:
        body = gbuffer_code(layout, language).body
        assert max(map(len, body.splitlines())) <= WIDTH, max(body.splitlines(), key=len)
        names = names_in(body)
        assert len(max(names, key=len)) <= LONGEST, max(names, key=len)
        assert language != "hlsl" or not loops_without_unrolling(body)


def test_words_that_cross_channels_round_trip():
    """Integers across 8-bit and 16-bit channels are unpacked unchanged, and no other bits are affected."""
    words = [Word("a", 0, 0, 11), Word("b", 0, 11, 10), Word("c", 0, 21, 11)]
    given = {"a": 0b10110011101, "b": 0b1100101011, "c": 0b01110001101}
    for name, size in (("rgba8_uint", 8), ("rg16_uint", 16), ("r32_uint", 32)):
        storage = TARGET_FORMATS[name]
        held, read = {}, {word: [] for word in words}
        for channel in range(32 // size):
            parts = list(parts_of(words, channel, storage))
            text = " | ".join(packed_texts([(part, part.word.component) for part in parts], size))
            held[f"t{channel}"] = eval(text.replace("u", ""), dict(given)) & 2**size - 1
            for part in parts:
                read[part.word].append((part, f"t{channel}"))
        for word in words:
            taken = eval(taken_text(read[word], word.bits).replace("u", ""), dict(held))
            assert taken == given[word.component], (size, word)
        whole = sum(held[f"t{channel}"] << 32 - size * (channel + 1) for channel in range(32 // size))
        assert whole == given["a"] << 21 | given["b"] << 11 | given["c"]


@pytest.mark.parametrize(
    "encoding, rounding, why",
    [
        ("octahedral_precise", "nearest", "a normal that is rounded precisely"),
        ("octahedral", "dithered", "a normal that is rounded with noise"),
    ],
)
def test_layout_that_cannot_be_written_is_an_error(encoding, rounding, why, tmp_path):
    target = '[[targets]]\nformat = "rg16"\nholds = "normal.x normal.y"\n'
    (tmp_path / "mine.toml").write_text(f'encoding = "{encoding}"\nrounding = "{rounding}"\n\n{target}')
    (layout,) = layouts_named(str(tmp_path / "mine.toml"))
    with pytest.raises(UsageError, match=f"^layout mine: no code can be written for {why}"):
        Contents(layout)


def test_table_shows_the_target_and_channel_of_each_field(layouts):
    lines = [re.split(r"\s{2,}", line.strip()) for line in table(Contents(layouts["words"]))]
    assert lines[0] == ["target", "format", "bits", "channel", "field", "encoding"]
    assert ["target_0", "rg32_uint", "8", "x 0-7", "roughness", "square_root"] in lines
    assert ["target_2", "rgba8", "12", "z 0-3, w 0-7", "other_4", "unchanged"] in lines
    lines = table(Contents(layouts["unreal4"]))
    assert any("base_color.x" in line and "sRGB, by the format" in line for line in lines)


def test_negative_light_and_nan_are_stored_as_no_light():
    """The renderer does the same before it encodes light."""
    text = gbuffer_code(LAYOUTS["bevy"], "glsl").body
    assert "vec4 emissive = gbuffer_rgb9e5_encode(gbuffer_light_or_none(vec4(s.emissive, 0.0)));" in text


def test_folded_lines_are_the_same_code():
    """Nothing but white space is added."""
    inside = " + ".join(f"f({index}, {index + 1})" for index in range(40))
    for line in (f"    int x = g({inside}, {inside})", f"int x = {' + '.join(['abcdef'] * 30)}"):
        broken = folded(line + "\n")
        assert max(map(len, broken.splitlines())) <= WIDTH
        assert "".join(broken.split()) == "".join(line.split())
