"""The laboratory's window in a browser: presets, camera control, readers' files, addresses and images."""

import base64
import io
import json
import re
from pathlib import Path

import numpy as np
import pixel_files
import pytest
from browsing import Laboratory, no_files, no_paper
from PIL import Image
from written import Document

# The least share of pixels that a step of octahedral 8:8 is to be seen in, and by how much of 255.
LEAST_SHARE, VISIBLE = 0.03, 8


CAMERA = "['around', 'over', 'away'].map((name) => live.see.value(name))"


SMALL = """async () => {
  const canvas = new OffscreenCanvas(64, 64), pen = canvas.getContext("2d");
  pen.drawImage(live.device.canvas, 0, 0, 64, 64);
  return Array.from(pen.getImageData(0, 0, 64, 64).data);
}"""


DROP = """([name, text]) => {
  const files = new DataTransfer();
  files.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
  live.root.querySelector(".live-stage").dispatchEvent(new DragEvent("drop", { dataTransfer: files, bubbles: true }));
}"""


def bumps(size: int = 48) -> np.ndarray:
    """Return unit normals of waves, float64 of shape (size, size, 3), +y up."""
    y, x = np.mgrid[0:size, 0:size] / size * 6.0
    n = np.stack([0.6 * np.sin(x), 0.5 * np.cos(y), np.ones_like(x)], axis=-1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def sky(width: int = 64) -> np.ndarray:
    """Return radiance by longitude and latitude, with a lamp that is brighter than a screen."""
    radiance = np.full((width // 2, width, 3), 0.25)
    radiance[4:8, 10:30] = (8.0, 4.0, 2.0)
    return radiance


def opened_file(laboratory, name: str, data: bytes, said_of: str = "") -> str:
    """Choose a file and return the message about it."""
    status = laboratory.page.locator("[data-drop=said]")
    laboratory.page.locator("[data-drop=file]").set_input_files({"name": name, "mimeType": "", "buffer": data})
    laboratory.says("[data-drop=said]", re.compile(rf"{said_of}.*( as | triangles |is not shown)"))
    laboratory.settle()
    return status.text_content()


def shown_normals(laboratory) -> np.ndarray:
    """Return the dropped normals as stored on the GPU, top row first."""
    reply = laboratory.page.evaluate(
        "live.see.scene.normals().then((n) => [live.see.scene.width, live.see.scene.height, Array.from(n)])"
    )
    width, height, normals = reply
    return np.array(normals, np.float64).reshape(height, width, 4)[::-1]


def test_the_first_image_shows_8_bit_banding(laboratory):
    assert laboratory.texts("[data-preset][aria-pressed=true]") == ["Bonnet"]
    pictures = []
    for name in ("exact normals", "octahedral rgba8"):
        laboratory.choose(left=name, right=name)
        pictures.append(laboratory.picture())
    apart = abs(pictures[0] - pictures[1]).max(axis=-1)
    share = float((apart > VISIBLE).mean())
    print(f"{share:.1%} of the pixels differ by more than {VISIBLE}")
    assert share >= LEAST_SHARE, f"{share:.4f} of the pixels"


def test_a_preset_sets_scene_shading_and_camera(laboratory):
    views = {}
    for name in ("floor", "face", "bonnet"):
        laboratory.page.locator(f"[data-preset={name}]").click()
        laboratory.settle()
        shown = laboratory.page.locator("[data-see=shown]").input_value()
        views[name] = (shown, laboratory.page.evaluate(CAMERA), laboratory.picture())
        assert laboratory.page.locator("[data-see=subject]").input_value() == name
        assert len(np.unique(views[name][2].reshape(-1, 3), axis=0)) > 300, name
    assert [views[name][0] for name in ("floor", "face", "bonnet")] == ["studio", "studio", "zebra"]
    assert len({tuple(camera) for _, camera, _ in views.values()}) == 3


def test_lower_roughness_gives_sharper_reflections(laboratory):
    """A soft box's edge is steepest in a mirror."""
    steep = []
    laboratory.page.locator("[data-preset=floor]").click()
    laboratory.choose(left="exact normals", right="exact normals")
    for roughness in ("0.05", "0.2", "0.6"):
        laboratory.page.locator("[data-see=roughness]").fill(roughness)
        laboratory.settle()
        picture = laboratory.picture()
        floor = picture[-picture.shape[0] // 3 :, :, 1]
        steep.append(float((np.diff(floor, axis=1) ** 2).mean()))
    assert steep[0] > 2 * steep[1] > 4 * steep[2], steep


def test_pointer_keys_and_touch_move_the_camera(laboratory):
    page = laboratory.page
    box = page.locator("[data-live=canvas]").bounding_box()
    x, y = box["x"] + box["width"] * 0.3, box["y"] + box["height"] * 0.5

    def moved(act) -> list[float]:
        before = page.evaluate(CAMERA)
        act()
        laboratory.settle()
        return [round(after - was, 3) for was, after in zip(before, page.evaluate(CAMERA), strict=True)]

    def drag():
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 60, y + 30, steps=4)
        page.mouse.up()

    def wheel():
        page.mouse.wheel(0, 200)
        page.wait_for_timeout(100)

    around, over, away = moved(drag)
    assert around < -10 and over > 5 and away == 0
    assert moved(wheel)[2] > 0.3 and page.evaluate("scrollY") == pytest.approx(page.evaluate("scrollY"))
    assert moved(lambda: laboratory.press(".live-stage", "ArrowRight")) == [-3, 0, 0]
    assert moved(lambda: laboratory.press(".live-stage", "ArrowUp")) == [0, 3, 0]
    assert moved(lambda: laboratory.press(".live-stage", "+"))[2] < -0.1
    assert moved(lambda: laboratory.press(".live-stage", "-"))[2] > 0.1
    assert moved(lambda: laboratory.press(".live-stage", "Shift+ArrowLeft")) == [0, 0, 0], "it moves the point"
    pinch = """([x, y]) => {
      const to = (type, id, by) => live.device.canvas.dispatchEvent(new PointerEvent(type, {
        pointerId: id, pointerType: "touch", clientX: x + by, clientY: y, bubbles: true }));
      live.device.canvas.setPointerCapture = () => {};
      to("pointerdown", 5, -20);
      to("pointerdown", 6, 20);
      for (let by = 30; by <= 80; by += 10) to("pointermove", 6, by);
      to("pointerup", 5, -20);
      to("pointerup", 6, 80);
      delete live.device.canvas.setPointerCapture;
    }"""
    around, over, away = moved(lambda: page.evaluate(pinch, [x, y]))
    assert (around, over) == (0, 0) and away < -0.5


def test_a_normal_map_is_shown_through_the_codecs(laboratory):
    n = bumps()
    data = pixel_files.png(np.rint((n * 0.5 + 0.5) * 255).astype(np.uint8))
    assert opened_file(laboratory, "wall.png", data) == "wall.png as normals, as colours"
    assert laboratory.page.locator("[data-see=subject]").input_value() == "dropped"
    shown = shown_normals(laboratory)
    assert abs(shown[..., :3] - n).max() < 0.01 and (shown[..., 3] == 1).all()
    laboratory.page.locator("[data-drop=flipped]").check()
    assert abs(shown_normals(laboratory)[..., :3] - n * (1, -1, 1)).max() < 0.01
    laboratory.choose(left="octahedral rgba8", right="octahedral rgba8", shown="error")
    assert len(np.unique(laboratory.picture().reshape(-1, 3), axis=0)) > 30
    laboratory.page.locator("[data-drop=gone]").click()
    assert laboratory.page.locator("[data-see=subject] option[value=dropped]").count() == 0


def test_a_16_bit_png_is_read_to_its_last_bit(laboratory):
    """Rows use every filter, and the data have two parts; Pillow's 8-bit reading has 65 times as large an error."""
    n = bumps()
    data = pixel_files.png16(np.rint((n * 0.5 + 0.5) * 65535).astype(np.uint16))
    with Image.open(io.BytesIO(data)) as image:
        assert abs(np.asarray(image.convert("RGB")) / 127.5 - 1 - n).max() > 2e-3
    assert opened_file(laboratory, "wall.png", data) == "wall.png as normals, as colours"
    assert abs(shown_normals(laboratory)[..., :3] - n).max() < 3e-5


@pytest.mark.parametrize(("packing", "kind"), [("none", np.float32), ("ZIP", np.float32)])
def test_an_exr_of_normals_is_read_to_its_last_bit(laboratory, packing, kind):
    n = bumps()
    message = opened_file(laboratory, "n.exr", pixel_files.exr(n, packing, kind, names="XYZ"))
    assert message == "n.exr as normals, as vectors"
    kept = n.astype(kind).astype(np.float64)
    expected = kept / np.linalg.norm(kept, axis=-1, keepdims=True)
    assert abs(shown_normals(laboratory)[..., :3] - expected).max() < 2e-7


@pytest.mark.parametrize("make", ["hdr", "exr"])
def test_surroundings_from_a_file_are_reflected(laboratory, make):
    radiance = sky()
    data = pixel_files.exr(radiance) if make == "exr" else pixel_files.hdr(radiance, runs=make == "hdr")
    before = laboratory.picture()
    assert opened_file(laboratory, f"sky.{make[-3:]}", data) == f"sky.{make[-3:]} as surroundings"
    pixels = np.array(laboratory.page.evaluate("Array.from(live.see.surroundings.pixels)")).reshape(32, 64, 4)
    assert abs(pixels[..., :3] / radiance - 1).max() < 0.01
    assert laboratory.page.locator("[data-see=shown]").input_value() == "studio"
    picture = laboratory.picture()
    assert (abs(picture - before).max(axis=-1) > 8).mean() > 0.3
    assert (picture[..., 0] > picture[..., 2] + 25).mean() > 0.005, "the lamp is orange"


DAMAGED = {
    "no file": (b"GIF89a", "it is not a PNG, Radiance HDR, EXR or glTF file"),
    "half an EXR": (pixel_files.exr(bumps(), "none")[:4000], "the file ends too early"),
    "a packed EXR": (pixel_files.exr(bumps(), "RLE"), "its compression is RLE; use none, ZIPS or ZIP"),
    "tiles": (pixel_files.exr(bumps(), flags=0x200), "EXR with tiles is not supported; save one part as scanlines"),
    "a block": (pixel_files.exr(bumps(), "ZIP")[:-30] + b"\xff" * 30, "a block is damaged"),
    "half an HDR": (pixel_files.hdr(sky())[:300], "the file ends too early"),
    "a long run": (b"#?RADIANCE\n\n-Y 1 +X 9\n\2\2\0\11" + b"\xff\1" * 40, "a run is longer than its row"),
    "a large one": (b"#?RADIANCE\n\n-Y 99999 +X 99999\n", "it has 99999 x 99999 pixels; the maximum is 67108864"),
    "half of 16 bits": (pixel_files.png16(3e4 + 3e4 * bumps())[:300], "the file ends too early"),
    "no rows of 16 bits": (pixel_files.png16(np.ones((9, 9, 3))).replace(b"IDAT", b"xDAT"), "its rows are damaged"),
    "interlaced": (
        pixel_files.png16(np.ones((9, 9, 3)), True),
        "16-bit interlaced PNGs are not supported",
    ),
    "half a PNG": (pixel_files.png(np.zeros((9, 9, 3), np.uint8))[:60], "the file ends too early"),
    "no rows": (
        pixel_files.png(np.zeros((9, 9, 3), np.uint8)).replace(b"IDAT", b"xDAT"),
        "the browser cannot read this PNG",
    ),
}


def test_damaged_file_is_a_one_line_error_and_changes_nothing(laboratory):
    before = laboratory.page.evaluate(SMALL)
    for name, (data, reason) in DAMAGED.items():
        # Several of them have the same reason: each is another file, of which something is said anew.
        file = f"{name}.bin"
        assert opened_file(laboratory, file, data, said_of=file) == f"{file} is not shown: {reason}.", name
        assert not laboratory.page.evaluate("live.see.surroundings"), name
    assert laboratory.page.evaluate(SMALL) == before, "one of them changed the picture"


def test_a_file_can_be_dropped_on_the_image(laboratory):
    data = base64.b64encode(pixel_files.exr(bumps(), names="XYZ")).decode("ascii")
    laboratory.page.evaluate(DROP, ["dropped.exr", data])
    laboratory.says("[data-drop=said]", "dropped.exr as normals, as vectors")


def ball(how: str, path: Path) -> bytes:
    """Return a glTF file of a sphere that is mirrored, turned, moved and twice as large."""
    v, u = np.meshgrid(np.linspace(0, np.pi, 49), np.linspace(0, 2 * np.pi, 97), indexing="ij")
    n = np.stack([np.sin(v) * np.cos(u), np.cos(v), -np.sin(v) * np.sin(u)], axis=-1)
    corner = np.arange(v.size).reshape(v.shape)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    document = Document()
    mesh = document.mesh(n.reshape(-1, 3), n.reshape(-1, 3), np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3))
    child = document.node(mesh=mesh, scale=[-2, 2, 2])
    document.node(children=[child], rotation=[0, 0, 0.5**0.5, 0.5**0.5], translation=[1, 2, 3])
    document.json["scenes"] = [{"nodes": [1]}]
    return document.write(path, how).read_bytes()


@pytest.mark.parametrize("how", ["glb", "data"])
def test_a_dropped_gltf_is_drawn_with_its_normals(laboratory, tmp_path, how):
    """A sphere's normal is the direction from its centre to the place, at each pixel."""
    name = f"ball.{'glb' if how == 'glb' else 'gltf'}"
    message = opened_file(laboratory, name, ball(how, tmp_path / name))
    assert message == f"{name}: 9216 triangles with the model's normals; no materials or normal maps"
    laboratory.choose(left="exact normals", right="exact normals")
    width, height, words, camera, slope = laboratory.page.evaluate("""() => {
      const { seen } = live.see, { to_view: axes, eye, slope } = live.see.uniforms();
      return [seen.width, seen.height, Array.from(live.device.words(seen)), [...axes, ...eye], slope];
    }""")
    texels = np.array(words, np.uint32).reshape(height, width, 4)
    axes, eye = np.array(camera[:9]).reshape(3, 3).T, np.array(camera[9:])
    is_there = texels[..., 3] > 0
    assert 0.1 < is_there.mean() < 0.6
    y, x = (np.argwhere(is_there) + 0.5).T
    ray = np.stack([(2 * x / width - 1) * slope[0], (2 * y / height - 1) * slope[1], -np.ones_like(x)], axis=-1)
    distance = (texels[is_there][:, 3] & ~np.uint32(31)).view(np.float32)
    place = ray / np.linalg.norm(ray, axis=-1, keepdims=True) * distance[:, None] + axes @ eye
    normal = texels[is_there][:, :3].view(np.float32)
    expected = place - axes @ [0, 1.2, 0]
    assert np.linalg.norm(expected, axis=-1) == pytest.approx(1, abs=0.005)
    assert abs(normal - expected).max() < 0.05


BAD_MODELS = {
    "no mesh": (b'{"asset": {"version": "2.0"}}', "it has no triangles"),
    "no glTF": (b'{"asset": 1}', "it is not a glTF file"),
    "no JSON": (b"glTF", "it is not a glTF file"),
    "data beside": (
        b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin", "byteLength": 1}]}',
        "its data is in other files; export it as .glb",
    ),
    "packed": (
        b'{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]}',
        "it needs KHR_draco_mesh_compression, which is not supported; export it without",
    ),
    "a loop": (
        b'{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"children": [0]}]}',
        "its nodes are damaged",
    ),
}


def test_a_bad_gltf_is_a_one_line_error(laboratory, tmp_path):
    whole = ball("glb", tmp_path / "ball.glb")
    for name, (data, reason) in {**BAD_MODELS, "half": (whole[: len(whole) // 2], "the file ends too early")}.items():
        file = f"{name}.glb"
        assert opened_file(laboratory, file, data, said_of=file) == f"{file} is not shown: {reason}."


def test_the_difference_from_exact_has_one_scale_and_none_for_exact_normals(laboratory):
    laboratory.page.evaluate("live.see.preset('floor')")
    legend, most = laboratory.page.locator("[data-see=legend]"), laboratory.page.locator("[data-see-out=most]")
    laboratory.choose(shown="studio")
    assert not legend.is_visible(), "it has no false colours"
    laboratory.choose(shown="difference", left="octahedral rgba8", right="exact normals")
    assert legend.is_visible() and most.text_content() == "16 of 255"
    picture = laboratory.picture()
    left, right = picture[:, : picture.shape[1] // 2 - 4], picture[:, picture.shape[1] // 2 + 4 :]
    colours = [len(np.unique(side.reshape(-1, 3), axis=0)) for side in (left, right)]
    assert colours[0] > 50 and colours[1] <= 2, f"{colours}: black, and the colour of 0"


def test_the_space_bar_shows_one_codec_everywhere_then_the_other_then_both(laboratory):
    laboratory.choose(left="octahedral rgba8", right="exact normals")
    pictures = []
    for divider in (100, 0, 50, 100):
        laboratory.press(".live-stage", " ")
        assert laboratory.page.evaluate("live.see.value('divider')") == divider
        names = laboratory.page.locator(".live-stage .name").evaluate_all("all => all.map((one) => !one.hidden)")
        assert names == [divider > 0, divider < 100]
        pictures.append(laboratory.picture())
    assert (pictures[0] == pictures[3]).all() and (pictures[0] != pictures[1]).any()


@no_paper
def test_the_picture_is_printed_without_its_controls(laboratory):
    laboratory.page.emulate_media(media="print")
    assert laboratory.page.locator("[data-live=canvas]").is_visible()
    assert not laboratory.page.locator("[data-preset]").first.is_visible()
    laboratory.page.emulate_media(media="screen")


def test_an_address_restores_everything(reader_browser, report, laboratory):
    page = laboratory.page
    page.locator("[data-preset=face]").click()
    laboratory.choose(left="spherical rgba8", right="octahedral rgba8", shown="zebra")
    laboratory.press(".live-stage", *["ArrowLeft"] * 4, "+", "+")
    text = page.locator("[data-own=text]")
    text.fill(text.input_value().replace("// A unit", "// <b>Shared</b>: ä unit"))
    page.locator("[data-own=storage]").select_option("rgb10a2")
    laboratory.says("[data-own=said]", "20 bits in RGB10 A2")
    laboratory.settle()
    page.locator("[data-share=share]").click()
    page.wait_for_selector("[data-share=link]:visible")
    address, _, fragment = page.locator("[data-share=link]").input_value().partition("#")
    assert address == report.as_uri() and len(fragment) < 2000
    other = Laboratory(reader_browser, report, fragment=f"#{fragment}")
    # What somebody else wrote runs once the reader has read it.
    assert other.texts("[data-own=said]") == ["This encoder came with the link. Read it, then run it."]
    assert other.page.locator("[data-own=text]").input_value() == text.input_value()
    assert other.page.locator("[data-see=right]").input_value() != "your encoder"
    values = "live.share.values()"
    assert other.page.evaluate(values) == page.evaluate(values)
    page.locator("[data-share=link]").evaluate("link => { link.parentNode.hidden = true; }")
    sizes = [tab.evaluate("live.see.size") for tab in (page, other.page)]
    if sizes[0] != sizes[1]:
        other.page.evaluate("size => { live.see.size = size; live.see.change(); }", sizes[0])
        page.evaluate("size => { live.see.size = size; live.see.change(); }", sizes[0])
    other.settle()
    laboratory.settle()
    apart = np.abs(np.subtract(other.page.evaluate(SMALL), page.evaluate(SMALL)))
    # Two rasterisers do not agree on every pixel of an edge.
    assert apart.max() == 0 if page.context.browser is reader_browser else (apart > 8).mean() < 0.02, apart.max()
    other.page.locator("[data-own=run]").click()
    other.says("[data-own=said]", "20 bits in RGB10 A2")
    assert other.asked == [report.as_uri()] and not other.said
    other.context.close()


def test_the_address_follows_the_camera_and_returns_to_the_default(laboratory):
    plain = laboratory.page.evaluate("location.hash")
    length = laboratory.page.evaluate("history.length")
    laboratory.press(".live-stage", *["ArrowLeft"] * 10)
    settings = json.loads(laboratory.page.evaluate("inflated(state.live)"))
    assert set(settings) == {"around"}
    assert laboratory.page.evaluate("history.length") == length, "Back takes no step of the camera's"
    laboratory.press(".live-stage", *["ArrowRight"] * 10)
    # The address is written between two frames, which a busy machine draws late.
    laboratory.page.wait_for_function("plain => location.hash === plain", arg=plain)


UNKNOWN = [
    ("%%%", "The laboratory's part of the address is damaged"),
    ("A" * 3000, "The laboratory's part of the address is damaged"),
    ({"roughness": 7, "left": "no rgba8", "zoom": 2}, "The address names left no rgba8 and roughness 7 and zoom 2"),
    ([1], "The laboratory's part of the address is damaged: it contains no controls."),
]


def test_an_invalid_address_is_reported(laboratory):
    before = laboratory.page.evaluate("live.share.values()")
    for packed, message in UNKNOWN:
        # Without it, the line of the last one would do.
        laboratory.page.evaluate("() => { document.querySelector('#unknown').textContent = ''; }")
        text = packed if isinstance(packed, str) else laboratory.page.evaluate("deflated", json.dumps(packed))
        laboratory.page.evaluate("packed => { location.hash = `#v1/see?live=${packed}`; }", text)
        laboratory.says("#unknown", message)
        laboratory.settle()
        assert laboratory.page.evaluate("live.share.values()") == before, message


@no_files
def test_the_image_is_saved_with_names_and_figures(laboratory):
    canvas = laboratory.picture()
    with laboratory.page.expect_download() as download:
        laboratory.page.locator("[data-share=picture]").click()
    assert download.value.suggested_filename == "normalbench-bonnet-zebra-exact-normals-octahedral-rgba8.png"
    assert laboratory.page.evaluate("live.share.caption") == "bonnet, zebra"
    with Image.open(io.BytesIO(Path(download.value.path()).read_bytes())) as image:
        saved = np.asarray(image.convert("RGB")).astype(int)
    height, width, _ = canvas.shape
    assert saved.shape[1] == width and saved.shape[0] > height
    middle = width // 2
    assert (saved[:height, : middle - 2] == canvas[:, : middle - 2]).all()
    bar = saved[height:]
    assert (bar[:, :middle].max(axis=-1) > 200).any() and (bar[:, middle:].max(axis=-1) > 200).any(), "two texts"
    lines = laboratory.page.evaluate("live.share.lines('right')")
    assert lines[0] == "octahedral rgba8"
    assert re.fullmatch(r"mean 0\.33\d°, largest 0\.9\d+°, PSNR 48\.\d+ dB on \d+ directions, 16 bits", lines[1])


def test_typed_text_survives_a_reload(laboratory):
    page = laboratory.page
    typed = page.locator("[data-own=text]").input_value().replace("// A unit", "// Mine: a unit")
    page.locator("[data-own=text]").fill(typed)
    laboratory.says("[data-own=said]", "16 bits in RGBA8")
    laboratory.settle()
    page.goto("about:blank")
    page.goto(laboratory.address)
    laboratory.open()
    assert page.locator("[data-own=text]").input_value() == typed
    laboratory.says("[data-own=said]", "16 bits in RGBA8")
    laboratory.asked[:] = laboratory.asked[:1]


def test_a_mistake_is_marked_on_its_line_and_the_old_map_is_removed(laboratory):
    page = laboratory.page
    assert page.locator("[data-own=globe]").is_visible()
    figures = [row.split("°")[0] for row in laboratory.texts("[data-own=figures] tr")]
    assert [figure[:12] for figure in figures] == ["your encoder", "octahedral r"]
    text = page.locator("[data-own=text]")
    text.fill(text.input_value().replace("max(-z, 0.0)", "maxi(-z, 0.0)"))
    page.wait_for_selector("[data-own=text][aria-invalid=true]")
    assert laboratory.texts("[data-own=lines] mark") == ["9"]
    assert page.locator("[data-own=globe]").is_hidden()
    page.locator("[data-own=said] a").click()
    chosen = "(({ value, selectionStart, selectionEnd }) => value.slice(selectionStart, selectionEnd))"
    assert "maxi" in page.locator("[data-own=text]").evaluate(chosen)
