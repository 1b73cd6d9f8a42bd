"""The laboratory of a page in a browser with WebGL 2: controls, pixels, encoders and recovery from faults."""

import re

import jax.numpy as jnp
import numpy as np
import pytest
from browsing import AXE, Opened

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec3

# What a page may take for its laboratory, in bytes.
LARGEST = 400_000


LOSE = "() => (live.lose = live.device.gl.getExtension('WEBGL_lose_context')).loseContext()"


RESTORE = "() => live.lose.restoreContext()"


READ = "(side) => { const { codec, ...found } = live.inspect.read(side); return found; }"


SLIDERS = ("power", "side", "above", "around", "over", "away")


def apart(a: np.ndarray, b: np.ndarray) -> float:
    """Return the share of pixels that differ visibly."""
    return float((abs(a - b).max(axis=-1) > 3).mean())


def test_the_section_is_small_and_unpacked_only_when_it_is_opened(gl_browser, report):
    text = report.read_text()
    parts = [*re.findall(r'<script type="text/plain" id="live-\w+">[^<]*</script>', text)]
    assert len(parts) == 2
    size = sum(map(len, parts)) + len(re.search(r'<section id="live".*?</section>', text, re.DOTALL)[0])
    assert size < LARGEST, f"{size} bytes"
    page = Opened(gl_browser, report)
    assert page.page.evaluate("typeof openLaboratory") == "undefined"
    assert page.page.locator("#live").is_hidden() and page.page.locator("nav [data-to=see]").is_visible()
    page.context.close()


def test_a_browser_without_webgl2_gets_a_message(gl_browser, report):
    page = Opened(gl_browser, report, before="delete window.WebGL2RenderingContext", fragment="#v1/see")
    page.says("[data-live=said]", "not support WebGL 2")
    page.context.close()
    refused = "HTMLCanvasElement.prototype.getContext = function () { return null; }"
    page = Opened(gl_browser, report, before=refused)
    page.page.locator("nav [data-to=see]").click()
    page.says("[data-live=said]", "cannot run")
    assert "no WebGL 2 context" in page.texts("[data-live=said]")[0]
    page.context.close()


def test_every_slider_changes_the_image_and_its_number_by_keyboard(laboratory):
    laboratory.choose(subject="studio", shown="lit")
    before = laboratory.picture()
    for name in SLIDERS:
        number = laboratory.texts(f"[data-see-out={name}]")
        laboratory.press(f"[data-see={name}]", *["PageDown"] * 3)
        assert laboratory.texts(f"[data-see-out={name}]") != number, name
        after = laboratory.picture()
        assert apart(after, before) > 1e-3, f"{name}: {apart(after, before)} of the pixels"
        before = after
    # Bits are lost where light hardly shows it.
    laboratory.choose(shown="error")
    before, number = laboratory.picture(), laboratory.texts("[data-see-out=bits]")
    laboratory.press("[data-see=bits]", *["PageDown"] * 3)
    assert laboratory.texts("[data-see-out=bits]") != number
    assert apart(laboratory.picture(), before) > 1e-3, f"{apart(laboratory.picture(), before)} of the pixels"


def test_each_view_shows_what_its_name_promises(laboratory):
    laboratory.choose(subject="studio", left="exact normals", right="xy rgba8", shown="error")
    picture = laboratory.picture()
    middle = picture.shape[1] // 2
    assert len(np.unique(picture[:, : middle - 2].reshape(-1, 3), axis=0)) == 1, "exact normals have no error"
    before = picture
    laboratory.press("[data-see=full]", *["ArrowLeft"] * 3)
    assert laboratory.texts("[data-see-out=most]") == ["0.05° and more"]
    assert apart(laboratory.picture()[:, middle:], before[:, middle:]) > 0.2
    laboratory.choose(shown="normals", right="xy rgba8")
    normals = laboratory.picture()[10, 10] / 255 * 2 - 1
    assert abs(np.linalg.norm(normals) - 1) < 0.02
    laboratory.choose(shown="code")
    code = laboratory.picture()
    assert (code[:, middle + 2 :, 2] == 0).all() and code[:, middle + 2 :, 0].max() > 200, "two numbers: no blue"
    laboratory.choose(shown="lit")
    lit = laboratory.picture()
    laboratory.press("[data-see=gain]", *["PageUp"] * 5)
    assert apart(laboratory.picture(), lit) > 0.3


def test_the_divider_is_dragged_by_its_line_and_moved_by_keyboard(laboratory):
    laboratory.choose(subject="studio", left="exact normals", right="xy rgba8", shown="error")
    laboratory.page.locator("[data-live=canvas]").scroll_into_view_if_needed()
    box = laboratory.page.locator("[data-live=canvas]").bounding_box()
    laboratory.page.mouse.move(box["x"] + box["width"] / 2 + 4, box["y"] + 20)
    laboratory.page.mouse.down()
    laboratory.page.mouse.move(box["x"] + box["width"] * 0.2, box["y"] + 20, steps=4)
    laboratory.page.mouse.up()
    laboratory.settle()
    assert laboratory.texts("[data-see-out=divider]") == ["20%"]
    picture = laboratory.picture()
    edge = round(0.2 * picture.shape[1])
    nothing = picture[0, 0]
    assert (picture[:, : edge - 2] == nothing).all() and (picture[:, edge + 2 :] != nothing).any(axis=2).mean() > 0.8
    laboratory.press("[data-see=divider]", "End")
    picture = laboratory.picture()
    assert ((picture == nothing) | (picture == 0)).all(), "black where no surface is"


@pytest.mark.parametrize("encoding", ["octahedral", "xyz"])
def test_bits_of_a_pixel_match_the_emulation(laboratory, encoding):
    codec = Codec(ENCODINGS[encoding], STORAGES["rgba8"], "nearest")
    laboratory.choose(right=f"{encoding} rgba8")
    pixels = []
    for step in range(12):
        laboratory.page.evaluate("([x, y]) => live.inspect.go([x, y])", [20 + 26 * step, 30 + 15 * step])
        pixels.append(laboratory.page.evaluate(READ, "right"))
    n = np.array([pixel["normal"] for pixel in pixels], np.float32)
    view = np.array([pixel["view"] for pixel in pixels], np.float32)
    planes = [Vec3(*(jnp.asarray(array[:, i]) for i in range(3))) for array in (n, view)]
    stored = codec.stored(*planes)
    expected = np.stack([np.rint((np.asarray(number) * 0.5 + 0.5) * 255) for number in stored], axis=1).astype(int)
    words = np.array([pixel["texel"][0] for pixel in pixels], np.int64)
    numbers = np.stack([words >> 8 * i & 255 for i in range(expected.shape[1])], axis=1)
    assert (abs(numbers - expected) <= 1).all() and (numbers == expected).mean() > 0.95, (numbers, expected)
    decoded = codec.encoding.decode(
        type(stored)(*(jnp.asarray(x / 127.5 - 1, jnp.float32) for x in numbers.T)), planes[1]
    )
    assert abs(np.stack(decoded, axis=1) - [pixel["decoded"] for pixel in pixels]).max() < 1e-5


def test_the_pixel_at_the_pointer_is_described_and_moved_by_keyboard(laboratory):
    laboratory.choose(right="octahedral rgba8")
    laboratory.page.locator("[data-live=canvas]").scroll_into_view_if_needed()
    box = laboratory.page.locator("[data-live=canvas]").bounding_box()
    laboratory.page.mouse.move(box["x"] + box["width"] * 0.25, box["y"] + box["height"] * 0.6)
    laboratory.settle()
    texts = [laboratory.texts(f"[data-inspect={name}]")[0] for name in ("normal", "left", "right", "around")]
    assert re.fullmatch(r"Exact normal \((-?\d\.\d{5}, ){2}-?\d\.\d{5}\), view space\.", texts[0])
    assert texts[1] == "Left, exact normals."
    assert re.fullmatch(r"Right, octahedral rgba8: bits [01]{8} [01]{8}; decodes to .*, off by [\d.]+°\.", texts[2])
    assert texts[3].startswith("Codes of octahedral rgba8 around the exact normal")
    drawn = (
        "canvas => canvas.getContext('2d').getImageData(0, 0, 300, 300).data.filter((x, i) => i % 4 === 3 && x).length"
    )
    assert laboratory.page.locator("[data-inspect=sphere]").evaluate(drawn) > 500
    x = int(laboratory.page.locator("[data-inspect=x]").input_value())
    laboratory.press(".live-stage", "Shift+ArrowRight", "Shift+ArrowRight")
    assert int(laboratory.page.locator("[data-inspect=x]").input_value()) == x + 2
    laboratory.page.locator("[data-inspect=x]").fill("99999")
    laboratory.settle()
    width = laboratory.picture().shape[1]
    assert laboratory.page.evaluate("live.inspect.pixel[0]") == width - 1, "the last pixel, and no error"


def test_the_scene_of_the_run_is_shown_through_codecs(laboratory):
    laboratory.choose(subject="0", shown="error", left="octahedral rgba8", right="octahedral rgba8")
    picture = laboratory.picture()
    assert (picture == 0).all(axis=2).mean() > 0.01, "there is a background"
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100


def test_an_encoder_is_compiled_as_it_is_typed(laboratory):
    text = laboratory.page.locator("[data-own=text]")
    typed = text.input_value()
    (first,) = laboratory.texts("[data-own=said]")
    assert re.search(r"16 bits in RGBA8\. On 65536 random directions: mean 0\.33\d°, RMS 0\.3[67]", first), first
    # 10 log10 of 1 over the mean squared error, as `quality --normals sphere` has it.
    assert float(re.search(r"PSNR ([\d.]+) dB", first)[1]) == pytest.approx(48.58, abs=0.05)
    text.fill(typed.replace("max(-z, 0.0)", "max(-z, 0.1)"))
    laboratory.says("[data-own=said]", re.compile(r"mean [1-9]"))
    text.fill(typed.replace("max(-z, 0.0)", "maxi(-z, 0.0)"))
    laboratory.page.wait_for_selector("[data-own=text][aria-invalid=true]")
    assert any(line.startswith("Line 9: ") and "maxi" in line for line in laboratory.texts("[data-own=said] p"))
    text.fill(typed)
    laboratory.page.locator("[data-own=storage]").select_option("rg16")
    laboratory.says("[data-own=said]", "32 bits in RG16")
    assert float(re.search(r"mean ([\d.]+)°", laboratory.texts("[data-own=said]")[0])[1]) < 0.002
    command = "normalbench quality --encoding mine.glsl --storage rg16 --normals sphere"
    assert laboratory.texts("[data-own=command]") == [command]


def test_a_typed_encoder_changes_the_scene(laboratory):
    laboratory.choose(left="exact normals", right="your encoder", shown="error")
    before = laboratory.picture()
    text = laboratory.page.locator("[data-own=text]")
    text.fill(text.input_value().replace("return normalize(vec3(p, z))", "return normalize(vec3(p, z + 0.2))"))
    laboratory.says("[data-own=said]", re.compile(r"mean [1-9]"))
    laboratory.settle()
    assert apart(laboratory.picture(), before) > 0.2


def test_reserved_name_is_reported_and_the_image_is_still_drawn(laboratory):
    text = laboratory.page.locator("[data-own=text]")
    good = text.input_value()
    laboratory.choose(right="your encoder")
    text.fill(f"const float levels = 2.0;\n{good}")
    laboratory.says("[data-own=said]", "The page uses this name; choose another")
    assert laboratory.page.locator("[data-see=right]").input_value() == "exact normals"
    laboratory.settle()
    before = laboratory.picture()
    laboratory.choose(right="xy rgba8", shown="error")
    assert apart(laboratory.picture(), before) > 0.2
    own = laboratory.page.locator("[data-see=right] option", has_text="your encoder")
    assert own.evaluate("option => option.disabled")
    text.fill(good)
    laboratory.says("[data-own=said]", "16 bits in RGBA8")
    assert not own.evaluate("option => option.disabled")


def test_helpers_named_like_encoders_are_ignored(laboratory):
    text = laboratory.page.locator("[data-own=text]")
    text.fill("vec2 fold_encode(vec2 p) { return p; }\n" + text.input_value())
    laboratory.says("[data-own=said]", re.compile(r"mean 0\.33"))


WRONG = {
    "": "There is no encoder",
    "vec2 a_encode(vec3 n) { return n.xy; }": "There is no decoder: write vec3 a_decode(vec2 e)",
    "vec2 a_encode(vec3 n) { discard; return n.xy; } vec3 a_decode(vec2 e) { return vec3(e, 0); }": re.compile(
        "No direction|no return"
    ),
    "uniform float q; vec2 a_encode(vec3 n) { return q * n.xy; } vec3 a_decode(vec2 e) { return e.xyx; }": "uniform",
    "/* vec2 a_encode(vec3 n) { return n.xy; } vec3 a_decode(vec2 e) { return vec3(e, 0.); }": "At the end of the text",
    "vec2 a_encode(vec3 n) { return n.xy; } vec3 a_decode(vec3 e) { return e; }": "Where the page calls it",
    "vec2 a_encode(vec3 n) { return n.xy; } vec3 a_decode(vec2 e) { return vec3(0.0) / 0.0; }": (
        "No direction decodes to a finite value"
    ),
    '#include "a.glsl"\nvec2 a_encode(vec3 n) { return n.xy; } vec3 a_decode(vec2 e) { return vec3(e, 0); }': "Line 1",
    "vec2 a_encode(vec3 n) { return n.xy }\nvec3 a_decode(vec2 e) { return vec3(e, 0); }": "Line 1",
}


def test_mistakes_in_an_encoder_are_explained(laboratory):
    for text, message in WRONG.items():
        laboratory.page.locator("[data-own=text]").fill(text)
        laboratory.says("[data-own=said]", message)
    laboratory.page.locator("[data-own=storage]").select_option("rg8")
    three = "vec3 a_encode(vec3 n) { return n; } vec3 a_decode(vec3 e) { return e; }"
    laboratory.page.locator("[data-own=text]").fill(three)
    laboratory.says("[data-own=said]", "cannot hold 3 components")
    laboratory.said.clear()  # of the division by zero


def test_a_restored_context_shows_the_same_image(laboratory):
    laboratory.choose(right="spherical rgba8")
    laboratory.press("[data-see=around]", "PageUp")
    before = laboratory.picture()
    laboratory.page.evaluate(LOSE)
    laboratory.says("[data-live=said]", "taken the GPU")
    laboratory.press("[data-see=power]", "ArrowLeft", "ArrowRight")
    laboratory.page.wait_for_timeout(100)
    laboratory.page.evaluate(RESTORE)
    laboratory.says("[data-live=said]", "is back")
    laboratory.settle()
    assert (laboratory.picture() == before).all()


def test_the_open_laboratory_is_accessible(laboratory):
    from axe_playwright_python.base import AXE_FILE_PATH

    laboratory.page.evaluate(AXE_FILE_PATH.read_text() + "; 0")
    assert laboratory.page.evaluate(AXE) == []
