"""A and B in every figure and image of the page, compared with rows read from the run."""

import math

from browsing import Opened
from test_viewer_slow import viewed

from normalbench.bench.keep.runs import read_run
from normalbench.bench.tables.registry import TABLES

TITLE = TABLES["quality"].section.title


A, B = "octahedral rgba8", "spheremap rgba8"


LINES = """Array.from(document.querySelectorAll("[data-compare] [data-group] tbody tr"), (row) => ({
  group: row.closest("[data-group]").dataset.group,
  cells: Array.from(row.cells, (cell) => cell.textContent.trim()),
  best: Array.from(row.cells).findIndex((cell) => cell.matches(".best")) }))"""


def compared(opened: Opened, a: str, b: str) -> dict[tuple[str, str], dict]:
    """Return all lines of the comparison, by figure and table; of several conditions, the line that differs most."""
    opened.page.evaluate("([a, b]) => change({ view: 'compare', at: '', a, b })", [a, b])
    opened.page.wait_for_selector("[data-compare] [data-group]")
    lines = opened.page.evaluate(LINES)
    return {(line["cells"][0], line["group"]): line for line in reversed(lines)}


def test_a_and_b_appear_in_every_figure_that_both_have(opened, results):
    lines = compared(opened, A, B)
    means = {
        (row["encoding"], row["normals"], row["backend"]): row["angle_mean_deg"]
        for row in read_run(results[0]).tables["quality"]
        if row["storage"] == "rgba8" and row["angle_mean_deg"]
    }
    pairs = [(value, means["spheremap", *key]) for (name, *key), value in means.items() if name == "octahedral"]
    mean_a, other = max(pairs, key=lambda pair: abs(math.log(pair[1] / pair[0])))
    mean = lines["angle mean degrees", TITLE]
    assert [f"{float(text):.4g}" for text in mean["cells"][1:3]] == [f"{mean_a:.4g}", f"{other:.4g}"]
    assert mean["best"] == 1, "octahedral is the better one, and A"
    assert mean["cells"][3] == f"{float(f'{other / mean_a:.2g}'):g}\N{MULTIPLICATION SIGN}"
    turned = compared(opened, B, A)
    assert turned.keys() == lines.keys()
    assert turned["angle mean degrees", TITLE]["cells"][1:3] == mean["cells"][2:0:-1]
    assert turned["angle mean degrees", TITLE]["best"] == 2


def test_the_leading_figure_comes_first_and_other_conditions_unfold(opened):
    compared(opened, A, B)
    first = opened.page.locator("[data-compare] [data-group] tbody th").first.text_content()
    assert first == "PSNR dB"
    button = opened.page.locator("[data-compare] [aria-expanded]").first
    count = int(button.text_content().split()[1])
    rows = opened.page.locator("[data-compare] [data-group] tbody tr")
    before = rows.count()
    button.click()
    assert rows.count() == before + count - 1
    button.click()
    assert rows.count() == before


def test_image_zooms_to_its_pixel_values_and_blinks(opened):
    compared(opened, A, B)
    viewed(opened, left=A, right=B, view="decoded")
    stage = opened.page.locator("#viewer .stage")
    stage.focus()
    numbers = opened.page.locator("[data-numbers]")
    assert numbers.is_hidden()
    box = stage.bounding_box()
    place = "(({ clientX, clientY }) => viewer.zoom.at({ clientX, clientY }))"
    # A wheel's events have whole pixels.
    pointer = {"clientX": int(box["x"] + box["width"] / 4), "clientY": int(box["y"] + box["height"] / 4)}
    opened.page.mouse.move(pointer["clientX"], pointer["clientY"])
    before = opened.page.evaluate(f"(at) => {place}(at)", pointer)
    for _ in range(40):
        opened.page.mouse.wheel(0, -100)
    numbers.wait_for()
    after = opened.page.evaluate(f"(at) => {place}(at)", pointer)
    assert abs(before["x"] - after["x"]) < 0.01 and abs(before["y"] - after["y"]) < 0.01, (
        "what is under the pointer stays"
    )
    inside = opened.page.evaluate("viewer.shown.left.numbers(viewer.subject.width * 60 + 100)")
    assert len(inside) == 6 and all(set(bits) <= {"0", "1"} for bits in inside[:2]) and inside[5].endswith("°")
    painted = "(canvas) => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((x) => x)"
    assert numbers.evaluate(painted)
    opened.page.keyboard.press("Space")
    assert opened.texts("[data-divided]") == ["100%"]
    opened.page.keyboard.press("Space")
    assert opened.texts("[data-divided]") == ["0%"]
    opened.page.keyboard.press("0")
    assert numbers.is_hidden() and opened.page.evaluate("viewer.zoom.k") == 1
    assert opened.said == []


def test_comparison_without_b_asks_for_b(opened):
    opened.page.evaluate("(a) => change({ view: 'compare', at: '', a, b: '' })", A)
    opened.says("[data-compare]", "Choose A and B above")
