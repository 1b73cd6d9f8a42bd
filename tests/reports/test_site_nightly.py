"""The website of a run: what is in it, that its links lead somewhere, and that it is read without scripts."""

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


def test_pages_keep_to_the_rules_of_html(site, pages, results):
    for text, fault in FAULTS.items():
        found = faults(f"<!doctype html><title>a</title>{text}")
        assert any(fault in one for one in found), (text, found)
    for path in (results[0] / "report.html", *(site / name for name in pages)):
        assert faults(path.read_text(encoding="utf-8")) == [], path.name


@pytest.mark.parametrize(
    ("name", "size", "theme"),
    [(name, PHONE, "dark") for name in WIDE] + [(name, DESKTOP, "light") for name in NARROW],
)
def test_no_page_keeps_anybody_out_in_the_other_theme(browser, site, name, size, theme):
    test_site_slow.test_no_page_keeps_anybody_out(browser, site, name, size, theme)
