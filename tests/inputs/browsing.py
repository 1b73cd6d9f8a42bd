"""Pages in a browser, for tests."""

import base64
import io

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

ARGUMENTS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]
DESKTOP, PHONE = (1280, 900), (360, 740)
# Four browsers that draw by software on two cores: a page may wait longer than five seconds for its first frame.
expect.set_options(timeout=30_000)
# What Firefox cannot be asked for by its own protocol.
no_files = pytest.mark.chromium("its protocol keeps no files that are saved")
no_paper = pytest.mark.chromium("its protocol does not show a page as on paper, or in the dark")
no_swiftshader = pytest.mark.chromium("its figures are those of SwiftShader")
no_fingers = pytest.mark.chromium("its protocol has no fingers")
# Once the viewer shows two codecs.
VIEWED = "[data-pixel=right]:not(:empty)"


def within(browser, theme="light", motion="reduce") -> dict:
    """Return the options that a window is opened with; Firefox has them in its preferences."""
    is_firefox = browser.browser_type.name == "firefox"
    return {} if is_firefox else {"color_scheme": theme, "reduced_motion": motion, "offline": True}


def scale_of(browser) -> float:
    """Return the laboratory's pixels per layout pixel. SwiftShader takes a second per frame at full scale, and half
    as many pixels per side are enough. Firefox, which is tested at night, draws all pixels."""
    return 0.5 if browser.browser_type.name == "chromium" else 1


class Opened:
    """A page, with its requests, console messages and errors."""

    def __init__(self, browser, path, size=DESKTOP, theme="light", motion="reduce", fragment="", scale=1, before=""):
        self.asked, self.said, self.theme = [], [], theme
        width, height = size
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, device_scale_factor=scale, **within(browser, theme, motion)
        )
        if before:
            self.context.add_init_script(before)
        self.page = self.context.new_page()
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.address, self.is_new = path.as_uri() + fragment, True
        # Firefox does not tell of files.
        self.is_told = browser.browser_type.name != "firefox"
        self.go()

    def go(self) -> None:
        self.page.goto(self.address)
        if not self.is_told:
            self.asked.append(self.address.partition("#")[0])
        self.unfold()

    def unfold(self) -> None:
        """Open the sections of Codecs, which are folded below the card."""
        self.page.eval_on_selector_all("details.subject", "all => all.forEach((one) => (one.open = true))")

    def load_anew(self) -> None:
        """Load the page as in a new window: all input, choices, storage and permissions are cleared."""
        if not self.is_new:
            self.page.evaluate("localStorage.clear()")
            self.context.clear_permissions()
            self.page.emulate_media(media="screen", color_scheme=self.theme)
            self.page.mouse.move(0, 0)
            self.page.goto("about:blank")
            self.asked.clear()
            self.go()
            self.said.clear()
        self.is_new = False

    def come_to(self, selector: str, until: str = "") -> None:
        """Show the view of an element, scroll to the element, and wait for the selector `until`, if given."""
        place = self.page.locator(selector).first
        place.evaluate("place => change({ view: place.closest('.view')?.dataset.view ?? state.view })")
        place.scroll_into_view_if_needed()
        if until:
            self.page.wait_for_selector(until)

    def says(self, selector: str, text) -> None:
        """Wait until an element contains a text or a pattern; without `eval`, which the page's policy forbids."""
        expect(self.page.locator(selector)).to_contain_text(text)

    def texts(self, selector: str) -> list[str]:
        return self.page.locator(selector).all_text_contents()

    def pixels(self, selector: str) -> np.ndarray:
        with Image.open(io.BytesIO(self.page.locator(selector).first.screenshot())) as image:
            return np.asarray(image.convert("RGB")).astype(int)


AXE = """async () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
  const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"];
  const { violations } = await axe.run(document, { runOnly: tags });
  return violations.map(({ id, nodes }) => [id, nodes.length, nodes[0].html.slice(0, 200), nodes[0].failureSummary]);
}"""


# WebGL2 by Chromium's own software rasteriser, as on a machine without a GPU.
GL_ARGUMENTS = [
    *(argument for argument in ARGUMENTS if argument != "--disable-gpu"),
    *("--use-angle=swiftshader", "--use-gl=angle", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"),
]


DRAWN = """async () => {
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const turns = () => live.see.moves || live.device.isLost;
  const works = () => !live.see.isDone || live.own?.isBusy || live.share?.writing;
  for (await frame(), await frame(); works() && !turns(); await frame());
}"""


# WebGL2 by Mesa's driver, below an X server; no motion, as `Opened` has it; and no network.
PREFERENCES = {
    "webgl.force-enabled": True,
    "ui.prefersReducedMotion": 1,
    "layout.css.prefers-color-scheme.content-override": 1,
    "network.proxy.type": 1,
    "network.proxy.http": "127.0.0.1",
    "network.proxy.http_port": 9,
}

# What a reader can see or change of an open laboratory, and what a test may have done to the page behind it. A function
# of the page's keys at first.
STATE = """() => {
  const all = (selector) => Array.from(live.root.querySelectorAll(selector));
  const digest = (text) => {
    let sum = 0;
    for (let i = 0; i < text.length; i++) sum = (Math.imul(sum, 31) + text.charCodeAt(i)) | 0;
    return sum;
  };
  const { gl, canvas } = live.device, { checks, codecs, rows } = live.measuring;
  return {
    controls: all("input, select, textarea, button").map((one) => [one.value, !!one.checked, one.disabled]),
    marks: all("[hidden], [aria-pressed], [aria-invalid]").map((one) => [one.outerHTML.split(">")[0]]),
    unfolded: Array.from(document.querySelectorAll("details"), (one) => one.open),
    text: live.root.innerText,
    picture: digest(canvas.toDataURL()),
    window: [innerWidth, innerHeight, location.href],
    focus: document.activeElement.tagName,
    pixel: live.inspect.at,
    measuring: [rows.length, codecs.length, live.measuring.isBusy],
    data: digest(JSON.stringify(live.data)),
    changed: [Object.keys(window), Object.keys(live), Object.keys(gl), Object.getOwnPropertyNames(document)],
  };
}"""

# Puts a laboratory back by the page's own means: its controls, and new parts for what was measured.
RESET = """({ controls, unfolded, pixel }) => {
  const root = live.root, place = root.querySelector("[data-live=measure]");
  if (live.measuring.isBusy) return;
  place.replaceChildren();
  live.measuring = new Measuring(place, live.device, live.data);
  for (const [at, one] of document.querySelectorAll("details").entries()) one.open = unfolded[at];
  for (const name of ["turn", "wobble"]) live.see.move(name, false);
  for (const [at, one] of root.querySelectorAll("input, select, textarea, button").entries()) {
    const [value, checked] = controls[at] ?? [];
    if (one.value === value && !!one.checked === checked) continue;
    one.value = value;
    if (one.checked !== undefined) one.checked = checked;
    if (!one.matches("[data-own], [data-inspect]")) one.dispatchEvent(new Event("input"));
  }
  live.own.run();
  live.dropped.forget();
  live.inspect.at = pixel;
  live.see.change();
  document.querySelector("nav [data-to=see]").focus({ preventScroll: true });
  root.scrollIntoView();
}"""


class Laboratory(Opened):
    """A page with its laboratory open."""

    def __init__(self, browser, path, size=DESKTOP, fragment="", **more):
        super().__init__(browser, path, size, fragment=fragment, **{"scale": scale_of(browser)} | more)
        self.size = size
        self.open()
        self.fresh, self.is_new = self.state(), False

    def open(self) -> None:
        if "#" not in self.address:
            self.page.locator("nav [data-to=see]").click()
        self.page.wait_for_selector("#live[data-ready]")
        self.page.evaluate("live.root.scrollIntoView()")
        self.page.locator(".drawer").evaluate("drawer => drawer.open = true")
        self.settle()

    def state(self) -> dict:
        return self.page.evaluate(STATE)

    def reset(self) -> None:
        """Return to the state of a fresh load, and reload if a test changed anything that the page cannot reset."""
        width, height = self.size
        self.page.mouse.move(0, 0)
        if self.page.viewport_size != {"width": width, "height": height}:
            self.page.set_viewport_size({"width": width, "height": height})
            self.settle()
        self.page.evaluate(RESET, self.fresh)
        self.settle()
        if self.state() != self.fresh:
            self.load_anew()
            self.open()
            anew = self.state()
            assert anew == self.fresh, {
                name: (anew[name], self.fresh[name]) for name in anew if anew[name] != self.fresh[name]
            }
        self.said.clear()

    def settle(self) -> None:
        """Wait until every pixel shows the changes."""
        self.page.evaluate(DRAWN)

    def choose(self, **chosen: str) -> None:
        """Choose options of "See it" by the names of their controls."""
        for name, value in chosen.items():
            self.page.locator(f"[data-see={name}]").select_option(value)
        self.settle()

    def press(self, selector: str, *keys: str) -> None:
        self.page.locator(selector).focus()
        for key in keys:
            self.page.keyboard.press(key)
        self.settle()

    def picture(self) -> np.ndarray:
        """Return the drawn image, int of shape (height, width, 3), top row first."""
        uri = self.page.locator("[data-live=canvas]").evaluate("canvas => canvas.toDataURL()")
        with Image.open(io.BytesIO(base64.b64decode(uri.partition(",")[2]))) as image:
            return np.asarray(image.convert("RGB")).astype(int)
