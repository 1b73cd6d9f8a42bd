"""The images in a browser: views, divider, lens, gain and highlight, by pointer and by keyboard."""

import numpy as np
from browsing import VIEWED, Opened
from PIL import Image
from test_page_slow import TABLE
from test_pictures import pixels, rendered_run
from test_pictures_slow import answered_run


def viewed(opened: Opened, **chosen: str) -> None:
    """Show the viewer with options chosen by their labels or values."""
    opened.come_to("#viewer", VIEWED)
    for name, value in chosen.items():
        opened.page.locator(f"#{name}").select_option(value)
    opened.page.wait_for_timeout(300)


def drawn(opened: Opened, side: str) -> np.ndarray:
    """Return the pixels of a side of the viewer."""
    uri = opened.page.locator(f"[data-canvas={side}]").evaluate("canvas => canvas.toDataURL()")
    return pixels(uri).astype(int)


def kept(results, name: str) -> dict[str, np.ndarray]:
    with np.load(results[0] / f"images/playground-{name}.npz") as arrays:
        planes = {key: arrays[key][::2, ::2] for key in ("angle", "codes")}
    with Image.open(results[0] / f"images/playground-{name}-decoded.png") as image:
        return planes | {"decoded": np.asarray(image)[::2, ::2].astype(int)}


def test_each_view_is_drawn_from_the_pixels_of_the_run(opened, results):
    viewed(opened, left="octahedral rgba8", right="exact", view="decoded")
    octahedral = kept(results, "octahedral-rgba8")
    assert (drawn(opened, "left") == octahedral["decoded"]).all()
    with Image.open(results[0] / "images/playground-normals.png") as exact:
        assert (drawn(opened, "right") == np.asarray(exact)[::2, ::2]).all()
    covered, degrees = octahedral["angle"] > 0, 2.0 ** (-20 + (octahedral["angle"] - 1.0) / 8)
    viewed(opened, view="power")
    power = np.where(covered, 255 * (1 - np.maximum(np.cos(np.radians(degrees)), 0) ** 1024), 0)
    assert abs(drawn(opened, "left")[..., 0] - power).max() <= 1
    viewed(opened, view="error")
    error = np.where(covered, np.minimum(255, 255 * 30 * 2 * np.sin(np.radians(degrees) / 2)), 0)
    assert abs(drawn(opened, "left")[..., 1] - error).max() <= 1
    viewed(opened, view="code")
    codes = np.where(covered[..., None], octahedral["codes"], 0)
    assert (drawn(opened, "left")[..., :2] == codes).all()


def test_the_gain_and_the_colours_of_an_angle_can_be_chosen(opened, results):
    viewed(opened, left="octahedral rgba8", right="xy rgba8", view="angle", colours="grey")
    degrees = 2.0 ** (-20 + (kept(results, "octahedral-rgba8")["angle"] - 1.0) / 8)
    gain = opened.page.locator("#scale")
    gain.focus()
    for _ in range(17):
        opened.page.keyboard.press("ArrowLeft")
    seen = {}
    for _ in range(9):
        opened.page.keyboard.press("ArrowRight")
        opened.page.wait_for_timeout(200)
        (text,) = opened.texts("[data-scale]")
        seen[text] = drawn(opened, "left")[..., 0]
    assert {"0.1°", "0.5°", "1°"} <= set(seen)
    for full in (0.5, 1.0):
        grey = np.minimum(255, 255 * degrees / full)
        assert abs(seen[f"{full:g}°"] - grey)[kept(results, "octahedral-rgba8")["angle"] > 1].max() <= 1
    viewed(opened, colours="viridis")
    colours = drawn(opened, "left").reshape(-1, 3)
    assert (colours.max(axis=0) - colours.min(axis=0)).min() > 60, "no grey"
    assert opened.texts("[data-most]") == ["1° and more"]


def test_the_divider_is_dragged_on_the_image_and_moved_by_keyboard(opened):
    viewed(opened, left="exact", right="spherical rgba8", view="error")
    stage = opened.page.locator("#viewer .stage")
    box = stage.bounding_box()
    before = opened.pixels("#viewer .stage")
    middle = box["y"] + box["height"] / 2
    opened.page.mouse.move(box["x"] + box["width"] * 0.3, middle)
    opened.page.mouse.down()
    opened.page.mouse.move(box["x"] + box["width"] * 0.8, middle, steps=5)
    opened.page.mouse.up()
    opened.page.mouse.move(1, 1)
    assert opened.texts("[data-divided]") == ["80%"]
    after = opened.pixels("#viewer .stage")
    changed = (np.abs(after - before).max(axis=2) > 40).mean(axis=0)
    width = len(changed)
    assert changed[: int(0.48 * width)].mean() < 0.02 and changed[int(0.52 * width) : int(0.78 * width)].mean() > 0.2
    opened.page.locator("#divider").focus()
    opened.page.keyboard.press("Home")
    assert opened.texts("[data-divided]") == ["0%"]


def test_the_lens_shows_and_describes_the_pixels_at_the_pointer(opened, results):
    viewed(opened, left="octahedral rgba8", right="spheremap rgba8", view="decoded")
    assert opened.page.locator(".lens").is_hidden()
    box = opened.page.locator("#viewer .stage").bounding_box()
    opened.page.mouse.move(box["x"] + box["width"] * (100.5 / 320), box["y"] + box["height"] * (60.5 / 240))
    assert opened.page.locator(".lens").is_visible()
    arrays = kept(results, "octahedral-rgba8")
    data = opened.page.locator("[data-lens=left]").evaluate(
        "canvas => Array.from(canvas.getContext('2d').getImageData(0, 0, 132, 132).data)"
    )
    cells = np.array(data, np.uint8).reshape(11, 12, 11, 12, 4)[:, 6, :, 6, :3]
    assert (cells == arrays["decoded"][55:66, 95:106]).all(), "11 x 11 pixels of 12 x 12"
    (text,) = opened.texts("[data-pixel=left]")
    code = " ".join(f"{number:08b}" for number in arrays["codes"][60, 100])
    degrees = 2.0 ** (-20 + (arrays["angle"][60, 100] - 1.0) / 8)
    assert text.startswith(f"code {code}, decoded (") and text.endswith(f"off by {float(f'{degrees:.2g}'):g}°")
    assert opened.texts("[data-values]")[0].startswith("Pixel 100, 60 (200, 120 of the run's image), exact normal (")
    opened.page.locator("#viewer .stage").focus()
    opened.page.keyboard.press("ArrowRight")
    opened.page.keyboard.press("Shift+ArrowDown")
    assert opened.texts("[data-values]")[0].startswith("Pixel 101, 70 (202, 140 ")
    opened.page.locator("#lens-x").fill("5")
    assert opened.texts("[data-values]")[0].startswith("Pixel 5, 70 (10, 140 ")


WITHOUT = """(name) => {
  for (const subject of viewer.data.subjects) subject.codecs = subject.codecs.filter(({ codec }) => codec !== name);
  return viewer.begin();
}"""


def test_a_codec_without_an_image_is_not_drawn(opened):
    """Its side is hatched, so that the other one does not show through, and a line gives the command to run."""
    viewed(opened)
    opened.page.evaluate(WITHOUT, "spheremap rgba8")
    opened.page.evaluate("change({ a: 'octahedral rgba8', b: 'spheremap rgba8' })")
    opened.says("[data-pixel=right]", "no image")
    command = "normalbench run --tables quality --encoding spheremap --storage rgba8"
    opened.says("[data-lacking]", f"The page has no images of B, spheremap rgba8. To see one, run: {command}")
    assert opened.texts("#viewer [data-name=right]") == ["spheremap rgba8: no image"]
    hatched = drawn(opened, "right")
    assert hatched.min() >= 85 - 1 and hatched.max() <= 119 + 1 and drawn(opened, "left").std() > 8
    opened.page.evaluate("change({ b: 'xy rgba8' })")
    opened.says("#viewer [data-name=right]", "xy rgba8")
    opened.says("[data-pixel=right]", "code")
    assert drawn(opened, "right").std() > 8 and opened.texts("[data-lacking]") == [""]
    assert not [text for text in opened.texts("#right option") if "no image" in text] and opened.said == []


CHOSEN = """() => ({
  rows: Array.from(document.querySelectorAll("tr[data-codec]"))
    .filter((row) => getComputedStyle(row).getPropertyValue("--side")).map((row) => row.dataset.codec),
  charts: Array.from(document.querySelectorAll(".plot .areas"))
    .filter((one) => getComputedStyle(one).getPropertyValue("--side") === getComputedStyle(one).getPropertyValue("--a"))
    .map((one) => one.dataset.codec),
  pictures: ["left", "right"].map((side) => document.querySelector(`#${side}`).selectedOptions[0]?.textContent),
  sides: CODECS.map((side) => document.querySelector(`#side-${side}`).value),
})"""


def test_a_codec_chosen_anywhere_is_chosen_everywhere(opened):
    """The codec becomes A; a codec chosen by its image is put on the right and becomes B."""
    viewed(opened)
    opened.come_to("figure[data-chart]", "figure[data-chart] .plot svg")
    opened.page.wait_for_timeout(500)
    for by in ("a row", "the keyboard", "the list", "a chart", "a picture"):
        choose_spheremap(opened, by)
        opened.page.wait_for_timeout(500)
        side = "ab".index("b" if by == "a picture" else "a")
        chosen = opened.page.evaluate(CHOSEN)
        assert set(chosen["rows"]) == {"spheremap rgba8"} and len(chosen["rows"]) >= 3, by
        assert chosen["pictures"][side] == chosen["sides"][side] == "spheremap rgba8", by
        if by != "a picture":
            assert chosen["charts"] and set(chosen["charts"]) == {"spheremap rgba8"}, by
        opened.page.locator(f"#side-{'ab'[side]}").select_option("")
        assert opened.page.evaluate(CHOSEN)["rows"] == [], by


def choose_spheremap(opened: Opened, by: str) -> None:
    """Choose spheremap in rgba8 through this part of the page."""
    if by == "the list":
        opened.page.locator("#side-a").select_option("spheremap rgba8")
    elif by == "a picture":
        opened.come_to("#viewer")
        opened.page.locator(".thumbs button", has_text="spheremap rgba8").click()
    elif by == "a chart":
        opened.page.locator("figure[data-chart] .plot [data-codec='spheremap rgba8']").last.dispatch_event("click")
    else:
        opened.come_to(TABLE)
        button = opened.page.locator(f"{TABLE} >> tr[data-codec='spheremap rgba8'] .pick")
        button.focus()
        button.click() if by == "a row" else opened.page.keyboard.press("Enter")


def test_rendered_images_and_images_next_to_the_page_are_shown(browser, run, tmp_path):
    folder = rendered_run(tmp_path / "run")
    assert run("report", str(folder), "--pictures", "beside", "-o", str(tmp_path / "page.html"))[0] == 0
    page = Opened(browser, tmp_path / "page.html")
    viewed(page, left="xy rgba8", right="exact", view="final")
    with Image.open(folder / "images/gloss-power47-hybrid-fp32-xy-rgba8-rgba32fx2-final.png") as final:
        assert (drawn(page, "left") == np.asarray(final)).all()
    with Image.open(folder / "images/gloss-power47-hybrid-reference.png") as reference:
        assert (drawn(page, "right") == np.asarray(reference)).all()
    assert page.texts("[data-crops] figcaption") == ["xy rgba8", "exact", "exact"], "crops follow a choice"
    viewed(page, view="apart", colours="grey")
    assert len(np.unique(drawn(page, "left"))) == 1 and drawn(page, "left").max() > 100, "3 of 255 everywhere"
    (text,) = page.texts("[data-pixel=left]")
    assert text.endswith("off by 3 of 255") and page.said == []
    page.context.close()


def test_images_of_an_answer_open_the_viewer_in_the_answers_scene(browser, run, tmp_path):
    assert run("report", str(answered_run(tmp_path / "run")))[0] == 0
    page = Opened(browser, tmp_path / "run/report.html", fragment="#v1/choose")
    page.page.wait_for_selector(".proof:not([hidden]) button:nth-child(4)")
    captions = page.texts(".proof button span")
    assert captions == [
        *("A fine rg8: image", "B xy rg8: image"),
        *(f"{side}: largest difference 2 of 255, above 2 in 0% of the pixels" for side in ("A fine rg8", "B xy rg8")),
    ]
    page.page.locator(".proof").first.locator("button").first.click()
    page.page.wait_for_selector(VIEWED)
    page.page.wait_for_timeout(300)
    assert page.page.locator("#subject option:checked").text_content() == "the answer on gloss at power 47"
    sides = [page.page.locator(f"#{side} option:checked").text_content() for side in ("left", "right")]
    assert sides == ["fine rg8", "xy rg8"] and page.page.locator("#view").input_value() == "final"
    for index in (0, 1, 0):
        page.page.locator("#subject").select_option(index=index)
    page.page.wait_for_timeout(500)
    assert drawn(page, "left").max() > 0 and page.texts("[data-pixel=left]")[0].endswith("off by 2 of 255")
    page.page.locator("#side-b").select_option("xy rgb10a2")
    page.page.locator(".proof button span", has_text="B xy rgb10a2: largest difference 0").wait_for(state="attached")
    page.page.wait_for_timeout(300)
    assert page.page.locator("#right option:checked").text_content() == "xy rgb10a2" and page.said == []
    page.context.close()
