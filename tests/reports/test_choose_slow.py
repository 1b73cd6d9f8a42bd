"""The page's answer for a reader's constraints, which matches the answer of `pick` to the letter."""

import json
import re

import numpy as np
import pytest
from browsing import PHONE, Opened, no_paper
from test_pictures import pick_row
from test_pictures_slow import answered_run
from test_report import a_run

from normalbench.bench.keep.runs import read_run
from normalbench.bench.show.report import write_report
from normalbench.bench.tables.mix.table import USES
from normalbench.bench.tables.pick.answer import answered
from normalbench.bench.tables.pick.choices import CONSTANTS, extras
from normalbench.bench.tables.pick.sentences import told
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS

SETS = 150


ASK = """([questions, constants]) => questions.map(([question, asked]) => {
  const found = answerOf(question, asked, constants);
  return [sentenceOf(question, asked, found), found.fit.map(({ codec }) => codec)];
})"""


def made_up_rows(rng: np.random.Generator, needs: str | None, aim: str = "angle") -> list[dict]:
    """Return rows of a question as a run keeps them: costs and errors with few different values, so that many are
    equal, and encodings of every kind that is left out."""
    usual = {
        "asked": "rgb10a2",
        "needs": needs,
        "normals": needs or "sphere",
        "scene": "studio",
        "aim": aim,
        "bytes": 4,
        "rounding": "nearest",
    }
    usual |= {
        "readers": 4,
        "worth": 3.0,
        "enough": 0.35,
        "against": False,
        "accept_holes": False,
        "accept_lengths": False,
        "look_ups": True,
        "family": "navi21",
    }
    rows = []
    for name in ENCODINGS:
        for storage in ("rgb10a2", "rgb8_10_10_2", "rg16"):
            if rng.random() < 0.3:
                continue
            encode, decode = rng.choice([0, 5, 14, 16, 20, 36, 64, 115.5, 289], 2)
            is_priced, mean = rng.random() < 0.9, float(0.02 * 2 ** (rng.integers(0, 24) / 4))
            largest = mean * float(rng.choice([2, 3, 30]))
            rows.append(
                TABLES["pick"].empty()
                | usual
                | {"encoding": name, "storage": storage, "beside": storage == "rg16", "packed": "_" in storage}
                | {"angle_mean_deg": mean, "angle_max_deg": largest, "worst_normal": "(1.0, 0.0, 0.0)"}
                | {"angle_sup_deg": largest * 1.1 if rng.random() < 0.3 else None}
                | {
                    "encode_slots": float(encode) if is_priced else None,
                    "decode_slots": float(decode) if is_priced else None,
                }
                | {"slots_once": float(encode + decode) if is_priced else None}
                | {"slots": float(encode + 4 * decode) if is_priced else None}
                | {
                    "bits": int(rng.choice([20, 24, 30])),
                    "free_bits": int(rng.integers(0, 3)),
                    "table": rng.random() < 0.1,
                }
                | {
                    "domain": str(rng.choice(["sphere"] * 9 + ["hemisphere"])),
                    "length_share": float(rng.choice([0, 0.7], p=[0.9, 0.1])),
                }
                | {"invalid": int(rng.random() < 0.03), "code_bits": 10.0 if rng.random() < 0.05 else None}
                | images_at_random(rng)
                | {"image_lost_percent": 3.0 if rng.random() < 0.05 else None, "image_lost_scene": "studio"}
            )
            rows[-1] |= surveyed(rng, mean, float(encode), float(decode))
            rows[-1]["by_family"] = rows[-1]["by_family"] if is_priced else None
            if rows[-1]["domain"] == "hemisphere":
                rows[-1]["lost_percent"] = 0.0 if needs else 50.0
    return rows


def images_at_random(rng: np.random.Generator) -> dict:
    """Return errors of two images at some yaws, around levels of 3 dB, so that many tie; about a quarter of the rows
    have none."""
    if rng.random() < 0.25:
        return {"image_db_studio": None, "image_db_room": None}
    level, spread, count = 10 ** (-0.3 * rng.integers(6, 26)), rng.choice([0.02, 0.5]), rng.choice([4, 6])
    errors = {name: {"y": list(level * np.exp(spread * rng.standard_normal(count)))} for name in ("studio", "room")}
    row = {f"image_db_{name}": -10 * np.log10(np.mean(of["y"])) for name, of in errors.items()}
    return row | {"image_pole": "y", "image_errors": json.dumps(errors)}


def asked_at_random(rng: np.random.Generator) -> dict:
    return {
        "most_instructions": [None, None, *range(0, 60, 5), 100, 300][rng.integers(16)],
        "readers": int(rng.integers(0, 9)),
        "worth": float(rng.choice([0.5, 1.0, 3.0, 6.0])),
        "enough": float(rng.choice([0.0, 0.1, 360 / 1024, 1.0, 5.0])),
        "accept_holes": bool(rng.integers(2)),
        "accept_lengths": bool(rng.integers(2)),
        "look_ups": bool(rng.integers(4)),
        "mixing": [None, None, None, "filter", "blend,upsample", "filter,blend,resolve"][rng.integers(6)],
        "family": ["navi21", "navi21", "polaris10"][rng.integers(3)],
    }


def surveyed(rng: np.random.Generator, mean: float, encode: float, decode: float) -> dict:
    """Return the columns that a survey adds to a row."""
    uses = {
        use: {
            "cannot": f"cannot be {use}ed" if rng.random() < 0.3 else "",
            "count": int(rng.integers(1, 5)),
            "sum": float(mean * rng.choice([0.5, 2, 8])),
            "max": float(mean * rng.choice([3, 9])),
        }
        for use in USES
    }
    return {"by_use": json.dumps(uses), "by_family": json.dumps({"polaris10": [encode * 2, decode + 5]})}


def as_asked(row: dict, asked: dict) -> dict:
    """Return a row as `pick` would have measured it for these constraints."""
    asked_row = row | asked
    if asked["family"] != row["family"] and row["slots"] is not None:
        encode, decode = json.loads(row["by_family"])[asked["family"]]
        asked_row |= {"encode_slots": encode, "decode_slots": decode, "slots_once": encode + decode}
        asked_row |= {"slots": encode + 4 * decode}
    if asked["mixing"] and row["by_use"]:
        uses = [json.loads(row["by_use"])[use] for use in asked["mixing"].split(",")]
        reasons = [f"{use['cannot']}: why" for use in uses if use["cannot"]]
        asked_row |= {"cannot_mix": "; ".join(reasons) or None, "mixed_max_deg": max(use["max"] for use in uses)}
        asked_row |= {"mixed_mean_deg": sum(use["sum"] for use in uses) / sum(use["count"] for use in uses)}
    return asked_row | {"slots": _slots(asked_row, asked["readers"])}


def test_the_page_gives_the_answer_of_pick_for_any_constraints(opened, tmp_path):
    rng = np.random.default_rng(11)
    pairs, expected = [], []
    for i in range(SETS):
        if i % 25 == 0:
            rows = made_up_rows(rng, needs=(None, "hemisphere")[i // 25 % 2], aim=("angle", "image")[i // 50 % 2])
            (question,) = extras(tmp_path, {"pick": rows}, [])["choices"]["questions"]
        asked = asked_at_random(rng)
        # A price in the rows is that of their own readers.
        own = [as_asked(row, asked) for row in rows]
        ranked = answered(own)
        pairs.append([question, asked])
        fit = [f"{row['encoding']} {row['storage']}" for row in ranked if not row["left_out"] and not row["beside"]]
        expected.append([told(ranked)[0], fit])
    replies = opened.page.evaluate(ASK, [pairs, CONSTANTS])
    wrong = [(reply, other) for reply, other in zip(replies, expected, strict=True) if reply != other]
    assert not wrong, f"{len(wrong)} of {SETS}: {wrong[0]}"
    answers = {sentence for sentence, _ in expected}
    assert (
        len(answers) > 50
        and any("no encoding qualifies" in answer for answer in answers)
        and any("In rg16" in answer for answer in answers)
        and any("on hemisphere: take" in answer for answer in answers)
        and any("on hemisphere: no encoding qualifies" in answer and "for hemisphere" in answer for answer in answers)
    )


def _slots(row: dict, readers: int) -> float | None:
    return None if row["slots"] is None else row["encode_slots"] + readers * row["decode_slots"]


@pytest.fixture(scope="module")
def answered_page(tmp_path_factory):
    """The page of a run that answers a question."""
    folder = answered_run(tmp_path_factory.mktemp("answered") / "run")
    return write_report(folder, read_run(folder), folder / "report.html")


def test_constraints_change_the_answer_the_count_and_the_address(browser, answered_page):
    """The keyboard changes the constraints. The run's constraints are not in the address; a button restores them."""
    page = Opened(browser, answered_page, fragment="#v1/choose")
    page.says("[data-left]", "encodings are left")
    left, codes = page.page.locator("[data-left]"), page.page.locator("[data-codes] tbody tr")
    assert left.text_content() == "2 of 2 encodings are left" and codes.count() == 2
    assert page.page.locator(".reply:visible .lead").all_text_contents() == ["rg8, on sphere: take fine."]
    most = page.page.locator("[data-limit=most]")
    page.page.locator(".menu summary").last.click()
    most.focus()
    page.page.keyboard.type("6")
    assert left.text_content() == "1 of 2 encodings are left" and codes.count() == 1
    assert page.page.locator(".reply:visible .lead").all_text_contents() == ["rg8, on sphere: take xy."]
    assert page.page.evaluate("location.hash") == "#v1/choose?most=6"
    page.says("[data-of='choose-0'] [data-finding]", "rg8, on sphere: 1 of 1 eligible encodings are Pareto-optimal")
    plot = page.page.locator("[data-of='choose-0'] .plot:has(svg)")
    points = "(plot) => Object.fromEntries(charts.views.get(plot).tables.flat().map((row) => [row.codec, row.rest]))"
    assert plot.evaluate(points) == {"fine rg8": True, "xy rg8": False}
    page.page.locator("[data-part=of]").select_option("rgb10a2")
    assert page.page.locator(".reply:visible .lead").all_text_contents() == ["rgb10a2, on sphere: take xy."]
    # A copied address shows the same.
    other = Opened(browser, answered_page, fragment=page.page.evaluate("location.hash"))
    for opened_page in (page, other):
        opened_page.says("[data-left]", "1 of 2 encodings are left")
        assert opened_page.page.locator("[data-limit=most]").input_value() == "6"
    other.context.close()
    page.page.locator("[data-again]").click()
    assert page.page.evaluate("state.most") == "" and left.text_content() == "2 of 2 encodings are left"
    most.fill("1")
    assert (
        page.page.locator(".reply:visible .lead")
        .text_content()
        .endswith("no encoding qualifies (at most 1 issue slots).")
    )
    width, height = PHONE
    page.page.set_viewport_size({"width": width, "height": height})
    assert page.page.evaluate("document.documentElement.scrollWidth") == width, "nothing is wider than a phone"
    page.page.locator("[data-codes] summary").click()
    assert "more than 1 issue slots" in page.page.locator("[data-codes] details").text_content()
    assert page.said == []
    page.context.close()


def test_a_follows_the_answer_until_a_reader_chooses_a_codec(browser, answered_page):
    """The card and its code to copy are therefore for the answer. A reader's choice is kept in the address."""
    page = Opened(browser, answered_page, fragment="#v1/choose")
    page.says("[data-left]", "encodings are left")
    most, sides = page.page.locator("[data-limit=most]"), "[state.a, state.b]"
    page.page.locator(".menu summary").last.click()
    assert page.page.evaluate(sides) == ["fine rg8", "xy rg8"]
    most.fill("6")
    assert page.page.evaluate(sides) == ["xy rg8", "fine rg8"]
    assert page.page.evaluate("location.hash") == "#v1/choose?most=6"
    page.page.evaluate("choose('fine rg8')")
    assert page.page.evaluate(sides) == ["fine rg8", "xy rg8"]
    address = page.page.evaluate("location.hash")
    assert address == "#v1/choose?most=6&a=fine%20rg8"
    most.fill("")
    most.fill("6")
    assert page.page.evaluate(sides) == ["fine rg8", "xy rg8"] and page.said == []
    page.context.close()
    copied = Opened(browser, answered_page, fragment=address)
    copied.says("[data-left]", "encodings are left")
    assert copied.page.evaluate(sides) == ["fine rg8", "xy rg8"]
    copied.context.close()


def test_the_answer_shows_reflections_cost_and_bits(browser, tmp_path):
    """Of two thresholds, the looser is acceptable and the stricter invisible. On a phone the answer is in the upper
    half of the screen."""
    decided = {"encoding": "octahedral", "storage": "rg8", "rounding": "nearest", "object": "panel20", "decides": True}
    decided |= {"environment": "lamp", "dither": "none", "frames": 1}
    metal = [decided | {"threshold": limit, "roughness": rough} for limit, rough in (("0.1", 0.49), ("0.05", 0.62))]
    plaster = [row | {"object": "plaster", "environment": "sun", "roughness": 0.0} for row in metal]
    rows = [pick_row("octahedral", 0.2, 9) | {"angle_sup_deg": 1.0}, pick_row("spheremap", 0.3, 10)]
    tables = {"pick": rows, "roughness": [TABLES["roughness"].empty([]) | row for row in (*plaster, *metal)]}
    folder = a_run(tmp_path / "run", tables, request={"tables": ["pick", "roughness"]})
    width, height = 390, 844
    page = Opened(browser, write_report(folder, read_run(folder), folder / "report.html"), (width, height))
    page.says("[data-tiles]", "issue slots")
    assert page.texts("[data-tiles] dt") == ["Acceptable reflections", "Cost", "Bits"]
    assert page.texts("[data-tiles] dd:not(.note)") == ["from roughness 0.49", "9 + 0 issue slots", "16"]
    assert page.texts("[data-tiles] .note")[0] == (
        "Invisible from roughness 0.62. Worst case: panel20 under lamp. "
        "A mirror's reflection moves by at most 2\N{DEGREE SIGN}."
    )
    box = page.page.locator(".reply:visible .lead").bounding_box()
    assert box["y"] + box["height"] <= height / 2, box
    page.page.locator(".menu summary").last.click()
    page.page.locator("[data-limit=most]").fill("1")
    page.says(".reply:visible .lead", "no encoding qualifies")
    assert page.texts("[data-tiles] dt") == [] and page.said == []
    page.context.close()


def test_the_tab_is_called_after_the_answer_or_the_codecs_that_are_shown(browser, answered_page):
    page = Opened(browser, answered_page, fragment="#v1/choose")
    page.says("[data-left]", "encodings are left")
    titles = {"choose": "rg8, on sphere: fine", "compare": "fine rg8 against xy rg8", "data": "Data"}
    for view, title in titles.items():
        page.page.evaluate("(view) => change({ view })", view)
        assert page.page.title() == f"{title} - normalbench"
        count = page.page.locator("h1").evaluate_all("all => all.filter((one) => one.checkVisibility()).length")
        assert count == 1, view
    page.context.close()


def test_compare_says_how_b_differs_in_a_sentence_and_what_a_code_cannot_hold(browser, tmp_path):
    lost = pick_row("hemi_octahedral", 30.0, 9) | {"domain": "hemisphere", "lost_percent": 50.0}
    known = {"angle_sup_deg": 1.0}
    rows = [
        pick_row("octahedral", 0.2, 10) | known,
        pick_row("spheremap", 0.3, 5) | known,
        lost,
        pick_row("cube", 0.1, 70),
    ]
    folder = a_run(tmp_path / "run", {"pick": rows}, request={"tables": ["pick"]})
    written = write_report(folder, read_run(folder), folder / "report.html")
    page = Opened(browser, written, fragment="#v1/compare?a=octahedral%20rg8&b=spheremap%20rg8")
    page.says("[data-compare] .subhead", "Compared with A, B has a 50% larger mean error")
    sentence = page.page.locator("[data-compare] .subhead").text_content()
    assert "the same largest error, the same cost with 4 decoding passes and" in sentence, sentence
    largest = page.page.locator("[data-compare] .pair-figures tbody tr", has_text="largest error").locator("td")
    page.page.evaluate("change({ b: 'cube rg8' })")
    page.says("[data-compare] .subhead", "has a mean error 2 times smaller, a 68% higher cost with 4 decoding passes")
    assert largest.all_text_contents() == ["1\N{DEGREE SIGN}", "\N{GREATER-THAN OR EQUAL TO} 1\N{DEGREE SIGN}"]
    assert "largest" not in page.page.locator("[data-compare] .subhead").text_content(), "only one is a supremum"
    page.page.evaluate("change({ b: 'hemi_octahedral rg8' })")
    page.says("[data-compare] .remark", "B, hemi_octahedral: ")
    assert page.page.locator("[data-compare] .pair-figures .best").count() == 0
    page.page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
    heights = page.page.locator(".pair-figures tbody tr").evaluate_all("all => all.map((one) => one.offsetHeight)")
    assert max(heights) < 80, f"{heights}: words stay whole on a phone"
    page.context.close()


@no_paper
def test_the_open_view_is_printed_on_at_most_three_pages(browser, answered_page):
    page = Opened(browser, answered_page, fragment="#v1/choose")
    page.says("[data-left]", "encodings are left")
    for view, needs in (("choose", "take fine"), ("compare", "mean error"), ("data", "")):
        page.page.evaluate("(view) => change({ view })", view)
        page.page.wait_for_timeout(300)
        page.page.emulate_media(media="print")
        assert needs in page.page.locator("main").inner_text(), view
        page.page.emulate_media(media="screen")
        pages = len(re.findall(rb"/Type\s*/Page\b", page.page.pdf(format="A4")))
        assert 1 <= pages <= 3, (view, pages)
    page.context.close()


def test_hemisphere_is_a_separate_question(browser, run, tmp_path):
    """The storage stays, and so do A and B if they use it. If the run does not answer this question for the storage,
    the page chooses another storage."""
    half = {"needs": "hemisphere", "normals": "hemisphere"}
    rows = [pick_row("octahedral", 0.2, 90), pick_row("spheremap", 0.3, 10)]
    rows += [row | {"asked": "rgb10a2", "storage": "rgb10a2"} for row in rows]
    rows += [rows[0] | half, pick_row("hemi_octahedral", 0.1, 90) | {"domain": "hemisphere"} | half]
    assert run("report", str(a_run(tmp_path / "run", {"pick": rows}, request={"tables": ["pick"]})))[0] == 0
    page = Opened(browser, tmp_path / "run/report.html")
    page.says("[data-left]", "encodings are left")
    of, on = (page.page.locator(f"[data-part={name}]") for name in ("of", "on"))
    assert on.locator("option").all_text_contents() == ["sphere", "hemisphere: normals with z >= 0"]
    on.select_option("hemisphere: normals with z >= 0")
    lead = page.page.locator(".reply:visible .lead")
    assert lead.all_text_contents() == ["rg8, on hemisphere: take hemi_octahedral."]
    assert page.page.evaluate("location.hash") == "#v1/choose?for=rg8%2C%20on%20hemisphere"
    of.select_option("rgb10a2")
    assert lead.all_text_contents()[0].startswith("rgb10a2, on sphere: take") and on.input_value() == "sphere"
    on.select_option("hemisphere: normals with z >= 0")
    assert lead.all_text_contents() == ["rg8, on hemisphere: take hemi_octahedral."] and of.input_value() == "rg8"
    assert page.said == []
    page.context.close()
