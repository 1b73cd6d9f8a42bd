"""Figures under a reader's hands: pointing, picking, keys, zoom, files and paper."""

import re
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest
from both_ways import rows_of_tables
from browsing import no_files
from test_drawn_charts import HOSTILE, a_front

from normalbench.bench.tables.registry import TABLES

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def drawn(chart_page):
    chart_page.put(a_front())
    return chart_page.page


def seen(page) -> set[str]:
    """The codecs of points that are not faint."""
    found = page.locator(".points").evaluate_all(
        "all => all.filter((one) => getComputedStyle(one).opacity === '1').map((one) => one.dataset.codec)"
    )
    return set(found)


def test_a_click_makes_a_codec_a_or_with_shift_b_and_the_rest_is_faint(drawn):
    for codec, keys, side in (("e7 rgba8", [], "a"), ("e8 rgba8", ["Shift"], "b")):
        drawn.locator(f".points[data-codec='{codec}']").click(modifiers=keys)
        assert drawn.evaluate(f"state.{side}") == codec
        names = drawn.locator(f"text.labels[data-codec='{codec}']")
        assert names.count() == 1 and names.is_visible(), "also a name for which there was no room"
    assert seen(drawn) == {"e7 rgba8", "e8 rgba8"}
    fills = drawn.locator(".points[data-codec='e7 rgba8'], .points[data-codec='e8 rgba8']").evaluate_all(
        "all => all.map((one) => getComputedStyle(one).fill)"
    )
    assert len(set(fills)) == 2, "A and B"
    drawn.locator(".points[data-codec='e7 rgba8']").click()
    drawn.locator(".points[data-codec='e8 rgba8']").click(modifiers=["Shift"])
    assert drawn.evaluate("[state.a, state.b]") == ["", ""] and len(seen(drawn)) == 42


def test_nothing_is_faint_where_a_chart_has_neither(drawn):
    drawn.evaluate("known.codecs.push('other rg8'); change({ a: 'other rg8' })")
    assert len(seen(drawn)) == 42


def test_a_line_through_several_codecs_is_of_none(drawn):
    codecs = drawn.locator(".lines").evaluate_all("all => all.map((one) => one.dataset.codec)")
    assert "" in codecs, codecs
    drawn.evaluate("change({ a: 'e1 rgba8' })")
    assert drawn.locator(".lines[data-codec='']").first.evaluate("one => getComputedStyle(one).opacity") < "1"


def test_an_encodings_name_stands_for_each_of_its_codecs_and_any_name_for_itself(drawn):
    drawn.evaluate("change({ a: 'e1' })")
    assert seen(drawn) == {"e1 rgba8", "e1 rgb10a2"}
    drawn.evaluate("(name) => change({ a: name, b: 'e2 rgba8' })", HOSTILE)
    assert seen(drawn) == {HOSTILE, "e2 rgba8"}


def test_no_two_names_overlap_in_a_cloud(drawn):
    found = drawn.locator("text.labels").evaluate_all(
        """all => all.filter((one) => getComputedStyle(one).display !== "none")
        .map((one) => one.getBBox()).map(({ x, y, width, height }) => [x, y, x + width, y + height])"""
    )
    assert len(found) > 30
    for at, (left, top, right, bottom) in enumerate(found):
        for others in found[at + 1 :]:
            apart = right <= others[0] or others[2] <= left or bottom <= others[1] + 2 or others[3] <= top + 2
            assert apart, (found[at], others)


def test_a_pointer_is_told_the_figures_and_leaves_nothing_behind(drawn):
    drawn.locator(".points[data-codec='e3 rgba8']").hover()
    assert drawn.locator(".tip dd").all_text_contents()[:2] == ["e3 rgba8", "24"]
    drawn.mouse.move(0, 0)
    drawn.locator(".tip").wait_for(state="detached")


def test_keys_go_from_mark_to_mark_and_say_it(drawn):
    plot, said = drawn.locator(".plot"), drawn.locator("[data-said]")
    plot.focus()
    for key, ending in (
        ("ArrowRight", 1),
        ("ArrowDown", 2),
        ("End", 42),
        ("ArrowRight", 42),
        ("Home", 1),
        ("ArrowUp", 1),
    ):
        drawn.keyboard.press(key)
        assert said.text_content().endswith(f"; {ending} of 42"), key
    assert said.get_attribute("role") == "status" and said.text_content().startswith("codec e")
    drawn.keyboard.press("Enter")
    assert drawn.evaluate("state.a") == said.text_content().split(",")[0].removeprefix("codec ")
    drawn.keyboard.press("Escape")
    assert drawn.locator(".tip").count() == 0


def test_a_chart_is_an_image_with_a_label(drawn):
    image = drawn.locator(".plot svg")
    assert image.get_attribute("role") == "img"
    assert image.get_attribute("aria-label").startswith("encode: Pareto-optimal:")
    assert drawn.locator(".plot").get_attribute("tabindex") == "0"


def test_the_wheel_zooms_where_the_focus_is_and_a_button_shows_all(drawn):
    plot, scale = drawn.locator(".plot"), "Array.from(charts.views.values())[0].zoom.k"
    box = plot.bounding_box()
    drawn.mouse.move(box["x"] + 300, box["y"] + 200)
    drawn.mouse.wheel(0, -300)
    assert drawn.evaluate(scale) == 1, "the page is scrolled instead"
    before = drawn.locator(".axis").first.text_content()
    plot.focus()
    drawn.mouse.wheel(0, -300)
    drawn.locator("[data-reset]:visible").wait_for()
    assert drawn.evaluate(scale) > 1
    drawn.evaluate("new Promise(requestAnimationFrame)")
    assert drawn.locator(".axis").first.text_content() != before
    drawn.locator("[data-reset]").click()
    assert drawn.evaluate(scale) == 1 and not drawn.locator("[data-reset]").is_visible()
    plot.focus()
    drawn.keyboard.press("+")
    assert drawn.evaluate(scale) == 1.5
    drawn.keyboard.press("0")
    assert drawn.evaluate(scale) == 1


@no_files
def test_a_file_is_what_is_seen_and_stands_alone(drawn):
    drawn.locator(".points[data-codec='e7 rgba8']").click()
    with drawn.expect_download() as download:
        drawn.locator("[data-svg]").click()
    text = unquote(download.value.url.partition(",")[2])
    assert "var(" not in text and "light-dark" not in text and "<script" not in text
    root = ElementTree.fromstring(text)
    points = [one for one in root.iter(f"{SVG}path") if one.get("class", "").startswith("points")]
    assert len(points) == 42 and {one.get("opacity") for one in points} == {"1", "0.5"}
    assert all(re.match(r"rgb|#|none", one.get("fill")) for one in points)
    said = {"".join(one.itertext()) for one in root.iter(f"{SVG}text")}
    assert {"bits", "16", "24", "instructions, including packing"} <= said and any(
        text.startswith("Pareto-optimal:") for text in said
    )


def test_a_figure_has_its_height_before_it_is_drawn(chart_page):
    """Each of them, with two panels, a switch, slanted names and a legend of shades."""
    rows = rows_of_tables()
    for name in ("mix", "lights", "cost", "sweep", "roofline"):
        for chart in TABLES[name].work.charts(rows[name]) if name in rows else [a_front()]:
            before, after = chart_page.put(chart)
            assert before == after > 100, chart.name


def test_what_nobody_has_come_to_is_there_on_paper(browser, report):
    """Idle time draws it; what is not drawn when printing begins is drawn then, but for what lies in a closed fold."""
    page = browser.new_page()
    page.add_init_script(
        "window.requestIdleCallback = () => 0; window.IntersectionObserver = class { observe() {} unobserve() {} };"
    )
    page.goto(report.as_uri())
    page.evaluate("ready()")
    assert page.locator(".plot svg").count() == 0 < page.locator(".plot").count()
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details:not([open]) .plot svg").count() == 0
    page.eval_on_selector_all("details", "all => all.forEach((one) => (one.open = true))")
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.locator(".plot:empty").count() == 0
    page.close()


def test_a_panel_follows_its_width(drawn):
    drawn.evaluate("document.querySelector('main').style.width = '420px'")
    width = drawn.locator(".plot").evaluate("plot => plot.clientWidth")
    drawn.locator(f".plot svg[viewBox^='0 0 {width} ']").wait_for(state="attached")
    assert width < 420
    drawn.evaluate("document.querySelector('main').style.width = ''")
