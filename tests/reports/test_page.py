"""The report in a browser: no errors, nothing fetched, tables sort and filter, the divider moves, both themes read."""

import io
import math
import re
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import sync_playwright
from test_report import a_run, quality_row

ARGUMENTS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]
DESKTOP, PHONE = (1280, 900), (360, 740)
THEMES = ("light", "dark")


@pytest.fixture(scope="module")
def browser(chromium):
    with sync_playwright() as play:
        opened = play.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        yield opened
        opened.close()


class Opened:
    """A page, and everything that it asked for or complained of."""

    def __init__(self, browser, path, size=DESKTOP, theme="light", motion="reduce"):
        self.asked, self.said = [], []
        width, height = size
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, color_scheme=theme, reduced_motion=motion, offline=True
        )
        self.page = self.context.new_page()
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.goto(path.as_uri())
        self.page.wait_for_function("document.querySelector('[data-values]')?.textContent")

    def texts(self, selector: str) -> list[str]:
        return self.page.locator(selector).all_text_contents()

    def pixels(self, selector: str) -> np.ndarray:
        with Image.open(io.BytesIO(self.page.locator(selector).first.screenshot())) as image:
            return np.asarray(image.convert("RGB")).astype(int)


@pytest.fixture(scope="module")
def report(results):
    return results[0] / "report.html"


@pytest.fixture
def opened(browser, report):
    page = Opened(browser, report)
    yield page
    page.context.close()


@pytest.fixture(scope="module", params=[(size, theme) for size in (DESKTOP, PHONE) for theme in THEMES], ids=str)
def seen(request, browser, report):
    """The page at each width in each theme; not to be changed."""
    page = Opened(browser, report, *request.param)
    page.page.evaluate("Promise.all(Array.from(document.images, (image) => image.decode()))")
    yield page
    page.context.close()


def test_nothing_is_fetched_and_nothing_complains(seen, report):
    assert [url for url in seen.asked if not url.startswith("data:")] == [report.as_uri()]
    assert seen.said == []


def test_the_page_itself_never_scrolls_sideways(seen):
    widths = seen.page.evaluate("[document.documentElement.scrollWidth, document.body.scrollWidth, innerWidth]")
    assert max(widths[:2]) <= widths[2], widths
    for details in seen.page.locator("details").all():
        details.evaluate("element => element.open = true")
    widths = seen.page.evaluate("[document.documentElement.scrollWidth, document.body.scrollWidth, innerWidth]")
    assert max(widths[:2]) <= widths[2], f"unfolded: {widths}"


def test_the_answer_is_what_is_seen_first(seen):
    lead = seen.page.locator(".lead")
    assert lead.text_content().startswith("In 16 bits on playground, octahedral_precise in rgba8 wins: 50.52 dB")
    box, height = lead.bounding_box(), seen.page.viewport_size["height"]
    assert box["y"] > 0 and box["y"] + box["height"] < height, box
    assert np.ptp(seen.pixels(".lead")) > 150, "dark on light or light on dark"


AXE = """async () => {
  const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"];
  const { violations } = await axe.run(document, { runOnly: tags });
  return violations.map(({ id, nodes }) => [id, nodes.length, nodes[0].html.slice(0, 200), nodes[0].failureSummary]);
}"""


@pytest.mark.slow
@pytest.mark.parametrize("seen", [(DESKTOP, "light"), (PHONE, "dark")], ids=str, indirect=True)
def test_axe_finds_nothing_that_keeps_readers_out(seen):
    """WCAG 2.1 A and AA with contrast, landmarks, labels and the order of headings; details closed and open."""
    from axe_playwright_python.base import AXE_FILE_PATH

    seen.page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    assert seen.page.evaluate(AXE) == []


CONTRAST = """() => {
  const canvas = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const rgb = (colour) => { canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1);
    return Array.from(canvas.getImageData(0, 0, 1, 1).data.slice(0, 3)); };
  const probe = document.body.appendChild(document.createElement("i"));
  const value = (name) => { probe.style.color = `var(--${name})`; return rgb(getComputedStyle(probe).color); };
  const charts = [0, 1, 2, 3, 4, 5, 7, 8].map((n) => `chart-${n}`);
  const names = ["paper", "raised", "mark", "ink", "muted", "faint", "accent", ...charts];
  const found = Object.fromEntries(names.map((name) => [name, value(name)]));
  probe.remove();
  return found;
}"""


def luminance(rgb: list[int]) -> float:
    """Relative luminance, WCAG 2.1."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (v / 255 for v in rgb)]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def contrast(one: list[int], other: list[int]) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", THEMES)
def test_text_and_lines_have_contrast_in_both_themes(browser, report, theme):
    page = Opened(browser, report, theme=theme)
    found = page.page.evaluate(CONTRAST)
    page.context.close()
    assert (luminance(found["paper"]) > 0.5) == (theme == "light")
    for text in ("ink", "muted", "accent"):
        for ground in ("paper", "raised"):
            assert contrast(found[text], found[ground]) >= 4.5, (text, ground, found)
    assert contrast(found["ink"], found["mark"]) >= 4.5
    lines = {n: contrast(rgb, found["paper"]) for n, rgb in found.items() if n.startswith("chart-")}
    assert min(lines.values()) >= 3, lines


TABLE = "#quality [data-sheet] >> nth=0"


def column(opened: Opened, index: int) -> list[str]:
    return [
        row.locator("th, td").nth(index).text_content() for row in opened.page.locator(f"{TABLE} >> tbody tr").all()
    ]


@pytest.mark.slow
def test_tables_sort_by_number_in_both_directions_by_keyboard(opened):
    headers = opened.page.locator(f"{TABLE} >> thead th")
    names = [text.strip() for text in headers.all_text_contents()]
    at = names.index("psnr db jax")
    before = column(opened, 0)
    headers.nth(at).locator("button").focus()
    for direction, reverse in (("ascending", False), ("descending", True)):
        opened.page.keyboard.press("Enter")
        figures = [float(text) for text in column(opened, at)]
        assert figures == sorted(figures, reverse=reverse) and figures[0] != figures[-1]
        assert headers.nth(at).get_attribute("aria-sort") == direction
    assert column(opened, 0)[0] == "xyz" and sorted(column(opened, 0)) == sorted(before)
    headers.nth(0).locator("button").click()
    assert column(opened, 0) == sorted(before) and headers.nth(at).get_attribute("aria-sort") == "none"


def test_what_is_empty_is_last_whichever_way(opened):
    headers = opened.page.locator(f"{TABLE} >> thead th")
    at = [text.strip() for text in headers.all_text_contents()].index("article db")
    for _ in range(2):
        headers.nth(at).locator("button").click()
        texts = column(opened, at)
        filled = [bool(text) for text in texts]
        assert any(filled) and filled == sorted(filled, reverse=True), texts


@pytest.mark.slow
def test_infinite_figures_sort_as_the_largest(browser, tmp_path, run):
    figures = {"xyz": 51.1, "octahedral": math.inf, "spheremap": 48.1}
    rows = [quality_row(name, psnr_db=figure) for name, figure in figures.items()]
    assert run("report", str(a_run(tmp_path / "run", {"quality": rows})), "-o", str(tmp_path / "page.html"))[0] == 0
    page = browser.new_page()
    page.goto((tmp_path / "page.html").as_uri())
    table = page.locator("#quality [data-sheet]").first
    headers = table.locator("thead th")
    at = [text.strip() for text in headers.all_text_contents()].index("psnr db jax")
    headers.nth(at).locator("button").click()
    assert [row.locator("th, td").nth(at).text_content() for row in table.locator("tbody tr").all()][-1] == "inf"
    page.close()


def test_a_filter_leaves_rows_that_hold_every_word_and_counts_them(opened):
    field = opened.page.locator(f"{TABLE} >> [data-filter]")
    assert field.is_visible() and opened.page.get_by_label("Filter").first.is_visible()
    field.fill("16 octahedral")
    shown = [row for row in opened.page.locator(f"{TABLE} >> tbody tr").all() if row.is_visible()]
    assert {row.locator("th").text_content() for row in shown} == {"octahedral", "octahedral_precise"}
    status = opened.page.locator(f"{TABLE} >> [data-count]")
    assert status.text_content() == "2 of 9 rows" and status.get_attribute("role") == "status"
    field.fill("")
    assert status.text_content() == "9 of 9 rows"


def picked(opened: Opened, side: str, codec: str, kind: str) -> None:
    opened.page.locator(f'[data-pick="{side}-codec"]').select_option(codec)
    opened.page.locator(f'[data-pick="{side}-kind"]').select_option(kind)
    opened.page.wait_for_function(
        "([side, codec]) => document.querySelector(`[data-canvas=${side}]`).getAttribute('aria-label').includes(codec)",
        arg=[side, f"{codec}: "],
    )


@pytest.mark.slow
def test_the_divider_moves_by_keyboard_and_shows_one_picture_on_either_side(opened):
    picked(opened, "left", "the normals of playground", "normals")
    picked(opened, "right", "spherical rgba8", "error")
    before = opened.pixels("[data-stage]")
    opened.page.locator("#divider").focus()
    for _ in range(30):
        opened.page.keyboard.press("ArrowRight")
    assert opened.page.locator("#divider").input_value() == "80"
    assert opened.texts("[data-divided]") == ["80 %"]
    after = opened.pixels("[data-stage]")
    changed = (np.abs(after - before).max(axis=2) > 60).mean(axis=0)
    width = len(changed)
    assert changed[: int(0.48 * width)].mean() < 0.01 > changed[int(0.83 * width) :].mean()
    assert changed[int(0.52 * width) : int(0.78 * width)].mean() > 0.5, "what was the one is the other now"
    opened.page.keyboard.press("Home")
    assert opened.page.locator("#divider").input_value() == "0"


@pytest.mark.slow
def test_a_zoom_shows_the_pictures_own_pixels_as_squares(opened, results):
    picked(opened, "left", "octahedral rgba8", "error")
    picked(opened, "right", "spheremap rgba8", "error")
    opened.page.locator("#zoom-by").select_option("16")
    opened.page.locator("#zoom-x").fill("200")
    opened.page.locator("#zoom-y").fill("150")
    shown = {}
    for side, name in (("left", "octahedral"), ("right", "spheremap")):
        with Image.open(results[0] / f"images/playground-{name}-rgba8-error.png") as image:
            kept = np.asarray(image)
        # 320 x 240 pixels of the zoom are 20 x 15 of the picture's.
        data = opened.page.locator(f"[data-zoom={side}]").evaluate(
            "canvas => Array.from(canvas.getContext('2d').getImageData(0, 0, 320, 240).data)"
        )
        zoomed = np.array(data, np.uint8).reshape(240, 320, 4)[..., :3]
        cells = zoomed.reshape(15, 16, 20, 16, 3)
        flat = np.ptp(cells, axis=(1, 3)).max(axis=2) == 0
        assert flat.sum() == 15 * 20 - 1, "every pixel is one square, but for the one that is marked"
        assert (cells[:, 8, :, 8][flat] == kept[143:158, 190:210][flat]).all()
        shown[side] = " ".join(map(str, kept[150, 200]))
    (values,) = opened.texts("[data-values]")
    assert values == f"At 200, 150: left {shown['left']}; right {shown['right']}"


@pytest.mark.slow
def test_pointing_at_a_place_zooms_there_and_a_thumbnail_is_a_button(opened):
    stage = opened.page.locator("[data-stage]")
    stage.scroll_into_view_if_needed()
    box = stage.bounding_box()
    opened.page.mouse.click(box["x"] + box["width"] * 0.25, box["y"] + box["height"] * 0.75)
    x, y = (int(opened.page.locator(f"#zoom-{axis}").input_value()) for axis in "xy")
    assert abs(x - 160) <= 1 and abs(y - 360) <= 1
    opened.page.locator('.thumbs button[data-codec="xy rgba8"][data-kind="decoded"]').focus()
    opened.page.keyboard.press("Enter")
    assert opened.page.locator('[data-pick="right-codec"]').input_value() == "xy rgba8"
    assert opened.page.locator('[data-pick="right-kind"]').input_value() == "decoded"


@pytest.mark.slow
def test_the_theme_is_the_systems_until_the_button_says_another(opened):
    def paper() -> float:
        found = opened.page.evaluate("getComputedStyle(document.body).backgroundColor")
        return luminance([int(n) for n in re.findall(r"\d+", found)[:3]])

    button = opened.page.get_by_role("button", name=re.compile("Theme"))
    assert paper() > 0.5
    for name, is_light in (("light", True), ("dark", False)):
        button.click()
        assert button.text_content() == f"Theme: {name}" and (paper() > 0.5) == is_light
    opened.page.reload()
    assert paper() < 0.1, "it is remembered"
    button.click()
    assert button.text_content() == "Theme: as the system" and paper() > 0.5


def test_the_keyboard_starts_with_a_way_past_the_navigation(opened):
    opened.page.keyboard.press("Tab")
    assert opened.page.evaluate("document.activeElement.textContent") == "Skip to the answer"
    opened.page.keyboard.press("Enter")
    assert opened.page.evaluate("document.activeElement.id") == "main"
    links = opened.page.eval_on_selector_all("nav a", "all => all.map((a) => a.getAttribute('href').slice(1))")
    there = opened.page.eval_on_selector_all("section[id]", "all => all.map((s) => s.id)")
    assert links == there


def test_headings_go_down_a_step_at_a_time(opened):
    levels = [int(tag[1]) for tag in opened.page.eval_on_selector_all("h1,h2,h3,h4", "a => a.map((h) => h.tagName)")]
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels)), levels


def test_the_sphere_shows_the_mean_or_the_largest(opened):
    shown = "img[data-which]:not([hidden])"
    means = opened.page.eval_on_selector_all(shown, "all => all.map((i) => i.dataset.which)")
    assert set(means) == {"mean"}
    opened.page.get_by_label("the largest").check()
    assert set(opened.page.eval_on_selector_all(shown, "all => all.map((i) => i.dataset.which)")) == {"largest"}


def test_pictures_and_charts_are_painted(seen):
    """Not black, not clipped: pictures vary, charts have ink on paper, discs are round and in colour."""
    for selector in ("[data-stage]", ".thumbs img >> nth=0", ".globes img >> nth=2", ".scale img >> nth=0"):
        assert seen.pixels(selector).std() > 8, selector
    charts = seen.page.locator("svg.drawing")
    assert charts.count() == 2
    chart = seen.pixels("#angles svg.drawing >> nth=0")
    assert (np.abs(chart - np.median(chart, axis=(0, 1))).max(axis=2) > 60).mean() > 0.01


def test_printing_shows_every_row_on_white(opened):
    opened.page.emulate_media(media="print", color_scheme="dark")
    assert opened.page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert not opened.page.locator("nav").is_visible() and not opened.page.locator("#viewer").is_visible()
    assert opened.page.locator(".sheet .scroll").first.evaluate("e => e.scrollHeight <= e.clientHeight + 1")
