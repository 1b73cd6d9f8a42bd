"""The website of a run: what is in it, that its links lead somewhere, and that it is read without scripts."""

import pytest
import test_site
from browsing import AXE, DESKTOP, PHONE, Opened, scale_of

from normalbench.bench.show.kept_code import read_code
from normalbench.bench.show.site_command import site_command

run_folder = test_site.run_folder
site = test_site.site


def test_an_encoding_is_read_without_scripts(browser, site, run_folder):
    """Its formula, its source, its figures and its code, as the run keeps it."""
    context = browser.new_context(java_script_enabled=False, offline=True)
    page = context.new_page()
    page.goto((site / "codecs/octahedral.html").as_uri())
    text = page.locator("main").inner_text()
    assert "p = n.xy / (|n.x| + |n.y| + |n.z|)" in text and "Meyer" in text and "Unreal Engine" in text
    rows = page.locator("#figures tbody tr")
    assert {row.split("\t")[0] for row in rows.all_inner_texts()} == {
        "octahedral rgba8",
        "octahedral rgb10a2",
        "octahedral rg8",
    }
    assert "49.85" in page.locator("#quality").inner_text() and "61.57" in page.locator("#quality").inner_text()
    kept = read_code(run_folder)
    places = kept["codecs"]["octahedral rgba8"]["texts"]["c"]
    shown = page.get_by_label("octahedral rgba8 in C", exact=True)
    assert shown.text_content() == "".join(kept["pieces"][at] for at in places)
    page.goto((site / "choose.html").as_uri())
    assert "take octahedral" in page.locator("h1 + p").inner_text()
    context.close()


def test_the_first_page_begins_with_the_laboratory(gl_browser, results, tmp_path):
    assert site_command([results[0]], tmp_path / "site") == 0
    page = Opened(gl_browser, tmp_path / "site/index.html", scale=scale_of(gl_browser))
    assert page.page.locator("#home").is_visible() and page.page.locator("#live").is_visible()
    page.page.wait_for_function("document.querySelectorAll('[data-see=left] option').length > 3")
    assert page.asked == [(tmp_path / "site/index.html").as_uri()]
    device = Opened(gl_browser, tmp_path / "site/devices/index.html", scale=scale_of(gl_browser))
    device.page.get_by_role("link", name="the laboratory").click()
    device.page.wait_for_url("**/index.html#**")
    device.page.locator("#live").wait_for(state="visible")
    assert page.said == [] == device.said
    for one in (page, device):
        one.context.close()


# What is opened wide and in the light, and narrow and in the dark; at night the other way round.
WIDE = ("index.html", "layouts.html", "codecs/octahedral.html")
NARROW = ("choose.html", "codecs/index.html", "devices/index.html")


@pytest.mark.parametrize(
    ("name", "size", "theme"),
    [(name, DESKTOP, "light") for name in WIDE] + [(name, PHONE, "dark") for name in NARROW],
)
def test_no_page_keeps_anybody_out(browser, site, name, size, theme):
    from axe_playwright_python.base import AXE_FILE_PATH

    page = Opened(browser, site / name, size, theme)
    page.page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    assert page.page.evaluate(AXE) == [] == page.said
    assert page.asked == [(site / name).as_uri()]
    assert page.page.evaluate("document.documentElement.scrollWidth") == size[0]
    page.context.close()
