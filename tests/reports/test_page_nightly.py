"""The report in a browser: no errors or requests, sortable and filtered tables, a movable divider and two themes."""

import re

import pytest
import test_page_slow
from browsing import DESKTOP, PHONE, Opened, no_paper
from test_page_slow import TABLE


@pytest.fixture(scope="module", params=[(DESKTOP, "dark"), (PHONE, "light")], ids=str)
def seen(request, browser, report):
    page = test_page_slow.opened_to_see(browser, report, *request.param)
    yield page
    page.context.close()


@pytest.fixture(
    scope="module",
    params=[((1440, 900), "light"), ((1440, 900), "dark"), ((390, 844), "light"), ((390, 844), "dark")],
    ids=str,
)
def seen_at_more_widths(request, browser, report):
    page = test_page_slow.opened_to_see(browser, report, *request.param)
    yield page
    page.context.close()


def test_nothing_is_fetched_and_no_error_is_logged_in_the_other_theme(seen, report):
    test_page_slow.test_nothing_is_fetched_and_no_error_is_logged(seen, report)


def test_the_page_itself_never_scrolls_sideways_in_the_other_theme(seen):
    test_page_slow.test_the_page_itself_never_scrolls_sideways(seen)


def test_the_answer_is_visible_first_in_the_other_theme(seen):
    test_page_slow.test_the_answer_is_visible_first(seen)


def test_images_and_charts_are_painted_in_the_other_theme(seen):
    test_page_slow.test_images_and_charts_are_painted(seen)


def test_axe_finds_nothing_in_the_other_theme(seen):
    test_page_slow.test_axe_finds_no_accessibility_problem(seen)


def test_axe_finds_nothing_at_more_widths(seen_at_more_widths):
    test_page_slow.test_axe_finds_no_accessibility_problem(seen_at_more_widths)


@pytest.mark.parametrize(
    ("size", "views"), [((1440, 900), ("see", "data")), ((390, 844), ("compare", "codecs"))], ids=str
)
def test_nothing_moves_while_another_view_fills(browser, report, size, views):
    test_page_slow.test_nothing_moves_while_a_view_fills(browser, report, size, views)


DRAW_ALL = "ready().then(() => window.dispatchEvent(new Event('beforeprint')))"


# What clips each panel is named for its chart and place there, whichever was drawn first.
CLIPS = """Array.from(document.querySelectorAll("figure[data-chart]"), (figure) =>
  Array.from(figure.querySelectorAll(".plot"), (plot, place) =>
    [plot.querySelector("clipPath").id, figure.dataset.chart, place])).flat()"""


FORMS = (
    "Array.from(document.querySelectorAll('input, select, button'), (one) => [one.value, one.checked, one.textContent])"
)


@no_paper
def test_a_reloaded_page_matches_a_new_window(browser, report, opened):
    """The tests here share a window, but no test may see what another has done to the page."""
    fresh = Opened(browser, report)
    fresh.page.evaluate(DRAW_ALL)
    expected = (
        fresh.page.evaluate(FORMS),
        fresh.page.evaluate("[document.documentElement.outerHTML, scrollY, innerWidth]"),
    )
    fresh.context.close()
    opened.page.locator(f"{TABLE} >> [data-filter]").fill("octahedral")
    opened.page.get_by_role("button", name=re.compile("Theme")).click()
    opened.page.get_by_label("the largest").check()
    opened.page.emulate_media(media="print", color_scheme="dark")
    opened.load_anew()
    opened.page.evaluate(DRAW_ALL)
    state = (
        opened.page.evaluate(FORMS),
        opened.page.evaluate("[document.documentElement.outerHTML, scrollY, innerWidth]"),
    )
    assert state == expected and opened.asked == [report.as_uri()] and opened.said == []
    names = opened.page.evaluate(CLIPS)
    assert names and all(clip == f"{chart}-panel-{place}" for clip, chart, place in names), names
    assert opened.page.evaluate("matchMedia('screen').matches && matchMedia('(prefers-color-scheme: light)').matches")
