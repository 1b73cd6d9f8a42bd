"""The view Codecs: a list of all codecs, and everything about one codec in a card, from the run's rows."""

import json
import time
from contextlib import closing
from http.server import BaseHTTPRequestHandler, HTTPServer
from threading import Thread

import pytest
from browsing import Opened, no_fingers, no_paper
from languages import SHORT
from test_pictures import pick_row
from test_report import a_run, quality_row

from normalbench.bench.door import run_code
from normalbench.bench.keep.runs import read_run
from normalbench.bench.show.kept_code import FILE, read_code
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.reports.tables import text_of

QUALITY = [
    quality_row("octahedral", psnr_db=49.85, angle_mean_deg=0.29, angle_max_deg=0.92),
    quality_row("octahedral", psnr_db=1.0, backend="glsl"),
    quality_row("spheremap", psnr_db=48.73, angle_mean_deg=0.33, angle_max_deg=1.31),
    quality_row("stereographic", psnr_db=45.5, angle_mean_deg=0.41, angle_max_deg=0.95),
    quality_row("mine", psnr_db=50.5, angle_mean_deg=0.27, angle_max_deg=0.9),
    quality_row("octahedral", storage="rgb10a2", bits=20, psnr_db=61.57, angle_mean_deg=0.0756, angle_max_deg=0.237),
    quality_row("spheremap", storage="rgb10a2", bits=20, psnr_db=60.64, angle_mean_deg=0.0862, angle_max_deg=0.348),
]


CODES = (("octahedral", 0.3355, 30), ("spheremap", 0.4918, 17), ("xy", 0.9, 9))


ANSWER = [pick_row(*code) | {"rounding": "nearest"} for code in CODES]


@pytest.fixture(scope="module")
def codecs_page(tmp_path_factory):
    from normalbench.bench.show.report import write_report

    folder = a_run(tmp_path_factory.mktemp("codecs") / "run", {"pick": ANSWER, "quality": QUALITY})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run_code, "LANGUAGES", SHORT)
        run_code.keep_code(folder, read_run(folder))
    return write_report(folder, read_run(folder), folder / "report.html")


@pytest.mark.parametrize("damage", ["{", '{"languages": {}, "pieces": [], "codecs": 1}', "one place too far"])
def test_damaged_stored_code_is_left_out(codecs_page, tmp_path, damage):
    kept = json.loads((codecs_page.parent / FILE).read_text())
    assert read_code(codecs_page.parent)["codecs"]["octahedral rg8"]["proven"]
    if damage.startswith("one"):
        kept["pieces"].pop()
        damage = json.dumps(kept)
    (tmp_path / FILE).write_text(damage)
    assert read_code(tmp_path) == {}


@pytest.fixture(scope="module")
def shown(browser, codecs_page):
    page = Opened(browser, codecs_page, fragment="#v1/codecs")
    yield page
    assert page.said == [] and page.asked == [codecs_page.as_uri()]
    page.context.close()


def card_of(shown: Opened, a: str, b: str = ""):
    """Return the card once it shows A and B."""
    shown.page.evaluate("sides => change({ view: 'codecs', at: '', ...sides })", {"a": a, "b": b})
    card = shown.page.locator("[data-card]")
    shown.page.wait_for_selector(f'[data-card][data-ready="{a}"]')
    card.locator("details").evaluate_all("all => all.forEach((one) => (one.open = true))")
    return card


def domain_of(encoding: str) -> str:
    return ENCODINGS[encoding].domain if encoding in ENCODINGS else "sphere"


def ordinal(rank: int) -> str:
    return {1: "1st", 2: "2nd", 3: "3rd"}.get(rank, f"{rank}th")


CARDS = [("octahedral rgba8", 0), ("spheremap rgb10a2", 6)]


@pytest.mark.parametrize(("name", "at"), CARDS)
def test_card_has_the_figures_and_ranks_of_the_run(shown, name, at):
    """The figures are from the first backend, ranked among codecs of equal bit count, including the user's own."""
    card, row = card_of(shown, name), QUALITY[at]
    alike = [other for other in QUALITY if other["bits"] == row["bits"] and other["backend"] == "jax"]
    alike = [other for other in alike if domain_of(other["encoding"]) == domain_of(name.split()[0])]
    for figure, sign in (("psnr_db", -1), ("angle_mean_deg", 1), ("angle_max_deg", 1)):
        rank = 1 + sum(sign * other[figure] < sign * row[figure] for other in alike)
        cell = card.locator(f'[data-table=quality] [data-figure="{figure}"]')
        place = f"\n{ordinal(rank)} of {len(alike)}" if len(alike) > 3 else ""
        assert cell.text_content() == f"{text_of(row[figure])}{place}", figure
        alone = "no codec to compare with"
        title = f"{ordinal(rank)} of {len(alike)} at {row['bits']} bits" if len(alike) > 1 else alone
        assert cell.get_attribute("title") == title
        best = (min if sign > 0 else max)(other[figure] for other in alike)
        share = float(cell.evaluate("cell => cell.style.getPropertyValue('--share')"))
        assert share == pytest.approx(best / row[figure] if sign > 0 else row[figure] / best), figure


def test_b_is_in_the_same_table(shown):
    card = card_of(shown, "octahedral rgba8", "spheremap rgba8")
    rows = card.locator("[data-table=quality] tbody tr")
    assert rows.locator("th").all_text_contents() == ["A", "B"]
    cells = rows.locator("[data-figure=psnr_db]").all_text_contents()
    assert [float(text.split("\n")[0]) for text in cells] == [49.85, 48.73]


def test_card_shows_figures_of_identical_values_with_a_note(shown):
    """RG8 has the first two channels of RGBA8. RGB10A2 has other channels, and rows of its own."""
    card = card_of(shown, "octahedral rg8")
    text = card.inner_text()
    assert "Not measured: octahedral rg8. The figures are for octahedral rgba8, which stores identical values" in text
    psnr = card.locator("[data-table=quality] [data-figure=psnr_db]")
    assert psnr.text_content().split("\n")[0] == "49.85"
    slots = card.locator("[data-table=pick] [data-figure=slots]")
    assert slots.get_attribute("title") == "2nd of 2 at 16 bits", "not among codes of half of the sphere"
    assert slots.text_content() == "30", "a place among two says nothing"
    assert "normalbench run --tables quality --encoding octahedral --storage rgba8" in text
    assert "Q. Meyer et al." in text and "p = n.xy / (|n.x| + |n.y| + |n.z|)" in text and "In rg8: volo" in text
    assert "Not measured:" not in card_of(shown, "octahedral rgb10a2").inner_text()


def test_copied_code_matches_the_output_of_the_code_command(shown, run):
    """The answer's code was run. For other codecs the header says that the code was not run, and the functions are
    the same."""
    shown.context.grant_permissions(["clipboard-read", "clipboard-write"])
    card = card_of(shown, "octahedral rg8")
    assert card.locator("[data-language] option").all_text_contents() == [language.title for language in SHORT.values()]
    card.locator("[data-language]").select_option("c")
    card.locator("[data-copy=code]").click()
    card.locator("[role=status]:text-is('Copied')").wait_for()
    status, written, _ = run("code", "octahedral", "--storage", "rg8", "--to", "c")
    assert status == 0 and "Verified: " in written
    assert shown.page.evaluate("navigator.clipboard.readText()") == written
    card = card_of(shown, "spheremap rgb10a2")
    card.locator("[data-language]").select_option("c")
    code = card.locator("[data-code]").text_content()
    assert "Verified: not in this run" in code and "The code was not run." in card.inner_text()
    _, written, _ = run("code", "spheremap", "--storage", "rgb10a2", "--to", "c")
    assert code.partition("#ifndef")[2] == written.partition("#ifndef")[2]


def test_the_code_of_a_is_also_below_the_answer(browser, codecs_page):
    page = Opened(browser, codecs_page, fragment="#v1/choose?a=octahedral%20rg8")
    below = page.page.locator("[data-of-cards=code]")
    assert below.locator("[data-code]").count() == 0, "nothing is built before it is opened"
    below.locator("summary").click()
    kept = read_code(codecs_page.parent)
    first, *_ = kept["codecs"]["octahedral rg8"]["texts"].values()
    page.says("[data-of-cards=code] h3", "octahedral rg8")
    assert below.locator("[data-code]").text_content() == "".join(kept["pieces"][index] for index in first)
    page.page.evaluate("change({ a: 'spheremap rgb10a2' })")
    page.says("[data-of-cards=code] h3", "spheremap rgb10a2")
    assert page.said == []
    page.context.close()


def test_card_names_a_users_own_encoding_and_asks_for_a_codec(shown):
    assert "Your own encoding, mine" in card_of(shown, "mine rgba8").inner_text()
    shown.page.evaluate("change({ a: '', b: '' })")
    shown.says("[data-card]", "Choose a codec in the list")


def test_unknown_codec_is_reported_and_the_users_own_card_is_shown(browser, codecs_page):
    page = Opened(browser, codecs_page, fragment="#v1/codecs?a=nothing%20rg8")
    page.says("#unknown", "The address names the codec nothing rg8, which this page does not have.")
    page.page.wait_for_selector('[data-card][data-ready="mine rgba8"]')
    # A user's own encoding stands against the answer.
    assert page.page.evaluate("[known.a, known.b]") == ["mine rgba8", "octahedral rg8"]
    page.context.close()


def test_address_is_kept_if_the_last_script_arrives_late(browser, codecs_page):
    """A page that loads slowly unpacks its choices before it reads its address."""
    beginning, script, end = codecs_page.read_bytes().rpartition(b"<script>")

    class Slowly(BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.end_headers()
            self.wfile.write(beginning)
            time.sleep(1)
            self.wfile.write(script + end)

    with HTTPServer(("127.0.0.1", 0), Slowly) as server, closing(browser.new_page()) as page:
        Thread(target=server.serve_forever, daemon=True).start()
        page.goto(f"http://127.0.0.1:{server.server_port}/#v1/codecs?a=octahedral%20rg8")
        assert page.evaluate("[state.view, state.a]") == ["codecs", "octahedral rg8"]
        server.shutdown()


def test_the_list_is_filtered_and_sorted(shown):
    card_of(shown, "octahedral rg8")
    rows = shown.page.locator("[data-card-list] tbody tr")
    names = shown.page.evaluate("known.codecs")
    assert rows.count() == len(names) == 9
    means = rows.locator("td:nth-child(4)").all_text_contents()
    keys = [("only" in text, "playground" in text, float(text.split("°")[0])) for text in means]
    assert keys == sorted(keys) and keys[-1][0], "by error; other sets, then codes of half of the sphere last"
    shown.page.get_by_label("Filter").first.fill("spheremap")
    left = rows.locator("visible=true").locator("th").all_text_contents()
    assert sorted(left) == [name for name in names if "spheremap" in name]
    shown.page.get_by_label("Filter").first.fill("")
    shown.page.locator("[data-card-list] thead button", has_text="mean").click()
    means = rows.locator("td:nth-child(4)").all_text_contents()
    degrees = [float(text.split("°")[0]) for text in means]
    assert degrees == sorted(degrees) and degrees[0] == 0.0756, degrees


@no_fingers
def test_touch_chooses_a_and_b(browser, codecs_page):
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, offline=True)
    page = context.new_page()
    page.goto(f"{codecs_page.as_uri()}#v1/codecs")
    page.locator('[data-take=b][value="stereographic rgba8"]').first.tap()
    page.locator('[data-take=a][value="spheremap rgba8"]').first.tap()
    assert page.evaluate("[state.a, state.b]") == ["spheremap rgba8", "stereographic rgba8"]
    page.wait_for_selector('[data-card][data-ready="spheremap rgba8"]')
    pressed = page.locator("[data-card-list] [data-take][aria-pressed=true]")
    assert sorted(take.get_attribute("value") for take in pressed.all()) == ["spheremap rgba8", "stereographic rgba8"]
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    context.close()


@no_paper
def test_a_page_of_ones_own_begins_with_it_and_one_click_leads_to_its_card(browser, codecs_page):
    page = Opened(browser, codecs_page)
    assert page.page.evaluate("[state.view, state.a, state.b]") == ["compare", "mine rgba8", "octahedral rg8"]
    group = page.page.locator("[data-compare] [data-group]").first
    group.wait_for()
    assert group.bounding_box()["y"] < 900, "on the first screen"
    page.page.locator("nav [data-to=codecs]").click()
    page.page.wait_for_selector('[data-card][data-ready="mine rgba8"]')
    assert page.page.locator("#card-h").is_visible()
    row = page.page.locator('[data-card-list] tr[data-codec="mine rgba8"]')
    assert row.evaluate("row => row.offsetTop >= row.closest('.scroll').scrollTop")
    page.page.locator("nav [data-to=choose]").click()
    page.page.wait_for_selector("[data-card]:empty", state="attached")
    page.page.emulate_media(media="print")
    assert not page.page.locator("#cards").is_visible(), "paper has no empty card"
    page.context.close()


@no_paper
def test_a_folded_section_is_opened_and_scrolled_to(browser, codecs_page):
    """The section opens both before and after the card is shown."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, offline=True, reduced_motion="reduce")
    page = context.new_page()
    place = "id => document.getElementById(id).getBoundingClientRect().top - navigation.getBoundingClientRect().bottom"
    for fragment in ("#v1/codecs?at=angles", "#angles"):
        page.goto("about:blank")
        page.goto(f"{codecs_page.as_uri()}{fragment}")
        page.wait_for_selector("[data-card][data-ready]", state="attached")
        page.wait_for_timeout(200)
        assert page.locator("#angles details.subject").get_attribute("open") == "", fragment
        assert page.locator("#quality details.subject").get_attribute("open") is None, "the others stay closed"
        left = page.evaluate("document.documentElement.scrollHeight - innerHeight - scrollY")
        assert abs(page.evaluate(place, "angles") - 12) < 10 or left <= 1, fragment
    page.locator("#angles .plot svg").first.wait_for()
    plot = page.locator("#angles .plot").first
    drawn = plot.locator("svg").get_attribute("viewBox").split()[2]
    assert float(drawn) == pytest.approx(plot.bounding_box()["width"], abs=1.5), "drawn at the size that it is seen in"
    page.emulate_media(media="print")
    assert not page.locator("#quality").is_visible(), "what is folded takes no paper"
    context.close()
