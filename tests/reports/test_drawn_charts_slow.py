"""Interactive figures: pointing, picking, keys, zoom, files and print."""

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
    """Return the codecs of points that are not faint."""
    codecs = page.locator(".points").evaluate_all(
        "all => all.filter((one) => getComputedStyle(one).opacity === '1').map((one) => one.dataset.codec)"
    )
    return set(codecs)


def test_click_chooses_a_and_shift_click_b_and_the_rest_is_faint(drawn):
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


def test_nothing_is_faint_in_a_chart_without_a_and_b(drawn):
    drawn.evaluate("known.codecs.push('other rg8'); change({ a: 'other rg8' })")
    assert len(seen(drawn)) == 42


def test_line_through_several_codecs_belongs_to_no_codec(drawn):
    codecs = drawn.locator(".lines").evaluate_all("all => all.map((one) => one.dataset.codec)")
    assert "" in codecs, codecs
    drawn.evaluate("change({ a: 'e1 rgba8' })")
    assert drawn.locator(".lines[data-codec='']").first.evaluate("one => getComputedStyle(one).opacity") < "1"


def test_encoding_name_selects_its_codecs_and_any_name_selects_itself(drawn):
    drawn.evaluate("change({ a: 'e1' })")
    assert seen(drawn) == {"e1 rgba8", "e1 rgb10a2"}
    drawn.evaluate("(name) => change({ a: name, b: 'e2 rgba8' })", HOSTILE)
    assert seen(drawn) == {HOSTILE, "e2 rgba8"}


def test_no_two_names_overlap_in_a_cloud(drawn):
    boxes = drawn.locator("text.labels").evaluate_all(
        """all => all.filter((one) => getComputedStyle(one).display !== "none")
        .map((one) => one.getBBox()).map(({ x, y, width, height }) => [x, y, x + width, y + height])"""
    )
    assert len(boxes) > 30
    for index, (left, top, right, bottom) in enumerate(boxes):
        for others in boxes[index + 1 :]:
            apart = right <= others[0] or others[2] <= left or bottom <= others[1] + 2 or others[3] <= top + 2
            assert apart, (boxes[index], others)


def test_hovering_shows_the_figures_until_the_pointer_leaves(drawn):
    drawn.locator(".points[data-codec='e3 rgba8']").hover()
    assert drawn.locator(".tip dd").all_text_contents()[:2] == ["e3 rgba8", "24"]
    drawn.mouse.move(0, 0)
    drawn.locator(".tip").wait_for(state="detached")


def test_keys_move_between_marks_and_describe_them(drawn):
    plot, status = drawn.locator(".plot"), drawn.locator("[data-said]")
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
        assert status.text_content().endswith(f"; {ending} of 42"), key
    assert status.get_attribute("role") == "status" and status.text_content().startswith("codec e")
    drawn.keyboard.press("Enter")
    assert drawn.evaluate("state.a") == status.text_content().split(",")[0].removeprefix("codec ")
    drawn.keyboard.press("Escape")
    assert drawn.locator(".tip").count() == 0


def test_a_chart_is_an_image_with_a_label(drawn):
    image = drawn.locator(".plot svg")
    assert image.get_attribute("role") == "img"
    assert image.get_attribute("aria-label").startswith("encode: Pareto-optimal:")
    assert drawn.locator(".plot").get_attribute("tabindex") == "0"


def test_the_wheel_zooms_a_focused_chart_and_a_button_resets_it(drawn):
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
def test_saved_file_matches_the_screen_and_is_self_contained(drawn):
    drawn.locator(".points[data-codec='e7 rgba8']").click()
    with drawn.expect_download() as download:
        drawn.locator("[data-svg]").click()
    text = unquote(download.value.url.partition(",")[2])
    assert "var(" not in text and "light-dark" not in text and "<script" not in text
    root = ElementTree.fromstring(text)
    points = [path for path in root.iter(f"{SVG}path") if path.get("class", "").startswith("points")]
    assert len(points) == 42 and {point.get("opacity") for point in points} == {"1", "0.5"}
    assert all(re.match(r"rgb|#|none", point.get("fill")) for point in points)
    texts = {"".join(element.itertext()) for element in root.iter(f"{SVG}text")}
    assert {"bits", "16", "24", "instructions, including packing"} <= texts and any(
        text.startswith("Pareto-optimal:") for text in texts
    )


def test_a_figure_has_its_height_before_it_is_drawn(chart_page):
    """This holds for every figure, also with two panels, a switch, slanted names or a legend of shades."""
    rows = rows_of_tables()
    for name in ("mix", "lights", "cost", "sweep", "roofline"):
        for chart in TABLES[name].work.charts(rows[name]) if name in rows else [a_front()]:
            before, after = chart_page.put(chart)
            assert before == after > 100, chart.name


def test_charts_that_were_never_scrolled_to_are_printed(browser, report):
    """Idle time draws most charts; the rest are drawn when printing begins, except in closed folds."""
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


def test_a_panel_adapts_to_the_page_width(drawn):
    drawn.evaluate("document.querySelector('main').style.width = '420px'")
    width = drawn.locator(".plot").evaluate("plot => plot.clientWidth")
    drawn.locator(f".plot svg[viewBox^='0 0 {width} ']").wait_for(state="attached")
    assert width < 420
    drawn.evaluate("document.querySelector('main').style.width = ''")
