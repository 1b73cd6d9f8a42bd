"""Code of whole layouts: it packs and unpacks what the renderer's own GLSL does."""

import json
import re
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from languages import require_runner
from pasted import LONGEST, loops_without_unrolling, names_in

from normalbench.bench.door import gbuffer_command
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.fold import WIDTH, folded
from normalbench.bench.shaders.code.whole.bits import packed_texts, parts_of, taken_text
from normalbench.bench.shaders.code.whole.emit import gbuffer_code
from normalbench.bench.shaders.code.whole.head import table
from normalbench.bench.shaders.code.whole.surface import Contents
from normalbench.bench.shaders.code.whole.verify import agreement
from normalbench.bench.subjects.codecs.layout_names import layouts_named
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
holds = "normal.x:12 normal.y:12 square_root(roughness):8 metalness:5 square_root(albedo.r):7 \
square_root(albedo.g):7 square_root(albedo.b):6 linear:0.08(reflectance):4 other:3"

[[targets]]
format = "r32_uint"
holds = "sqrt(motion.x):14 sqrt(motion.y):14 other:4"

[[targets]]
format = "rgba8"
holds = "occlusion other kind:4 other:12"
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


FAST, FEW, MANY = ("c",), 2**12, 10**6


# Of the layouts of MANY surfaces: those whose curves have powers, or whose codes have quotients and roots, which
# languages round otherwise, have ties.
TIES = {"unreal4": 1e-4, "bevy": 1e-4, "unity_hdrp": 1e-4, "words": 0.0, "signed": 0.0, "xy_depth_sign": 0.0}


TIES |= {
    "wicked_truncated": 1e-4,
    "halves": 1e-3,
    "cryengine3": 0.0,
    "planes": 1e-4,
    "nrd": 1e-4,
    "roughness_sign": 1e-4,
    "depth_sign": 1e-3,
    "seen": 1e-3,
}


@pytest.fixture
def layouts(tmp_path) -> dict:
    """Layouts by name: presets, and files."""
    for name, text in FILES.items():
        (tmp_path / f"{name}.toml").write_text(text)
    named = layouts_named(",".join(str(tmp_path / f"{name}.toml") for name in FILES))
    return {layout.name: layout for layout in (*named, *(LAYOUTS[name] for name in PRESETS))}


@pytest.mark.parametrize("name, language", [*product(TIES, FAST)])
def test_it_packs_and_unpacks_as_the_renderer_does(name, language, layouts):
    """Bits of every target, and every number that comes back, of surfaces with the ends of each range and beyond."""
    require_runner(language)
    found = agreement(gbuffer_code(layouts[name], language), FEW)
    assert found.holds, found.says
    assert found.differing <= max(TIES[name] * FEW, 2 * (TIES[name] > 0)), found.says


@pytest.mark.parametrize("language", LANGUAGES)
def test_lines_and_names_are_short(language, layouts):
    """Lines have 99 letters at most, names 24, and loops over constants are unrolled. Each layout is written in another
    language than the one before, and at night in all of them."""
    names = [*LANGUAGES]
    check_short(
        [layout for turn, layout in enumerate(layouts.values()) if names[turn % len(names)] == language], language
    )


def check_short(several, language) -> None:
    """Every line, name and loop of the code of some layouts."""
    assert several
    for layout in several:
        body = gbuffer_code(layout, language).body
        assert max(map(len, body.splitlines())) <= WIDTH, max(body.splitlines(), key=len)
        names = names_in(body)
        assert len(max(names, key=len)) <= LONGEST, max(names, key=len)
        assert language != "hlsl" or not loops_without_unrolling(body)


# Code of layouts by name: each fault is looked for in one after the other.
WRITTEN = {}


def written_in_c(name, layout):
    """The code of a layout, written once."""
    if name not in WRITTEN:
        WRITTEN[name] = gbuffer_code(layout, "c")
    return WRITTEN[name]


@pytest.mark.parametrize(
    "old, new",
    [
        ("normal_x_bits << 20", "normal_x_bits << 19"),
        ("* 8191.0f) + 8191.0f", "* 8191.0f) + 8190.0f"),
        ("(kind_bits << 4)", "(kind_bits << 3)"),
        ("/ 31.0f", "/ 32.0f"),
        (">> 27", ">> 26"),
        ("sign_bit(signed_depth) ? -1.0f", "sign_bit(signed_depth) ? 1.0f"),
        ("normal.z * s.depth", "s.depth"),
        ("fixed_code(depth_number, 16777215.0f, true)", "fixed_code(depth_number, 16777215.0f, false)"),
        ("sign_not_zero(signed_roughness)", "sign_not_zero(-signed_roughness)"),
        ("normal.z) * gbuffer_min(", "normal.x) * gbuffer_min("),
        ("depth_or_far(s.depth, far_), near_, far_)", "depth_or_far(s.depth, far_), far_, near_)"),
        (
            "round_float(normal.x * 0.5f + 0.5f, 5, 6, false, true",
            "round_float(normal.x * 0.5f + 0.5f, 5, 6, false, false",
        ),
        ("65535.0f, 2) / 65535.0f", "65535.0f, 1) / 65535.0f"),
        ("gbuffer_scale[", "1 + gbuffer_scale["),
        ("s.normal.z}, view)", "s.normal.z}, (gbuffer_vec3){view.y, view.x, view.z})"),
    ],
)
def test_a_fault_is_noticed(old, new, layouts):
    """In the first layout that has such a line."""
    require_runner("c")
    words_first = {"words": layouts["words"]} | layouts
    codes = (written_in_c(name, layout) for name, layout in words_first.items())
    code = next(code for code in codes if old in code.body)
    assert not agreement(replace(code, body=code.body.replace(old, new)), FEW).holds


def test_a_width_in_the_file_changes_both_functions(tmp_path):
    """Roughness of 8 bits becomes one of 7 with a bit beside it: the code changes, and still agrees."""
    require_runner("c")
    bodies = []
    for name, text in (("eight", WORDS), ("seven", WORDS.replace("(roughness):8", "(roughness):7 other:1"))):
        (tmp_path / f"{name}.toml").write_text(text)
        (layout,) = layouts_named(str(tmp_path / f"{name}.toml"))
        code = gbuffer_code(layout, "c")
        assert (found := agreement(code, FEW)).differing == 0, found.says
        bodies.append(code.body)
    for function in ("gbuffer_targets gbuffer_pack(", "gbuffer_surface gbuffer_unpack("):
        parts = [body.partition(function)[2].partition("\n}")[0] for body in bodies]
        assert "255.0" in parts[0] and "127.0" in parts[1] and parts[0] != parts[1]


def test_what_a_layout_calls_by_a_name_is_called_so(tmp_path):
    """Unless the name is a word of some language, another field's, or there twice: it then has a number."""
    require_runner("c")
    words = "other.flags:4 other.half:4 other.roughness:4 other.lit:2 other.lit:2"
    (tmp_path / "mine.toml").write_text(WORDS.replace("occlusion other kind:4 other:12", f"occlusion {words} kind:8"))
    (layout,) = layouts_named(str(tmp_path / "mine.toml"))
    names = [field.name for field in Contents(layout).fields if field.components == (field.name,)]
    assert {"flags", "half_4", "roughness_5", "lit_6", "lit_7", "other_1", "other_2"} <= {*names}, names
    assert (found := agreement(gbuffer_code(layout, "c"), FEW)).differing == 0, found.says


def test_words_that_cross_channels_come_back():
    """Integers across channels of 8 and of 16 bits: what is put is what is taken, and nothing else is touched."""
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
def test_what_is_not_written_is_one_line(encoding, rounding, why, tmp_path):
    target = '[[targets]]\nformat = "rg16"\nholds = "normal.x normal.y"\n'
    (tmp_path / "mine.toml").write_text(f'encoding = "{encoding}"\nrounding = "{rounding}"\n\n{target}')
    (layout,) = layouts_named(str(tmp_path / "mine.toml"))
    with pytest.raises(UsageError, match=f"^layout mine: no code is written for {why}"):
        Contents(layout)


def test_the_table_says_where_each_field_lies(layouts):
    lines = [re.split(r"\s{2,}", line.strip()) for line in table(Contents(layouts["words"]))]
    assert lines[0] == ["target", "format", "bits", "lies in", "field", "code"]
    assert ["target_0", "rg32_uint", "8", "x 0-7", "roughness", "square_root"] in lines
    assert ["target_2", "rgba8", "12", "z 0-3, w 0-7", "other_4", "as it is"] in lines
    lines = table(Contents(layouts["unreal4"]))
    assert any("base_colour.x" in line and "sRGB, by the format" in line for line in lines)


def test_folded_lines_are_the_same_code():
    """Nothing but white space is added."""
    inside = " + ".join(f"f({at}, {at + 1})" for at in range(40))
    for line in (f"    int x = g({inside}, {inside})", f"int x = {' + '.join(['abcdef'] * 30)}"):
        broken = folded(line + "\n")
        assert max(map(len, broken.splitlines())) <= WIDTH
        assert "".join(broken.split()) == "".join(line.split())


def test_the_command_writes_files_and_checks_them(run, tmp_path, monkeypatch):
    """A file of the name of the layout, which says what made it and how it compares; `--check` writes a table."""
    require_runner("c")
    (tmp_path / "mine.toml").write_text(WORDS)
    monkeypatch.chdir(tmp_path)
    status, _, _ = run("code", "mine.toml", "--to", "c,msl", "-o", "made")
    assert status == 0
    assert {path.name for path in Path("made").iterdir()} == {"mine.h", "mine.metal"}
    text = Path("made/mine.h").read_text()
    assert "normalbench code mine.toml --to c" in text and "the renderer's, bit for bit" in text
    assert "not run here" in Path("made/mine.metal").read_text()
    status, out, _ = run("code", "unreal4", "--of", "layout", "--check", "--to", "c", "--format", "json")
    (row,) = json.loads(out)
    assert status == 0 and row["verdict"] == "verified"
    status, _, err = run("code", "unreal4")
    assert status != 0 and "unreal4 is a layout: normalbench code unreal4 --of layout" in err
    # Two in one folder may be used together.
    assert run("code", "mine.toml,bevy", "--of", "layout", "--to", "c", "-o", "two")[0] == 0
    assert "mine_pack" in Path("two/mine.h").read_text() and "bevy_pack" in Path("two/bevy.h").read_text()
    status, _, err = run("code", "mine.toml,bevy", "--of", "layout", "--prefix", "my", "-o", "two")
    assert status != 0 and "names of 2 layouts would collide" in err
    status, _, err = run("code", "mine.toml", "--storage", "rg8")
    assert status != 0 and "a layout says its formats itself" in err


def test_a_file_that_differs_is_not_written(run, tmp_path, monkeypatch):
    """All languages are made from one tree: where one is wrong none is written, and the exit status is 1."""
    require_runner("c")
    (tmp_path / "mine.toml").write_text(WORDS)
    monkeypatch.chdir(tmp_path)
    own = gbuffer_command.gbuffer_code

    def wrong(layout, language, prefix):
        code = own(layout, language, prefix)
        return replace(code, body=code.body.replace("* 8191.0", "* 8190.0"))

    monkeypatch.setattr(gbuffer_command, "gbuffer_code", wrong)
    status, _, err = run("code", "mine.toml", "--to", "msl", "-o", "made")
    assert status == 1 and "is not written" in err
    assert not Path("made").exists()
