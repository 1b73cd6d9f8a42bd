"""`normalbench effects`: rows, their order, pictures, effects in other tables, and messages for bad input."""

import numpy as np
import pytest

from normalbench.bench.tables.effects.measure import drawn_at, in_order, moved_percent

pytestmark = pytest.mark.usefixtures("gl")


def test_a_hit_moved_if_it_is_lost_or_more_than_a_pixel_away():
    """Hits in place, one pixel away, two pixels away and lost. A NaN counts as moved; no hits give None."""
    exact = np.array([[[5, 5, 0, 1]] * 4 + [[0, 0, 0, 0]]], np.float32)
    hits = np.array([[[5, 5, 0, 1], [6, 5, 0, 1], [5, 7, 0, 1], [0, 0, 0, 0], [9, 9, 0, 1]]], np.float32)
    assert moved_percent(hits, exact) == 50
    hits[0, 0, 0] = np.nan
    assert moved_percent(hits, exact) == 75
    assert moved_percent(hits, 0 * exact) is None


def test_rows_are_sorted_by_bits_then_error_with_depth_encodings_last():
    def row(effect, bits, apart, depth=None):
        about = {"effect": effect, "pipeline": "hybrid", "scene": "room", "depth": depth}
        return about | {"normal_bits": bits, "effect_rms": apart}

    rows = [row("b", 20, 2), row("b", None, 1, "window/r32f"), row("b", 16, 4), row("a", 16, 1), row("b", 16, 3)]
    assert in_order(rows) == [rows[4], rows[2], rows[0], rows[1], rows[3]]


@pytest.mark.parametrize(
    "words, said",
    [
        (("--effect", "lvp"), "unknown effect 'lvp'; did you mean lpv? known: all, "),
        (("--effect", "lpv:steps=2"), "effect lpv has no setting 'steps'; known: iterations"),
        (("--effect", "lpv:iterations=9"), "effect lpv: iterations=9 is not a whole number from 0 to 8"),
        (
            ("--effect", "lpv:iterations"),
            "'iterations' is not a setting; write it as name=value",
        ),
        (("--effect", "lpv:cells=8:cells=16"), "effect lpv:cells=8:cells=16: cells is set twice"),
        (("--effect", ""), "no effect named; known: all, "),
        (
            ("--pipeline", "forward"),
            "pipeline forward has no G-buffer for an effect to read",
        ),
        (
            ("--depth", "linear"),
            "--depth linear: not an encoding with its storage; write for example linear/packed16, or none",
        ),
        (("--depth", "linear/packed9"), "unknown depth storage 'packed9'"),
        (("--depth", "metres/r32f"), "unknown depth 'metres'"),
        (("--depth", "linear_sign/packed24"), "cannot be used with xyz"),
        (("--encoding", "xyz", "--storage", "rg8", "--depth", "none"), "3 components, but RG8 has 2 channels"),
        (("--layout", "normal_depth", "--depth", "none"), "hybrid needs base_color.b"),
        (("--depth", "none"), "--depth none leaves nothing to measure; add --encoding or --layout"),
        (
            ("--effect", "subsurface", "--pipeline", "deferred"),
            "subsurface cannot be used in pipeline deferred; use prepass, inferred, hybrid",
        ),
        (
            ("--effect", "ssr", "--scene", "room"),
            "ssr on room: its materials have no roughness; use studio or a glTF file",
        ),
        (("--effect", "ssr:steps=0"), "effect ssr: steps=0 is not a whole number from 1 to 4096"),
        (("--effect", "ssr:rays=some"), "effect ssr: rays=some is not a whole number from 1 to 1024"),
        (("--effect", "ssr:misses=black"), "effect ssr: misses=black is not environment or nothing"),
        (
            ("--effect", "ssr", "--pipeline", "prepass"),
            "ssr cannot be used in pipeline prepass; use deferred, hybrid",
        ),
        (("--effect", "ssr", "--layout", "normal_depth", "--depth", "none"), "hybrid needs base_color.b"),
        (("--rays", "-1"), "--rays -1: out of range; use 0"),
        (("--repeats", "-1"), "--repeats -1: out of range; use 0"),
        (("--size", "0x5"), "WIDTHxHEIGHT"),
        (("--scene", "sponza"), "unknown scene 'sponza'"),
        (("--images", "/proc/none"), "cannot write to /proc/none"),
    ],
)
def test_bad_input_is_a_one_line_error_and_nothing_is_written(run, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    effect = () if "--effect" in words else ("--effect", "lpv")
    status, out, err = run("effects", *effect, *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert not list(tmp_path.iterdir())


def test_an_effects_alpha_marks_where_the_effect_is_drawn():
    own, surfaces = np.zeros((1, 3, 4), np.float32), np.array([[True, True, False]])
    assert not drawn_at(own, surfaces).any() and np.array_equal(drawn_at(own[..., :1], surfaces), surfaces)
    own[0, 1:, 3] = 1
    assert np.array_equal(drawn_at(own, surfaces), [[False, True, True]])


def test_two_effects_of_the_same_kind_are_refused(run):
    status, out, err = run("render", "--effects", "gtao,lpv,sao", "--encoding", "xy")
    assert (status, out) == (2, "") and "gtao and sao both produce visibility; name only one" in err, err
    assert err.count("\n") == 1


@pytest.mark.parametrize("table", ["render", "pick"])
def test_other_tables_refuse_an_unknown_effect(run, table):
    status, out, err = run(table, "--effects", "lpv,glow")
    assert (status, out) == (2, "") and "unknown effect 'glow'; known: all, " in err and err.count("\n") == 1, err
