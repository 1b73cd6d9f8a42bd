"""The website of a run: its content, its links, and reading it without scripts."""

import pytest
import test_site_slow
from browsing import DESKTOP, PHONE
from html_faults import faults
from test_site_slow import NARROW, WIDE

pages = test_site_slow.pages
run_folder = test_site_slow.run_folder
site = test_site_slow.site


FAULTS = {
    "<p><div>a</div></p>": "unexpected-end-tag",
    "<p id='a'><p id='a'>": "a: 2 elements have this id",
    "<label for='b'>b</label>": "label: nothing has the id b",
    "<p><style></style>": "style in the body",
    "<table><tr><p>a</table>": "unexpected-start-tag-implies-table-voodoo",
}


def test_pages_follow_the_rules_of_html(site, pages, results):
    for text, fault in FAULTS.items():
        messages = faults(f"<!doctype html><title>a</title>{text}")
        assert any(fault in message for message in messages), (text, messages)
    for path in (results[0] / "report.html", *(site / name for name in pages)):
        assert faults(path.read_text(encoding="utf-8")) == [], path.name


@pytest.mark.parametrize(
    ("name", "size", "theme"),
    [(name, PHONE, "dark") for name in WIDE] + [(name, DESKTOP, "light") for name in NARROW],
)
def test_every_page_is_accessible_in_the_other_theme(browser, site, name, size, theme):
    test_site_slow.test_every_page_is_accessible(browser, site, name, size, theme)
