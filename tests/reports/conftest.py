"""A browser, and the page of the small run in it."""

import pytest
from browsing import ARGUMENTS, GL_ARGUMENTS, Laboratory, Opened
from playwright.sync_api import sync_playwright


@pytest.fixture(scope="session")
def play():
    with sync_playwright() as playing:
        yield playing


@pytest.fixture(scope="session")
def browser(play, chromium):
    opened = play.chromium.launch(executable_path=chromium, args=ARGUMENTS)
    yield opened
    opened.close()


@pytest.fixture(scope="session")
def gl_browser(play, chromium):
    """A browser with WebGL2, by software."""
    opened = play.chromium.launch(executable_path=chromium, args=GL_ARGUMENTS)
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def report(results):
    return results[0] / "report.html"


@pytest.fixture
def opened(browser, report):
    page = Opened(browser, report)
    yield page
    page.context.close()


@pytest.fixture
def laboratory(gl_browser, report):
    page = Laboratory(gl_browser, report)
    yield page
    page.context.close()
    assert not page.said, page.said
    assert page.asked == [report.as_uri()], "a page that asks for nothing"
