"""Generated code of whole layouts, compared with the renderer's own GLSL."""

import json
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
import test_whole_layouts
from languages import require_runner
from slowly import a_tenth
from test_whole_layouts import WORDS
from typed import layouts_named

from normalbench.bench.door import gbuffer_command
from normalbench.bench.shaders.code.whole.emit import gbuffer_code
from normalbench.bench.shaders.code.whole.run import RUNS
from normalbench.bench.shaders.code.whole.surface import Contents
from normalbench.bench.shaders.code.whole.verify import agreement
from normalbench.gbuffer.layouts.presets import LAYOUTS

pytestmark = pytest.mark.usefixtures("gl")
layouts = test_whole_layouts.layouts


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


@pytest.mark.drawn(3)
@pytest.mark.parametrize("name, language", [*product(TIES, FAST)])
def test_code_packs_and_unpacks_like_the_renderer(name, language, layouts):
    """Target bits and decoded numbers are compared for surfaces at and beyond the ends of each range."""
    require_runner(language)
    verdict = agreement(gbuffer_code(layouts[name], language), FEW)
    assert verdict.holds, verdict.says
    assert verdict.differing <= max(TIES[name] * FEW, 2 * (TIES[name] > 0)), verdict.says


# Code of layouts by name: each fault is looked for in one after the other.
WRITTEN = {}


def written_in_c(name, layout):
    """Return the C code of a layout, generated once."""
    if name not in WRITTEN:
        WRITTEN[name] = gbuffer_code(layout, "c")
    return WRITTEN[name]


@pytest.mark.drawn(3)
@pytest.mark.parametrize(
    "old, new",
    [
        ("normal_x_bits << 20", "normal_x_bits << 19"),
        ("* 8191.0f) + 8191.0f", "* 8191.0f) + 8190.0f"),
        ("(shading_model_bits << 4)", "(shading_model_bits << 3)"),
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
    """The fault is put into the first layout that has such a line."""
    require_runner("c")
    words_first = {"words": layouts["words"]} | layouts
    codes = (written_in_c(name, layout) for name, layout in words_first.items())
    code = next(code for code in codes if old in code.body)
    assert not agreement(replace(code, body=code.body.replace(old, new)), FEW).holds


def test_a_width_in_the_file_changes_both_functions(tmp_path):
    """8-bit roughness becomes 7 bits and one other bit: the code changes and still agrees."""
    require_runner("c")
    bodies = []
    for name, text in (("eight", WORDS), ("seven", WORDS.replace("(roughness):8", "(roughness):7 other:1"))):
        (tmp_path / f"{name}.toml").write_text(text)
        (layout,) = layouts_named(str(tmp_path / f"{name}.toml"))
        code = gbuffer_code(layout, "c")
        assert (verdict := agreement(code, FEW)).differing == 0, verdict.says
        bodies.append(code.body)
    for function in ("gbuffer_targets gbuffer_pack(", "gbuffer_surface gbuffer_unpack("):
        parts = [body.partition(function)[2].partition("\n}")[0] for body in bodies]
        assert "255.0" in parts[0] and "127.0" in parts[1] and parts[0] != parts[1]


def test_other_fields_keep_their_names_in_the_code(tmp_path):
    """A number is added to a name that is a keyword, another field's name or a duplicate."""
    require_runner("c")
    words = "other.flags:4 other.half:4 other.roughness:4 other.lit:2 other.lit:2"
    (tmp_path / "mine.toml").write_text(
        WORDS.replace("ao other shading_model:4 other:12", f"ao {words} shading_model:8")
    )
    (layout,) = layouts_named(str(tmp_path / "mine.toml"))
    names = [field.name for field in Contents(layout).fields if field.components == (field.name,)]
    assert {"flags", "half_4", "roughness_5", "lit_6", "lit_7", "other_1", "other_2"} <= {*names}, names
    assert (verdict := agreement(gbuffer_code(layout, "c"), FEW)).differing == 0, verdict.says


def test_the_command_writes_files_and_checks_them(run, tmp_path, monkeypatch):
    """A file has the layout's name, its command and the result of its check; `--check` prints a table."""
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
    assert status != 0 and "unreal4 is a layout; use: normalbench code unreal4 --of layout" in err
    # Two in one folder may be used together.
    assert run("code", "mine.toml,bevy", "--of", "layout", "--to", "c", "-o", "two")[0] == 0
    assert "mine_pack" in Path("two/mine.h").read_text() and "bevy_pack" in Path("two/bevy.h").read_text()
    status, _, err = run("code", "mine.toml,bevy", "--of", "layout", "--prefix", "my", "-o", "two")
    assert status != 0 and "names of 2 layouts would collide" in err
    status, _, err = run("code", "mine.toml", "--storage", "rg8")
    assert status != 0 and "a layout has its own formats" in err


def test_a_file_that_differs_is_not_written(run, tmp_path, monkeypatch):
    """All languages come from one tree: if one is wrong, no file is written and the exit status is 1."""
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


OTHERS = [language for language in RUNS if language not in FAST]


# Each layout in another language than the one before.
IN_TURN = [(name, OTHERS[turn % len(OTHERS)]) for turn, name in enumerate(TIES)]


@pytest.mark.parametrize("name, language", IN_TURN)
def test_code_packs_and_unpacks_like_the_renderer_in_any_language(name, language, layouts):
    test_code_packs_and_unpacks_like_the_renderer(name, language, layouts)


@pytest.mark.parametrize("name, language", a_tenth(product(TIES, FAST)))
def test_code_packs_many_surfaces_like_the_renderer(name, language, layouts):
    """No surface differs if no curve has a power; otherwise a few next to a tie differ by one step."""
    require_runner(language)
    many_agree(layouts[name], language, TIES[name], MANY // 5)


def many_agree(layout, language, share, count) -> None:
    """Check that at most a share of many surfaces differs."""
    result = agreement(gbuffer_code(layout, language), count, seed=1)
    assert result.holds, result.says
    assert result.differing <= share * count, result.says


# Of each kind of code one at every landing: tables, words, and a sign beside another number.
KINDS = ("cryengine3", "unreal5_substrate_22", "volo")


@pytest.mark.parametrize("name", [*KINDS, *a_tenth(name for name in LAYOUTS if name not in KINDS)])
def test_every_preset_is_written(name):
    """In C, the code writes and reads the same as the renderer's own GLSL."""
    require_runner("c")
    assert (verdict := agreement(gbuffer_code(LAYOUTS[name], "c"), FEW)).holds, verdict.says
