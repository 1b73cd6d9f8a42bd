"""A browser, and the page of the small run in it."""

import os
import shutil
from contextlib import ExitStack, contextmanager

import both_ways
import pytest
from browsing import ARGUMENTS, GL_ARGUMENTS, PREFERENCES, Laboratory, Opened
from playwright.sync_api import sync_playwright
from screens import screen


@pytest.fixture(scope="session")
def play():
    with sync_playwright() as playing:
        yield playing


@contextmanager
def _launched(play, path, arguments):
    """Launch Chromium, or an installed Firefox with --firefox, through its own protocol and on a screen."""
    with ExitStack() as stack:
        if path.endswith("chromium"):
            opened = play.chromium.launch(executable_path=path, args=arguments)
        else:
            shown = {**os.environ, "DISPLAY": stack.enter_context(screen())}
            asked = {"channel": "moz-firefox", "headless": False, "firefox_user_prefs": PREFERENCES}
            opened = play.firefox.launch(executable_path=path, env=shown, **asked)
        yield opened
        opened.close()


@pytest.fixture(scope="session")
def browser(play, browser_path):
    with _launched(play, browser_path, ARGUMENTS) as opened:
        yield opened


@pytest.fixture(scope="session")
def gl_browser(play, browser_path):
    """A browser with WebGL 2, rendered in software."""
    with _launched(play, browser_path, GL_ARGUMENTS) as opened:
        yield opened


@pytest.fixture(scope="session")
def reader_browser(play, gl_browser):
    """The browser of somebody who receives a link: another browser if pages are opened in Firefox."""
    if gl_browser.browser_type.name == "chromium":
        yield gl_browser
        return
    with _launched(play, shutil.which("chromium"), GL_ARGUMENTS) as opened:
        yield opened


@pytest.fixture(scope="session")
def chart_page(browser, tmp_path_factory):
    """A page in a browser that draws charts, one after the other."""
    page = browser.new_page()
    yield both_ways.Page(page, tmp_path_factory.mktemp("charts") / "page.html")
    page.close()


@pytest.fixture
def agree(chart_page):
    """A function that checks that a file and the page show a chart alike, and returns its panels."""
    return chart_page.agree


@pytest.fixture(scope="module")
def report(results):
    return results[0] / "report.html"


@pytest.fixture(scope="module")
def opened_once(browser, report):
    page = Opened(browser, report)
    yield page
    page.context.close()


@pytest.fixture
def opened(opened_once):
    """The report as if just opened: a module's tests share one window, in which the page is loaded again."""
    opened_once.load_anew()
    # Firefox gives keys to the window in front alone.
    opened_once.page.bring_to_front()
    return opened_once


@pytest.fixture(scope="module")
def open_laboratory(gl_browser, report):
    """The laboratory that a module's tests use in turn."""
    page = Laboratory(gl_browser, report)
    yield page
    page.context.close()


@pytest.fixture
def laboratory(open_laboratory, report):
    """A laboratory in the state in which it opens."""
    open_laboratory.reset()
    yield open_laboratory
    assert not open_laboratory.said, open_laboratory.said
    assert open_laboratory.asked == [report.as_uri()], "a page that asks for nothing"
