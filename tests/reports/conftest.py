"""A browser, and the page of the small run in it."""

import pytest
from browsing import ARGUMENTS, GPU_ARGUMENTS, Opened
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
def gpu_browser(play, chromium):
    """A browser with WebGL2, by its own renderer."""
    opened = play.chromium.launch(executable_path=chromium, args=GPU_ARGUMENTS)
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
