"""How large a page grows: its elements after each view was opened once, scrolled to its end and left."""

import test_limits
from packed import packed_text

from normalbench.encodings.catalogue import ENCODINGS

folder = test_limits.folder
large = test_limits.large


MOST_ELEMENTS = 12_000


VISIT = """async (view) => {
  change({ view, at: "" });
  for (let y = 0; y < document.body.scrollHeight; y += innerHeight) {
    scrollTo(0, y);
    await new Promise((done) => setTimeout(done, 50));
  }
  return document.querySelectorAll("*").length;
}"""


def test_a_page_of_everything_has_few_elements(large):
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
    one = large.page.locator(f"#quality details[data-table={tables[0]}]")
    large.come_to(f"details[data-table={tables[0]}]")
    one.locator("summary").first.click()
    one.locator("tbody tr").first.wait_for()
    assert 0 < one.locator("tbody tr").count() <= 100
    one.locator("summary").first.click()
