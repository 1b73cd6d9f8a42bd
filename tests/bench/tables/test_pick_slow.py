"""`normalbench pick`: the answer to any question follows from the rows, and the sentences agree with the rows."""

import json
import math
import random
from contextlib import ExitStack
from dataclasses import replace
from operator import le

import numpy as np
import pytest
import test_pick
from test_pick import CODES
from typed import codecs_named

from normalbench.bench.ground.output import cache
from normalbench.bench.ground.output.errors import told
from normalbench.bench.measures.images.whole import whole_images
from normalbench.bench.measures.metrics.images import squared_error
from normalbench.bench.measures.metrics.totals import psnr_db
from normalbench.bench.tables.pick import measure
from normalbench.bench.tables.pick.answer import answered, groups
from normalbench.bench.tables.pick.sentences import sentences
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.layout import engines_space
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

rows = test_pick.rows


@pytest.mark.parametrize(
    "scene, name",
    [
        *(("gloss", name) for name in ("per_pixel_view/rg8", "octahedral_precise/rgb10a2", "xyz/rgb10a2")),
        *(("studio", name) for name in ("octahedral/rg8", "hemi_octahedral/rg8")),
    ],
)
def test_images_lit_with_emulated_codes_match_the_g_buffer(gl, scene, name):
    """At a specular power of 1024, images agree to 0.02 dB with those of codes that shaders encode into a target and
    decode, in the space that engines use."""
    (codec,) = codecs_named(*name.split("/"), "nearest")
    maker, setting, pipeline = SCENES[scene], Setting(lights=8), PIPELINES["hybrid"]
    power = None if maker.is_metal_rough else 1024.0
    turn = np.eye(3) if engines_space(codec.encoding) == "world" else None
    layout = replace(LAYOUTS["fp32"], space=engines_space(codec.encoding)).with_codec(codec)
    with ExitStack() as stack:
        image = whole_images(gl, stack, pipeline, maker, setting, [power])[power]
        relit = image.shown(lambda n, p: quality.round_trip(codec, n, p), turn)
        plan = Plan((640, 480), 1, layout, LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
        drawing = stack.enter_context(rendering(gl, pipeline, image.scene, plan))
        drawing.draw()
        drawn = image.display.image(drawing.image())
    decibels, expected = (psnr_db(squared_error(shown, image.exact)[0]) for shown in (relit, drawn))
    assert decibels == pytest.approx(expected, abs=0.02) and 20 < expected < 80


def test_an_answer_from_few_random_normals_gives_a_warning(capsys):
    """With one normal any encoding may be the best; the axes are few, but complete. The warning comes before anything
    is measured."""
    pick = TABLES["pick"]

    def warning(**asked) -> str:
        told.clear()
        options = pick.options(encoding="octahedral,spheremap", storage="rg8", aim="angle", **asked)
        assert pick.work.steps(options, pick.outputs())
        return capsys.readouterr().err

    line = "with fewer than 4096 random normals (sphere), a different --seed may give a different answer"
    assert f"--count 1: {line}" in warning(count=1)
    assert "a different --seed" not in warning(count=4096)
    assert "a different --seed" not in warning(count=1, normals="axes")


ONE_WAY = """// components: 2
vec2 flat_encode(vec3 n, vec3 view) { return n.xy; }
vec3 flat_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e)))); }
"""


SCENES_OF_IMAGES = ("studio", "room_47", "room_1024")


def loss(row: dict, aim: str) -> float:
    """Return the mean angle, the largest angle or the worst image, in decibels; less is better."""
    if aim == "image":
        images = [row[f"image_db_{name}"] for name in SCENES_OF_IMAGES]
        return math.inf if None in images else -min(*images, 70.0)
    angle = max(row["angle_max_deg"], row["angle_sup_deg"] or 0) if aim == "worst" else row["angle_mean_deg"]
    return 20 * math.log10(angle)


def paid(row: dict) -> float:
    return max(row["encode_slots"], 16) + row["readers"] * max(row["decode_slots"], 16)


def rank(row: dict) -> tuple:
    """Return the rank of a row, the lowest first. Encodings with invisible errors at no more than twice the hidden
    cost come first, by bits and cost; the others by decibels, with `worth` decibels for each doubling of the cost."""
    price, largest = paid(row), max(row["angle_max_deg"], row["angle_sup_deg"] or 0)
    hidden, lost, enough = 16 * (1 + row["readers"]), loss(row, row["aim"]), 2 * largest <= row["enough"]
    if row["aim"] == "cost":
        return (price, not enough, lost)
    if enough and price <= 2 * hidden:
        return (0, row["table"], row["bits"], round(math.log2(price / hidden)), round(lost, 1))
    score = lost + row["worth"] * math.log2(price / hidden)
    return (1, score if row["aim"] == "image" else round(2 * score), price, lost)


def lowest(row: dict, yaws: list[int]) -> float:
    """Return the PSNR of the worst image over some yaws."""
    errors = [by_pole["y"] for by_pole in json.loads(row["image_errors"]).values()]
    return min(70.0, *(-10 * math.log10(sum(of[yaw] for yaw in yaws) / len(yaws)) for of in errors))


def ties(row: dict, best: dict) -> bool:
    """Whether two codes are less than half a decibel apart, or less than two standard errors of the four yaws."""
    gaps = [lowest(row, kept) - lowest(best, kept) for kept in ([1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2])]
    error = math.sqrt(3 / 4 * sum((gap - sum(gaps) / 4) ** 2 for gap in gaps))
    return rank(row)[0] == 1 and rank(row)[1] - rank(best)[1] < max(0.5, 2 * error)


def taken(fit: list[dict]) -> list[dict]:
    """Return the rows that may be the answer: the lowest rank; for images, the cheapest rows that tie with it."""
    least = min(map(rank, fit), default=None)
    first = [row for row in fit if rank(row) == least]
    if not first or least[0] != 1 or first[0]["aim"] != "image":
        return first
    tied = [row for row in fit if any(row is leader or ties(row, leader) for leader in first)]
    return [row for row in tied if paid(row) == min(map(paid, tied))]


def could_be_asked_for(row: dict, asked: dict) -> bool:
    fits = {None: row["lost_percent"] == 0, "sphere": row["domain"] == "sphere"}
    fits |= {"hemisphere": row["domain"] != "view", "view": row["domain"] != "hemisphere"}
    return fits[asked["needs"]] and (asked["accept_lengths"] or row["length_share"] <= 0.1)


def qualifies(row: dict, asked: dict) -> bool:
    most = asked["most_instructions"]
    return (most is None or row["slots_once"] <= most) and loss(row, asked["aim"]) < math.inf


def without_holes(rows: list[dict], asked: dict) -> list[dict]:
    """Return the rows without a hole, compared with the smallest largest error of all rows, whatever their cost."""
    largest = {row["encoding"]: max(row["angle_max_deg"], row["angle_sup_deg"] or 0) for row in rows}
    most = math.inf if asked["accept_holes"] else 4 * min(largest.values(), default=0)
    return [row for row in rows if largest[row["encoding"]] <= most]


def asked_at_random(chance: random.Random) -> dict:
    return {
        "aim": chance.choice(["angle", "worst", "image", "cost"]),
        "needs": chance.choice([None, "sphere", "hemisphere", "view"]),
        "most_instructions": chance.choice([None, None, 0, 20, 30, 40, 100, 200]),
        "readers": chance.choice([0, 1, 4, 8]),
        "worth": chance.choice([0.1, 3.0, 3.0, 12.0]),
        "accept_holes": chance.random() < 0.3,
        "accept_lengths": chance.random() < 0.3,
    }


def for_readers(row: dict, readers: int) -> dict:
    return {"slots": row["encode_slots"] + readers * row["decode_slots"]}


# What all rows of a question say.
QUESTION = {
    "rounding": "nearest",
    "normals": "sphere",
    "scene": "studio,room",
    "bytes": 2,
    **dict.fromkeys(("family", "dearest_family"), "navi21"),
    "aim": "angle",
    "readers": 4,
    "worth": 3.0,
    "enough": 0.35,
    "look_ups": True,
    **dict.fromkeys(("accept_holes", "accept_lengths", "against", "beside", "packed", "table"), False),
}


def row_of(encoding: str, storage: str, **figures: object) -> dict:
    """Return a row as `pick` measures it. Encodings for less than the whole sphere lose half of the normals."""
    domain = ENCODINGS[encoding].domain
    about = {"asked": storage, "storage": storage, "encoding": encoding, "domain": domain}
    about |= {"lost_percent": 0.0 if domain == "sphere" else 50.0}
    return TABLES["pick"].empty(SCENES_OF_IMAGES) | QUESTION | about | figures


def images_at_random(chance: random.Random) -> dict:
    """Return random errors of each image over four yaws; many encodings tie."""
    level, spread = chance.uniform(20, 80), chance.choice([0.05, 1.0])
    errors = {name: [10 ** (-chance.gauss(level, spread) / 10) for _ in range(4)] for name in SCENES_OF_IMAGES}
    row = {f"image_db_{name}": -10 * math.log10(sum(four) / 4) for name, four in errors.items()}
    return row | {"image_pole": "y", "image_errors": json.dumps({name: {"y": four} for name, four in errors.items()})}


def rows_at_random(chance: random.Random) -> list[dict]:
    """Return rows with few different costs and errors, so that many are equal, and rows of every kind left out."""
    rows = []
    for encoding in CODES.split(","):
        for storage in ("rg8", "rgb10a2"):
            encode, decode = (chance.choice([5, 14, 16, 20, 36, 64, 115.5, 289]) for _ in range(2))
            mean = 0.02 * 2 ** (chance.randrange(24) / 4)
            largest = mean * chance.choice([2, 3, 3, 30])
            figures = {"angle_mean_deg": mean, "angle_max_deg": largest, "encode_slots": encode, "decode_slots": decode}
            figures |= {"angle_sup_deg": chance.choice([None, largest * 1.1]), "slots_once": encode + decode}
            figures |= {"bits": chance.choice([16, 17, 20]), "table": chance.random() < 0.1}
            figures |= {"length_share": chance.choice([0.0, 0.0, 0.0, 0.7])}
            if chance.random() < 0.9:
                figures |= images_at_random(chance)
            rows.append(row_of(encoding, storage, **figures))
    return rows


def check_a_question(rows: list[dict], chance: random.Random) -> set[str]:
    """Check the answer to a random question about some of the rows. Return the places that occur in it."""
    asked, places = asked_at_random(chance), set()
    given = [row | asked | for_readers(row, asked["readers"]) for row in rows if chance.random() < 0.8]
    for group in groups(answered([row for row in given if not row["beside"]])).values():
        check(group, asked)
        places |= {place for row in group for place in (row["place"] or "").split(", ")}
    return places


def test_300_random_questions_match_brute_force():
    """Brute force compares all rows to find the best, and all pairs of rows to find the front."""
    chance, seen = random.Random(0), set()
    for _ in range(300):
        seen |= check_a_question(rows_at_random(chance), chance)
    assert {"best", "more accurate", "most accurate", "cheaper", "fewer bits", ""} <= seen


def check(group: list[dict], asked: dict) -> None:
    fit = without_holes([row for row in group if could_be_asked_for(row, asked)], asked)
    fit = [row for row in fit if qualifies(row, asked)]
    assert {row["encoding"] for row in group if not row["left_out"]} == {row["encoding"] for row in fit}, asked
    best = [row["encoding"] for row in group if "best" in (row["place"] or "").split(", ")]
    could_be = [row["encoding"] for row in taken(fit)]
    assert len(best) == bool(fit) and set(best) <= set(could_be), (asked, best, could_be)
    for row in fit:
        figures = {code["encoding"]: (round(loss(code, asked["aim"]), 1), paid(code), code["bits"]) for code in fit}
        own = figures[row["encoding"]]
        beaten = [name for name, other in figures.items() if other != own and all(map(le, other, own))]
        assert row["front"] == (not beaten), (asked, row["encoding"], beaten)


def test_no_encoding_changes_the_order_of_two_other_encodings():
    """If any encoding is removed, the others that pass the veto keep their order. Questions about images are asked
    about angles instead, because ties between images depend on the best encoding."""
    chance = random.Random(1)
    for _ in range(40):
        asked = asked_at_random(chance)
        asked["aim"] = "angle" if asked["aim"] == "image" else asked["aim"]
        given = [row | asked | for_readers(row, asked["readers"]) for row in rows_at_random(chance)]
        for group in groups(answered(given)).values():
            whole = [row["encoding"] for row in group if not row["left_out"]]
            for gone in whole:
                left = answered([row for row in group if row["encoding"] != gone])
                there = [row["encoding"] for row in left if not row["left_out"] and row["encoding"] in whole]
                assert there == [name for name in whole if name != gone], (asked, gone)


# As they were measured in rg8, to four digits.
MEASURED = (
    row_of("octahedral", "rg8", angle_mean_deg=0.3341, angle_max_deg=0.8954, angle_sup_deg=0.9532)
    | {"angle_axes_deg": 0.3203, "bits": 16, "encode_slots": 14, "decode_slots": 16, "slots_once": 30, "slots": 78},
    row_of("hemi_octahedral", "rg8", angle_mean_deg=32.82, angle_max_deg=180.0, bits=16),
    row_of("xy", "rg8", angle_mean_deg=32.92, angle_max_deg=180.0, bits=16),
)


def test_the_sentences_give_the_figures_of_the_rows():
    answer, first, second, *rest = sentences(answered(MEASURED))
    assert answer.startswith("rg8, on sphere: take octahedral."), answer
    assert "Mean error 0.334°, largest 0.953°." in first, first
    assert "1.9 and 5.4 texels of a 1k" in first, first  # of 360 degrees, for twice each angle
    assert "Axis-aligned floors and walls are off by up to 0.32°" in first, first
    assert "14 issue slots to encode and 16 to decode on navi21" in second and "16 bits" in second, second
    lost = "hemi_octahedral, xy (cannot represent normals that point away (z < 0): 50% of the set)"
    assert any(lost in text for text in rest), rest


def test_a_reflection_that_moves_far_has_no_distance():
    """A hole of 50 degrees moves the reflection by 100: no tangent gives its distance."""
    far = [row | {"angle_max_deg": 50.0, "angle_sup_deg": 50.0, "accept_holes": True} for row in MEASURED]
    group = answered(far)
    assert "at most 100°: it shows a different place." in sentences(group)[1], sentences(group)


# What a senior graphics engineer takes, by the words of the question; and a rung or a hint that he expects.
EXPECTED = {
    "--storage rg8": ("octahedral", "More accurate: octahedral_precise"),
    "--storage rg8 --aim worst": ("octahedral_precise", "More accurate: spherical_fibonacci"),
    "--storage rg8 --readers 1": ("octahedral", ""),
    "--storage rgb10a2": ("xyz_largest", "Fewer bits: octahedral,"),
    "--storage rg16": ("octahedral", ""),
    "--storage rg16 --aim worst": ("octahedral", ""),
    "--storage rg16 --aim cost": ("octahedral", ""),
    "--storage rg16_snorm": ("octahedral", ""),
    "--storage rg16_snorm --aim image": ("octahedral", ""),
    "--storage rg16f": ("octahedral", "In rg16, also 4 bytes, octahedral is 21 dB better"),
    "--storage rgba8": ("octahedral in rgb8_12_12", "In plain channels: best_fit, "),
    "--storage rg8 --domain tangent": ("hemi_octahedral", ""),
    "--storage rgba8 --needs filter": ("xyz_renormalised", "Inside a surface only: xyz_largest,"),
    "--storage rgb10a2 --needs blend": ("xyz_renormalised", "Inside a surface only: xyz_largest,"),
    "--storage rg8 --needs filter --domain map": ("hemi_octahedral", "It survives filter, inside a surface"),
    "--storage rg8 --needs resolve --domain view": ("", "Inside a surface only: cryengine3,"),
    "--bytes 4 --domain view": ("octahedral in rgb8_12_12", "In rg16_snorm, also 4 bytes, view_equal_area is"),
    "--storage rgb10a2 --enough 10": ("octahedral", "More accurate: xyz_largest, 8.1 dB better"),
    "--bytes 2": ("octahedral in rg8", ""),
    "--bytes 4": ("octahedral in rgb8_12_12", "More accurate: octahedral in rg16, 24.1 dB better"),
    "--storage rg8 --most-instructions 10": (
        "",
        "no encoding qualifies (at most 10 issue slots). - The nearest encoding without a hole is octahedral,",
    ),
}


# These are asked by day.
SOME = ("--storage rg8",)


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("words", SOME)
def test_the_answer_is_what_an_expert_expects(run, words):
    code, more = EXPECTED[words]
    status, out, err = run("pick", *words.split(), "--format", "markdown", "-v")
    text = " ".join(out.split())
    first = text.partition(". ")[0]
    assert status == (not code) and (f": take {code}" in first) == bool(code) and more in text, err + text


@pytest.mark.usefixtures("gl", "radv")
def test_an_encoder_only_in_glsl_is_compared_and_reported_to_lose_half(run, tmp_path):
    """On a hemisphere the encoder is measured once: --accept-holes changes the answer from the same rows."""
    path = tmp_path / "flat.glsl"
    path.write_text(ONE_WAY)
    words = ("pick", "--encoding", "octahedral", "--storage", "rg8", "--count", "4096", "--scene", "studio")
    words = (*words, "--against", str(path))
    status, out, _ = run(*words)
    assert (
        status == 0
        and "flat does not qualify: cannot represent normals that point away (z < 0): 50% of the set"
        in " ".join(out.split())
    ), out
    status, out, _ = run(*words, "--domain", "tangent", "--format", "json")
    rows = json.loads(out)
    assert status == 0 and {row["encoding"] for row in rows} == {"octahedral", "flat"}
    text = " ".join(sentences(answered(rows)))
    assert "flat does not qualify: a hole" in text and "--accept-holes" in text, text
    text = " ".join(sentences(answered([row | {"accept_holes": True} for row in rows])))
    assert "on hemisphere: take octahedral" in text and "flat: flat, 2.7 dB worse" in text, text


@pytest.mark.usefixtures("gl", "radv", "rows_are_shared")
def test_each_rounding_gets_its_own_answer(run, tmp_path):
    """Truncation doubles the errors; an encoding with precise rounding is not truncated."""
    words = ["--encoding", "octahedral,octahedral_precise", "--storage", "rg8", "--count", "4096", "--scene", "room"]
    words += ["--power", "47", "--rounding", "nearest,truncate", "--aim", "worst", "--images", str(tmp_path)]
    status, out, err = run("pick", *words, "--format", "json")
    asked = [row for row in json.loads(out) if not row["beside"]]
    by_code = {(row["encoding"], row["rounding"]): row for row in asked}
    assert status == 0 and err.count("\n") == 2 and "octahedral_precise: it supports only precise rounding" in err
    assert len(asked) == len(by_code) == 3 and ("octahedral_precise", "truncate") not in by_code
    nearest, cut = (by_code["octahedral", rounding] for rounding in ("nearest", "truncate"))
    for figure in ("angle_mean_deg", "angle_sup_deg"):
        assert cut[figure] / nearest[figure] == pytest.approx(2, rel=0.03), figure
    # On floors and walls the codes of both ways are as far off.
    decibels = [json.loads(row["image_classes"])["room_47"]["glossy"] for row in (nearest, cut)]
    assert decibels[0] - decibels[1] == pytest.approx(6, abs=1)
    groups_of = [group for group in groups(asked).values() if group[0]["rounding"] == "truncate"]
    (text,) = (" ".join(sentences(group)) for group in groups_of)
    assert text.startswith("rg8 with truncate rounding, on sphere: take octahedral.")
    assert "roughness --encoding octahedral --storage rg8 --rounding truncate" in text
    names = {path.name for path in tmp_path.iterdir()}
    assert {f"pick-room-power47-octahedral-rg8{way}-final.png" for way in ("", "-truncate")} < names


def test_measurements_are_kept_and_reused_only_for_the_same_normals(run, monkeypatch, tmp_path):
    """A second answer measures nothing; another number of normals is measured."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    measured = []
    whole = measure.quality.rows
    monkeypatch.setattr(measure.quality, "rows", lambda cases, tick: whole(noted(cases), tick))

    def noted(cases):
        measured.extend(case.codec.name for case in cases)
        return cases

    words = ("pick", "--encoding", "octahedral,xy_sign", "--storage", "rg8", "--count", "4096")
    first = run(*words)[1]
    once = len(measured)
    assert measured[:4] == [
        f"{name}/{storage}" for storage in ("rg8", "rg8_snorm") for name in ("octahedral", "xy_sign")
    ]
    assert run(*words)[1] == first and len(measured) == once
    run(*words[:-1], "8192")
    assert len(measured) == once + 4 and cache.folder().is_relative_to(tmp_path)


@pytest.mark.usefixtures("gl", "radv", "nvidia")
def test_the_most_expensive_family_determines_the_cost(run):
    """An NVIDIA GPU is counted in a compute shader; a family can be given by its common name."""
    words = ("pick", "--encoding", "octahedral", "--storage", "rg8", "--count", "4096", "--format", "json")
    rows = {}
    for families in ("navi21", "turing", "navi21,turing"):
        status, out, err = run(*words, "--family", families)
        assert status == 0, err
        (rows[families],) = [row for row in json.loads(out) if row["storage"] == "rg8"]
    assert rows["turing"]["dearest_family"] == rows["navi21,turing"]["dearest_family"] == "sm_75"
    assert rows["navi21,turing"]["slots"] == rows["turing"]["slots"] > rows["navi21"]["slots"]
