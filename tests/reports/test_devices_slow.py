"""Devices in Chromium: the section of a run's page, and the site; with pointer, keyboard, phone and dark theme."""

import devices as made
import pytest
from browsing import AXE, DESKTOP, PHONE, Opened
from test_report import a_run, quality_row

from normalbench.bench.show.site_command import site_command

MARKUP = "<script>document.title = 'taken'</script>\"'><img src=x onerror=document.title='taken'>"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    made.write_ten(folder / "files")
    assert site_command([folder / "files"], folder / "site") == 0
    return folder / "site"


@pytest.fixture(scope="module")
def index_once(browser, site):
    page = Opened(browser, site / "index.html")
    yield page
    page.context.close()


@pytest.fixture
def index(index_once):
    """The index of the site as if just opened: the tests share one window, in which the index is loaded again."""
    index_once.load_anew()
    # Firefox gives keys to the window in front alone.
    index_once.page.bring_to_front()
    return index_once


@pytest.fixture
def opener(browser):
    """A function that opens pages, which are closed at the end."""
    opened = []

    def opener(*arguments, **more):
        opened.append(Opened(browser, *arguments, **more))
        return opened[-1]

    yield opener
    for page in opened:
        page.context.close()


def violations(page: Opened) -> list:
    from axe_playwright_python.base import AXE_FILE_PATH

    page.page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    return page.page.evaluate(AXE)


def shown(page: Opened, title: str) -> list[str]:
    return page.texts(f"[data-searched='{title}'] tbody tr:not([hidden]) th")


def test_markup_of_a_renderer_stays_text_in_a_runs_page(run, opener, tmp_path):
    folder = a_run(tmp_path / "run", {"quality": [quality_row("octahedral")]})
    row = made.codec_rows()[0] | dict.fromkeys(("encoding", "storage", "target", "timer"), MARKUP)
    about = dict.fromkeys(("renderer", "vendor", "browser"), MARKUP)
    path = made.write(
        tmp_path / "a.json", codecs=[row | {"equal": 0, "further": 65536}], facts={MARKUP: MARKUP}, **about
    )
    assert run("import", str(path), "-o", str(folder))[0] == 0
    assert run("report", str(folder))[0] == 0
    page = opener(folder / "report.html")
    assert page.page.title() != "taken" and page.said == [] and page.page.locator("#devices img").count() == 0
    assert page.asked == [(folder / "report.html").as_uri()]
    assert "<script>" in page.page.locator("#devices").inner_text()


def test_a_runs_page_shows_devices_side_by_side(run, opener, tmp_path):
    folder = a_run(tmp_path / "run", {"quality": [quality_row("octahedral")]})
    assert run("import", *map(str, made.write_ten(tmp_path / "ten")), "-o", str(folder))[0] == 0
    assert run("report", str(folder))[0] == 0
    page = opener(folder / "report.html")
    text = page.page.locator("#devices").inner_text()
    assert (
        "5 devices agree with the run in every code of 35 codecs." in text and "Mali-G78, Chromium 156 differs" in text
    )
    heads = page.texts("#devices-1-caption ~ thead th")
    assert [head for head in heads if "," in head] == [
        "Apple M2, Safari 18",
        "Mali-G78, Chromium 156",
        "Adreno 740, Chromium 156",
        "PowerVR Rogue GE8320, Chromium 156",
        "Apple GPU, Safari 18",
    ], "those that differ"
    assert "they differ in 2 of 4 facts" in text
    assert violations(page) == [] == page.said


@pytest.fixture(scope="module")
def small_site(tmp_path_factory):
    """The site of two of the ten devices, one that agrees and one that differs: axe takes time for each row of a
    table, and all rows have the same template."""
    folder = tmp_path_factory.mktemp("small_site")
    made.write(folder / "files/a.json")
    made.write(folder / "files/b.json", renderer=made.MALI, truncated=("RGBA8", "RG8", "RGB10_A2"))
    assert site_command([folder / "files"], folder / "site") == 0
    return folder / "site"


@pytest.mark.drawn(2)
@pytest.mark.parametrize("size, theme", [(DESKTOP, "light"), (PHONE, "dark")])
def test_the_site_opens_from_disk_and_is_accessible(small_site, opener, size, theme):
    """The page requests only its file, reports no error and does not scroll sideways."""
    page = opener(small_site / "index.html", size, theme)
    assert violations(page) == [] == page.said
    assert "differs" in page.page.locator("body").inner_text()
    assert page.asked == [(small_site / "index.html").as_uri()]
    assert page.page.evaluate("document.documentElement.scrollWidth") == size[0]


def test_the_index_is_searched_by_device_codec_and_storage(index):
    field = index.page.get_by_label("Search by device, codec or storage")
    assert len(shown(index, "Devices")) == 10 and len(shown(index, "Codecs")) == 35
    field.fill("MALI")
    assert shown(index, "Devices") == ["Mali-G78, Chromium 156"] == shown(index, "Recommendations")
    assert index.page.locator("#found").inner_text().startswith("Devices: 1 of 10; Codecs: 35 of 35")
    field.fill("hemi_oct rg16f")
    assert shown(index, "Codecs") == ["hemi_octahedral rg16f"] and len(shown(index, "Devices")) == 10
    field.fill("nothing of this name")
    assert shown(index, "Devices") == shown(index, "Codecs") == []
    field.fill("")
    assert len(shown(index, "Devices")) == 10 and index.said == []


def test_the_index_can_be_used_by_keyboard(index):
    """The keys lead from the search to a device's section."""
    for _ in range(20):
        index.page.keyboard.press("Tab")
        if index.page.evaluate("document.activeElement.id") == "search":
            break
    index.page.keyboard.type("adreno")
    assert shown(index, "Devices") == ["Adreno 740, Chromium 156"]
    for _ in range(40):
        index.page.keyboard.press("Tab")
        if index.page.evaluate("(document.activeElement.getAttribute('href') ?? '').startsWith('#device-')"):
            break
    index.page.keyboard.press("Enter")
    index.page.wait_for_url("**/index.html#device-adreno-740-chromium-156")
    assert index.page.locator("#device-adreno-740-chromium-156 h2").bounding_box()["y"] < DESKTOP[1]
    assert index.said == []


def test_clicking_a_heading_sorts_a_table_of_the_index(index):
    head = index.page.locator("[data-searched='Devices'] thead button", has_text="least same percent")
    head.click()
    assert shown(index, "Devices")[0] == "PowerVR Rogue GE8320, Chromium 156", "the worst first"
