"""The answer: who wins, said of rows that are made for it."""

import math

import pytest

from normalbench.reports.page.verdict import contests

DOMAINS = {"whole": "sphere", "other": "sphere", "half": "hemisphere", "facing": "view"}


def row(encoding: str, psnr_db: float, **more) -> dict:
    about = {"encoding": encoding, "storage": "rg8", "rounding": "nearest", "normals": "scene", "backend": "jax"}
    return about | {"bits": 16, "psnr_db": psnr_db} | more


def only(rows, images=(), costs=None):
    (contest,) = contests(rows, images, costs or {}, DOMAINS)
    return contest


def test_the_winner_its_figure_and_who_comes_next():
    found = only([row("other", 48.25), row("whole", 50.0), row("half", 40.0)])
    assert found.headline == "In 16 bits on scene, whole in rg8 wins: 50.00 dB, 1.75 dB ahead of other in rg8."
    assert found.remarks == () and found.codecs == 3


def test_figures_too_close_are_a_tie_and_others_are_not():
    tie = only([row("whole", 50.0), row("other", 49.96), row("half", 40.0)])
    assert (
        tie.headline == "In 16 bits on scene whole and other in rg8 are equal: 50.00 dB, 10.00 dB ahead of half in rg8."
    )
    assert "whole in rg8 wins" in only([row("whole", 50.0), row("other", 49.94)]).headline


def test_one_codec_wins_nothing():
    assert only([row("whole", 50.0)]).headline == "In 16 bits on scene there is whole in rg8 alone: 50.00 dB."


def test_no_error_at_all_is_infinite_and_ahead_by_no_number():
    found = only([row("whole", math.inf), row("other", 60.0)])
    assert found.headline == "In 16 bits on scene, whole in rg8 wins: inf dB." and found.rows[0]["ahead"] is None
    assert "are equal" in only([row("whole", math.inf), row("other", math.inf)]).headline


@pytest.mark.parametrize("name, made_for", [("half", "normals with z >= 0"), ("facing", "face the viewer")])
def test_a_winner_made_for_less_than_every_direction_is_said_to_be(name, made_for):
    (remark,) = only([row(name, 55.0), row("whole", 50.0), row("other", 45.0)]).remarks
    assert made_for in remark and "of codes for every direction whole in rg8 is best: 50.00 dB" in remark


def test_an_encoding_nobody_knows_is_not_said_to_be_made_for_anything():
    assert only([row("mine", 55.0), row("whole", 50.0)]).remarks == ()


def test_measures_that_disagree_are_said_by_name_and_cost_is_no_quality():
    rows = [
        row("whole", 50.0, angle_mean_deg=0.3, angle_max_deg=0.9),
        row("other", 49.0, angle_mean_deg=0.4, angle_max_deg=0.5),
    ]
    images = [{"encoding": "other", "storage": "rg8", "scene": "room", "psnr_db": 52.0}]
    images += [{"encoding": "whole", "storage": "rg8", "scene": "room", "psnr_db": 50.0}]
    found = only(rows, images, {"whole": 30, "other": 4})
    (remark,) = found.remarks
    assert "largest angle, other in rg8 (0.5 degrees)" in remark and "final image of room, other in rg8" in remark
    assert "mean angle" not in remark and "instructions" not in remark
    by = {line["by"]: line for line in found.rows}
    assert by["largest angle"]["ahead"] == pytest.approx(0.4) and by["final image of room"]["ahead"] == 2.0
    assert by["fewest instructions, encode and decode"]["first"] == "other in rg8"


def test_back_ends_that_name_another_winner_are_said():
    rows = [row("whole", 50.0), row("other", 49.0)]
    agreeing = [r | {"backend": "glsl", "psnr_db": r["psnr_db"] + 0.02} for r in rows]
    assert only(rows + agreeing).agreement == "JAX and GLSL agree within 0.02 dB."
    disagreeing = [row("whole", 48.0, backend="glsl"), row("other", 49.5, backend="glsl")]
    found = only(rows + disagreeing)
    assert not found.agrees and "by JAX whole in rg8 leads; by GLSL other in rg8 leads" in found.agreement
    assert only(rows).agreement == "Measured by JAX alone."


def test_sets_and_bits_are_contests_of_their_own_the_fullest_bits_first():
    rows = [row("a", 50, bits=24), row("b", 40), row("c", 41), row("d", 30, normals="sphere")]
    assert [(c.normals, c.bits) for c in contests(rows, [], {}, {})] == [("scene", 16), ("scene", 24), ("sphere", 16)]


def test_rows_without_figures_take_no_part():
    rows = [row("whole", 50.0), row("other", None), row("half", math.nan), {"encoding": "odd"}, row("more", "55")]
    assert only(rows).codecs == 1 and contests([], [], {}, {}) == []


def test_a_codec_that_is_there_in_glsl_alone_takes_part():
    """As a user's own encoder is, next to others that JAX measured."""
    found = only([row("whole", 50.0), row("whole", 50.0, backend="glsl"), row("mine", 52.0, backend="glsl")])
    assert found.codecs == 2 and "mine in rg8 wins: 52.00 dB, 2.00 dB ahead of whole" in found.headline
