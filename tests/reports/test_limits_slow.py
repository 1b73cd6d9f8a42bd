"""Limits on the size of a page: its elements after each view was opened once, scrolled to its end and left."""

import pytest
from browsing import Opened
from packed import packed_text
from test_report import Read, a_run, quality_row
from test_site_slow import LAID_OUT

from normalbench.bench.show.report import report_command
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A made-up run of every encoding in every storage."""
    names = [{"encoding": name, "storage": storage} for name in ENCODINGS for storage in STORAGES]
    rows = [quality_row(psnr_db=40.0 + i / 7, **codec) for i, codec in enumerate(names)]
    images = [TABLES["render"].empty() | LAID_OUT | codec | {"psnr_db": 20.0 + i / 7} for i, codec in enumerate(names)]
    return a_run(tmp_path_factory.mktemp("large") / "run", {"quality": rows, "render": images})


@pytest.fixture(scope="module")
def large(browser, folder):
    report_command(folder, as_markdown=False, pictures_beside=False, charts_beside=False, output=None)
    page = Opened(browser, folder / "report.html", size=(1440, 900))
    yield page
    page.context.close()


def test_a_site_contains_its_long_tables_as_html(folder, run, tmp_path):
    """A page without scripts cannot build tables."""
    assert run("site", str(folder), "-o", str(tmp_path / "site"))[0] == 0
    read = Read((tmp_path / "site/layouts.html").read_text(encoding="utf-8"))
    assert len(read.all("tr")) > len(ENCODINGS) * len(STORAGES)
    assert not [element for element in read.all("details") if "data-table" in element]


MOST_ELEMENTS = 12_000


VISIT = """async (view) => {
  change({ view, at: "" });
  for (let y = 0; y < document.body.scrollHeight; y += innerHeight) {
    scrollTo(0, y);
    await new Promise((done) => setTimeout(done, 50));
  }
  return document.querySelectorAll("*").length;
}"""


def test_a_page_with_every_codec_has_few_elements(large):
    views = large.page.eval_on_selector_all(".view", "all => all.map((one) => one.dataset.view)")
    counts = {view: large.page.evaluate(VISIT, view) for view in views}
    assert max(counts.values()) <= MOST_ELEMENTS, counts


def test_a_long_table_is_packed_and_built_when_it_is_opened(large, folder):
    text = (folder / "report.html").read_text(encoding="utf-8")
    tables = large.page.eval_on_selector_all(
        "#quality details[data-table]", "all => all.map((one) => one.dataset.table)"
    )
    assert tables and len(text) < 1_000_000
    packed = "".join(packed_text(text, f"data-{name}") for name in tables)
    assert all(name in packed for name in ENCODINGS)
    table = large.page.locator(f"#quality details[data-table={tables[0]}]")
    large.come_to(f"details[data-table={tables[0]}]")
    table.locator("summary").first.click()
    table.locator("tbody tr").first.wait_for()
    assert 0 < table.locator("tbody tr").count() <= 100
    table.locator("summary").first.click()
