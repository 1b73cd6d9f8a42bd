"""The website of a run: its content, its links, and reading it without scripts."""

import shutil
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import devices as made
import pytest
from browsing import AXE, DESKTOP, PHONE, Opened, scale_of
from languages import SHORT
from test_codecs_slow import ANSWER, QUALITY
from test_report import Read, a_run

from normalbench.bench.door import run_code
from normalbench.bench.keep.runs import read_run
from normalbench.bench.show.kept_code import read_code
from normalbench.bench.show.site_command import site_command
from normalbench.bench.tables.registry import TABLES

ENCODINGS = {"mine", "octahedral", "spheremap", "stereographic", "xy"}


LAID_OUT = {"pipeline": "hybrid", "layout": "fp32", "encoding": "octahedral", "storage": "rg8", "rounding": "nearest"}


LAID_OUT |= {"scene": "studio", "size": "640x480", "psnr_db": 24.8, "normal_psnr_db": 50.0, "exact": False}


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    tables = {"pick": ANSWER, "quality": QUALITY, "render": [TABLES["render"].empty() | LAID_OUT]}
    folder = a_run(tmp_path_factory.mktemp("site") / "run", tables)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run_code, "LANGUAGES", SHORT)
        run_code.keep_code(folder, read_run(folder))
    return folder


@pytest.fixture(scope="module")
def site(run_folder):
    """The site of the run and one device."""
    made.write(run_folder.parent / "files" / "a.json")
    assert site_command([run_folder, run_folder.parent / "files"], run_folder.parent / "site") == 0
    return run_folder.parent / "site"


@pytest.fixture(scope="module")
def pages(site) -> dict[str, Read]:
    paths = sorted(site.rglob("*.html"))
    return {str(path.relative_to(site)): Read(path.read_text(encoding="utf-8")) for path in paths}


def test_the_pages_match_the_run(pages):
    top = {"index.html", "choose.html", "layouts.html", "codecs/index.html", "devices/index.html"}
    assert set(pages) == top | {f"codecs/{name}.html" for name in ENCODINGS}


def test_imported_devices_have_the_sections_of_their_files(run, run_folder, tmp_path):
    """Only the browser differs, because a run stores its short name."""
    shutil.copytree(run_folder, tmp_path / "run")
    file = made.write(tmp_path / "files" / "a.json")
    assert run("import", str(file), "-o", str(tmp_path / "run"))[0] == 0
    assert run("site", str(tmp_path / "run"), "-o", str(tmp_path / "site"))[0] == 0
    assert run("site", str(tmp_path / "files"), "-o", str(tmp_path / "alone"))[0] == 0
    texts = [
        " ".join(Read((tmp_path / path).read_text(encoding="utf-8")).text.rpartition("agrees with the run")[2].split())
        for path in ("site/devices/index.html", "alone/index.html")
    ]
    assert texts[0] and texts[0] == texts[1].replace(made.CHROMIUM, "Chromium 156")
    status, out, err = run("site", str(tmp_path / "run"), str(tmp_path / "files"), "-o", str(tmp_path / "both"))
    assert status == 0 and "1 device\n" in out and "is from the same device and browser and at least as recent" in err


def test_every_link_leads_to_an_existing_page_and_place(site, pages):
    checked = 0
    for name, read in pages.items():
        for link in (anchor["href"] for anchor in read.all("a")):
            file, _, place = link.partition("#")
            to = str(((site / name).parent / file).resolve().relative_to(site.resolve())) if file else name
            assert to in pages, f"{name}: {link}"
            if place.startswith("v1/"):
                view = place[3:].partition("?")[0]
                assert any(element.get("data-view") == view for element in pages[to].all("div")), f"{name}: {link}"
            # A laboratory is in a run that keeps codes for it.
            elif place:
                assert any(element.get("id") == unquote(place) for _, element in pages[to].tags), f"{name}: {link}"
            checked += 1
    assert checked > 50, checked


def test_every_page_links_to_the_main_pages(site, pages):
    for name, read in pages.items():
        files = [anchor["href"].partition("#")[0] for anchor in read.all("a")]
        linked = {str(((site / name).parent / file).resolve().relative_to(site.resolve())) for file in files if file}
        assert linked >= {"choose.html", "layouts.html", "codecs/index.html", "devices/index.html"} - {name}, name
    assert {f"codecs/{encoding}.html" for encoding in ENCODINGS} <= {
        f"codecs/{anchor['href']}" for anchor in pages["codecs/index.html"].all("a")
    }


def test_titles_and_descriptions_are_unique(site, pages):
    titles = {name: (site / name).read_text().split("<title>")[1].split("</title>")[0] for name in pages}
    contents = {
        name: [meta["content"] for meta in read.all("meta") if meta.get("name") == "description"]
        for name, read in pages.items()
    }
    assert len(set(titles.values())) == len(titles), titles
    assert all(len(content) == 1 and len(content[0]) > 30 for content in contents.values()), contents
    assert len({content[0] for content in contents.values()}) == len(contents), contents
    assert "octahedral" in titles["codecs/octahedral.html"] and "mean error" in contents["codecs/octahedral.html"][0]


class Nested(HTMLParser):
    """Elements that are closed in a different order than they were opened."""

    EMPTY = frozenset(("meta", "link", "br", "img", "input"))

    def __init__(self, text: str):
        super().__init__()
        self.open, self.wrong = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):  # noqa: ARG002 - the name that HTMLParser gives it
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append((tag, self.getpos()))


def test_elements_are_closed_and_their_ids_are_unique(site, pages):
    for name, read in pages.items():
        nested = Nested((site / name).read_text(encoding="utf-8")) if name != "index.html" else None
        assert not nested or (nested.wrong, nested.open) == ([], []), f"{name}: {nested.wrong} {nested.open}"
        ids = [element["id"] for _, element in read.tags if "id" in element]
        assert len(set(ids)) == len(ids), f"{name}: {[element_id for element_id in ids if ids.count(element_id) > 1]}"


def test_only_the_first_page_is_large(site):
    sizes = {path.name: path.stat().st_size for path in site.rglob("*.html") if path.name != "index.html"}
    assert max(sizes.values()) < 2**19, sizes


def test_two_runs_are_a_one_line_error(run, run_folder, tmp_path):
    status, out, err = run("site", str(run_folder), str(run_folder), "-o", str(tmp_path / "site"))
    assert (status, out, err.count("\n")) == (2, "", 1) and "name only one" in err
    assert not Path(tmp_path / "site").exists()


def test_the_page_of_an_encoding_can_be_read_without_scripts(browser, site, run_folder):
    """The page shows the formula, source, figures and code that the run keeps."""
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
    assert shown.text_content() == "".join(kept["pieces"][place] for place in places)
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
    for opened_page in (page, device):
        opened_page.context.close()


# What is opened wide and in the light, and narrow and in the dark; at night the other way round.
WIDE = ("index.html", "layouts.html", "codecs/octahedral.html")


NARROW = ("choose.html", "codecs/index.html", "devices/index.html")


@pytest.mark.drawn(3)
@pytest.mark.parametrize(
    ("name", "size", "theme"),
    [(name, DESKTOP, "light") for name in WIDE] + [(name, PHONE, "dark") for name in NARROW],
)
def test_every_page_is_accessible(browser, site, name, size, theme):
    from axe_playwright_python.base import AXE_FILE_PATH

    page = Opened(browser, site / name, size, theme)
    page.page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    assert page.page.evaluate(AXE) == [] == page.said
    assert page.asked == [(site / name).as_uri()]
    assert page.page.evaluate("document.documentElement.scrollWidth") == size[0]
    page.context.close()
