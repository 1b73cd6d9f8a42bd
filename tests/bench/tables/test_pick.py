"""`normalbench pick`: its answer follows from its rows, whatever is asked, and what it says is what the rows say."""

import json
import math
import random

import pytest

from normalbench.bench.codecs.names import codecs_named
from normalbench.bench.metrics.images import squared_error
from normalbench.bench.metrics.totals import psnr_db
from normalbench.bench.normals.normal_sets import NORMAL_SETS
from normalbench.bench.output import cache
from normalbench.bench.tables.pick import measure
from normalbench.bench.tables.pick.answer import answered, groups
from normalbench.bench.tables.pick.sentences import sentences
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

CODES = "xy,xy_sign,spherical,spheremap,octahedral,octahedral_precise,latitude_longitude,hemi_octahedral,per_pixel_view"
CODES += ",xyz,xyz_renormalised,cube"
SMALL = ("pick", "--encoding", CODES, "--count", "4096", "--aim", "image")
ONE_WAY = """// components: 2
vec2 flat_encode(vec3 n, vec3 view) { return n.xy; }
vec3 flat_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e)))); }
"""


@pytest.fixture(scope="module")
def rows(gl, radv, tmp_path_factory):  # noqa: ARG001 # they skip where this machine lacks them
    """What the command measures of a dozen codes: with --aim image all that qualify have an image."""
    from normalbench.bench.cli import app

    output = tmp_path_factory.mktemp("pick") / "rows.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["normalbench", *SMALL, "--format", "json", "-o", str(output)])
        assert app.main() == 0
    return json.loads(output.read_text())


def figures(row: dict, aim: str) -> float:
    """A figure of which less is better; infinite where there is none."""
    images = [row["image_db_47"], row["image_db_1024"]]
    largest = max(row["angle_max_deg"], row["angle_sup_deg"] or 0)
    return {
        "angle": row["angle_mean_deg"],
        "worst": largest if row["aim"] == "worst" else row["angle_max_deg"],
        "image": math.inf if None in images else -min(images),
        "cost": row["instructions"],
    }[aim]


def qualifies(row: dict, asked: dict) -> bool:
    fits = {None: row["lost_percent"] == 0, "sphere": row["domain"] == "sphere"}
    fits |= {"hemisphere": row["domain"] != "view", "view": row["domain"] != "hemisphere"}
    most = asked["most_instructions"]
    is_cheap = most is None or row["instructions"] <= most
    return fits[asked["needs"]] and is_cheap and figures(row, asked["aim"]) < math.inf


def test_the_answer_to_200_random_questions_is_that_of_brute_force(rows):
    """Every other code is compared with the best, the runner-up and the cheaper one; and with all of the front."""
    chance, seen = random.Random(0), set()
    for _ in range(200):
        asked = {
            "aim": chance.choice(["angle", "worst", "image", "cost"]),
            "needs": chance.choice([None, "sphere", "hemisphere", "view"]),
            "most_instructions": chance.choice([None, 0, 5, 11, 20, 30, 40, 60, 100, 200]),
        }
        kept = [row | asked for row in rows if chance.random() < 0.8]
        for group in groups(answered(kept)).values():
            check(group, asked)
            seen |= {place for row in group for place in (row["place"] or "").split(", ")}
    assert {"best", "runner-up", "cheaper", "picture", ""} <= seen


def check(group: list[dict], asked: dict) -> None:
    fit = [row for row in group if qualifies(row, asked)]
    assert {row["encoding"] for row in group if not row["left_out"]} == {row["encoding"] for row in fit}
    ranks = (asked["aim"], "cost", "angle", "worst", "image")
    expected = {}
    if fit:
        best = min(fit, key=lambda row: [figures(row, aim) for aim in ranks])
        others = [row for row in fit if row is not best]
        cheap = [row for row in others if 2 * row["instructions"] <= best["instructions"]]
        pictured = [row for row in fit if figures(row, "image") < math.inf]
        expected = {"best": best["encoding"]}
        for place, among, by in (("runner-up", others, ranks), ("cheaper", cheap, ranks), ("picture", pictured, None)):
            if among:
                by = by or ("image", *ranks)
                expected[place] = min(among, key=lambda row, by=by: [figures(row, aim) for aim in by])["encoding"]
    found = {place: row["encoding"] for row in group for place in (row["place"] or "").split(", ") if place}
    assert found == expected, (asked, found, expected)
    for row in fit:
        beaten = [
            other["encoding"]
            for other in fit
            if all(figures(other, aim) <= figures(row, aim) for aim in ranks)
            and any(figures(other, aim) < figures(row, aim) for aim in ranks)
        ]
        assert row["front"] == (not beaten), (asked, row["encoding"], beaten)


def test_the_sentences_say_the_rows_figures(rows):
    for group in groups(answered([row | {"aim": "angle"} for row in rows])).values():
        answer, first, *rest = sentences(group)
        best = next(row for row in group if row["place"] and "best" in row["place"])
        for said in (
            f"mean error is {best['angle_mean_deg']:.3g}°",
            f"{best['image_db_47']:.1f} dB at power 47 and {best['image_db_1024']:.1f} dB at power 1024",
            f"{best['instructions']} instructions on navi21: {best['encode_instructions']} to encode",
        ):
            assert said in first, (said, first)
        assert answer.endswith(f"take {best['encoding']}."), answer
        lost = "xy, hemi_octahedral (loss of normals that point away (z < 0): 50 % of these)"
        assert any(lost in said for said in rest), rest


@pytest.mark.slow
@pytest.mark.usefixtures("gl", "radv")
def test_an_encoder_in_glsl_alone_is_compared_and_said_to_lose_half(run, tmp_path):
    path = tmp_path / "flat.glsl"
    path.write_text(ONE_WAY)
    words = ("pick", "--encoding", "octahedral", "--storage", "rg8", "--count", "4096", "--against", str(path))
    status, out, _ = run(*words)
    assert status == 0 and "flat does not qualify: loss of normals that point away (z < 0): 50 % of these" in out, out
    status, out, _ = run(*words, "--domain", "hemisphere", "--normals", "hemisphere")
    assert status == 0 and "take octahedral" in out and "flat: mean error" in out, out


def test_where_nothing_qualifies_it_is_said_with_status_1(run):
    status, out, err = run("pick", "--encoding", "octahedral", "--storage", "rg8", "--most-instructions", "1")
    assert status == 1 and "no answer for rg8 on sphere" in err and "no code qualifies" not in err
    assert "octahedral (more than 1 instructions)" in out.replace("\n  ", " ")


@pytest.mark.parametrize(
    "words, said",
    [
        (("--aim", "beauty"), "unknown aim 'beauty'; known: angle, worst, image, cost"),
        (("--family", "navi99"), "unknown family 'navi99'; known: polaris10"),
        (("--domain", "cube"), "unknown domain 'cube'; known: sphere, hemisphere, view"),
        (("--power", "47,none"), "--power none: a specular power is 1 to 2048"),
        (("--most-instructions", "-1"), "--most-instructions -1: from 0 to 1000000"),
        (("--encoding", "xyz", "--storage", "rg8"), "xyz: 3 components, but RG8 has 2 channels"),
    ],
)
def test_what_cannot_be_asked_is_one_line(run, words, said):
    status, out, err = run("pick", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


@pytest.mark.slow
def test_what_was_measured_is_kept_and_only_for_the_same_codes(run, monkeypatch, tmp_path):
    """A second answer measures nothing; other normals are measured."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    measured = []
    whole = measure.quality.rows
    monkeypatch.setattr(measure.quality, "rows", lambda cases, tick: whole(noted(cases), tick))

    def noted(cases):
        measured.extend(case.codec.name for case in cases)
        return cases

    words = ("pick", "--encoding", "octahedral,xy_sign", "--storage", "rg8", "--count", "4096")
    first = run(*words)[1]
    assert measured == ["octahedral/rg8", "xy_sign/rg8"]
    assert run(*words)[1] == first and len(measured) == 2
    run(*words[:-1], "8192")
    assert len(measured) == 4 and cache.folder().is_relative_to(tmp_path)


@pytest.mark.parametrize("name", ["octahedral/rg8", "per_pixel_view/rg8", "octahedral_precise/rgb10a2", "xyz/rgb10a2"])
def test_images_lit_by_emulated_codes_are_those_of_the_g_buffer(gl, name):
    """Against the code in a target, encoded and decoded in shaders: to 0.02 dB, at a specular power of 1024."""
    (codec,) = codecs_named(*name.split("/"), "nearest")
    question = (NORMAL_SETS["sphere"](64, 0), SCENES["gloss"], Setting(lights=8), (1024.0,), {})
    case, drawing = measure.Case(codec, *question), measure.Pictures(gl)
    right, relit, drawn = (
        images[0]
        for images in (
            drawing._drawn(case, LAYOUTS["fp32"]),
            drawing._relit(case),
            drawing._drawn(case, LAYOUTS["fp32"].with_codec(codec)),
        )
    )
    found, expected = (psnr_db(squared_error(displayed(image), displayed(right))[0]) for image in (relit, drawn))
    assert found == pytest.approx(expected, abs=0.02) and 25 < expected < 80
