"""Pages in a browser, for tests."""

import io

import numpy as np
from PIL import Image

ARGUMENTS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]
# The browser's own renderer in place of a GPU, for WebGL.
SOFTWARE_GPU = ("--use-angle=swiftshader", "--use-gl=angle", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")
GPU_ARGUMENTS = [one for one in ARGUMENTS if one != "--disable-gpu"] + list(SOFTWARE_GPU)
DESKTOP, PHONE = (1280, 900), (360, 740)
# Once the viewer shows two codecs.
VIEWED = "[data-pixel=right]:not(:empty)"


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
        self.page.wait_for_selector("#theme:not([hidden])")

    def come_to(self, selector: str, until: str) -> None:
        """Scroll there, and wait for what is drawn when it comes into view."""
        self.page.locator(selector).first.scroll_into_view_if_needed()
        self.page.wait_for_selector(until)

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
