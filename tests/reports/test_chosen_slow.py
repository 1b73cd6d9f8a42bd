"""The images of A and B in Choose, drawn by the reader's GPU in the scene of their stills."""

import numpy as np
import pytest
from browsing import Opened, scale_of
from PIL import Image
from test_pictures import pick_row
from test_report import a_run
from typed import codecs_named

from normalbench.bench.measures.live.kept import write_live
from normalbench.gbuffer.environment.studio import studio as surroundings
from normalbench.gbuffer.scenes.built_in.studio import studio
from normalbench.gbuffer.scenes.mesh import Mesh, joined
from normalbench.gbuffer.scenes.rasterise import Camera, rasterise
from normalbench.gbuffer.scenes.sampled import mapped_normals
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (160, 120)


CODES = ("octahedral", "spheremap")


LIVE = "viewer.pair.live"


SETTLED = f"""async () => {{
  while (!{LIVE}?.first || !{LIVE}.isDone) await new Promise((done) => setTimeout(done, 20));
}}"""


NORMALS = f"""async ([width, height]) => {{
  const {{ device, seen }} = {LIVE}, words = device.words(seen);
  const numbers = Array.from(words, (word, at) => (at % 4 < 3 ? floatOf(word) : word & 31));
  return {{ size: [seen.width, seen.height], numbers }};
}}"""


READ = """all => all.map((canvas) => {
  const { width, height } = canvas;
  return [width, height, Array.from(canvas.getContext("2d").getImageData(0, 0, width, height).data)];
})"""


REFUSED = """HTMLCanvasElement.prototype.getContext = ((own) => function (kind, ...more) {
  return kind === "webgl2" ? null : own.call(this, kind, ...more);
})(HTMLCanvasElement.prototype.getContext)"""


# A picture of all directions, as the environment has them.
ALL_AROUND = f"""([width, height]) => {{
  live.data.shaders.around = `out vec4 found;
    void main() {{
      vec2 at = gl_FragCoord.xy / vec2({{W}}.0, {{H}}.0);
      float t = at.y * PI, p = at.x * 2.0 * PI - PI;
      found = vec4(room(vec3(sin(p) * sin(t), cos(t), -cos(p) * sin(t)), 0.004), 1.0);
    }}`.replace("{{W}}", width).replace("{{H}}", height);
  const {{ device }} = {LIVE}, {{ gl }} = device, target = device.target(gl.RGBA32F, width, height);
  const found = new Float32Array(4 * width * height);
  device.draw(device.program(null, ["reflections.frag", "around"]), target, {{ studio: {{ int: 3 }} }});
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, found);
  delete live.data.shaders.around;
  return Array.from(found);
}}"""


def studio_run(folder, codes=CODES):
    """Write a run with an answer in the scene `studio`, whose stills are of one colour; codes other than CODES have
    none."""
    (folder / "images").mkdir(parents=True)
    about = {"scene": "studio", "image_db_studio": 40.0, "against": True}
    rows = [pick_row(name, 0.2 + index / 10, 9 + index) | about for index, name in enumerate(codes)]
    for name in (*(f"{code}-rg8-final" for code in CODES), "reference"):
        Image.new("RGB", SIZE, (50, 60, 70)).save(folder / f"images/pick-studio-{name}.png")
    write_live(codecs_named(",".join(codes), "rg8", "nearest"), folder / "live")
    return a_run(folder, {"pick": rows}, request={"tables": ["pick"]})


@pytest.fixture(scope="module")
def page_path(tmp_path_factory):
    from normalbench.bench.keep.runs import read_run
    from normalbench.bench.show.report import write_report

    folder = studio_run(tmp_path_factory.mktemp("chosen") / "run")
    return write_report(folder, read_run(folder), folder / "report.html")


@pytest.fixture(scope="module")
def chosen(gl_browser, page_path):
    page = Opened(gl_browser, page_path, scale=scale_of(gl_browser))
    page.page.wait_for_selector(".proof button:nth-child(4)")
    assert page.page.locator(".proof canvas[data-live]").count() == 0, "stills at first"
    page.page.locator(".proof button").first.focus()
    page.page.wait_for_selector(".proof canvas[data-live]")
    page.page.evaluate(SETTLED)
    yield page
    assert page.said == [] and page.asked == [page_path.as_uri()]
    page.context.close()


def images(chosen) -> list[np.ndarray]:
    """Return the images on the canvases of A and B, and of their differences."""
    chosen.page.evaluate(SETTLED)
    canvases = chosen.page.eval_on_selector_all(".proof canvas", READ)
    return [np.array(data).reshape(height, width, 4)[..., :3] for width, height, data in canvases]


def test_focus_makes_stills_live_and_keys_and_dragging_turn_both_images(chosen):
    page = chosen.page
    chosen.says(".proof [role=status]", "Live: drag")
    first, second, *differences = images(chosen)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 300, "a scene, where the still is of one colour"
    assert 0.001 < (abs(first - second).max(axis=-1) > 8).mean() < 0.5, "two codecs"
    page.keyboard.press("ArrowLeft")
    turned, other, *same = images(chosen)
    for before, after in ((first, turned), (second, other)):
        assert (abs(before - after).max(axis=-1) > 8).mean() > 0.05
    assert all((image == two).all() for image, two in zip(differences, same, strict=True)), "the run's own"
    camera = f"{LIVE}.camera"
    page.locator(".proof").scroll_into_view_if_needed()
    box = page.locator(".proof canvas").nth(1).bounding_box()
    before = page.evaluate(camera)
    page.mouse.move(box["x"] + 60, box["y"] + 60)
    page.mouse.wheel(0, 40)
    page.wait_for_timeout(100)
    assert page.evaluate(camera) == before, "the page scrolls until the picture was pressed"
    page.locator(".proof").scroll_into_view_if_needed()
    box = page.locator(".proof canvas").nth(1).bounding_box()
    page.mouse.move(box["x"] + 60, box["y"] + 60)
    page.mouse.down()
    page.mouse.move(box["x"] + 90, box["y"] + 80, steps=4)
    page.mouse.up()
    page.mouse.wheel(0, -100)
    page.wait_for_timeout(100)
    after = page.evaluate(camera)
    assert after["around"] < before["around"] - 5 and after["over"] > before["over"] + 3
    assert after["away"] < before["away"]
    assert page.evaluate("state.view") == "choose", "a drag opens nothing"
    page.evaluate(f"{LIVE}.aim({{ ...{LIVE}.scene.camera }})")


def test_swapping_a_and_b_swaps_their_images(chosen):
    first, second, *_ = images(chosen)
    chosen.page.evaluate("change({ a: state.b, b: state.a })")
    chosen.page.wait_for_selector(".proof canvas[data-live]")
    swapped, other, *_ = images(chosen)
    assert (swapped == second).all() and (other == first).all()


def in_view_space(scene):
    """Yield the scene's meshes in view space, each with its material."""
    view = scene.view.matrix()
    for part in scene.parts:
        for model, material in zip(part.models, part.materials, strict=True):
            whole = view @ model
            turned = whole[:3, :3] / np.cbrt(np.linalg.det(whole[:3, :3]))
            mesh = part.mesh
            yield (
                Mesh(mesh.positions @ whole[:3, :3].T + whole[:3, 3], mesh.normals @ turned.T, mesh.triangles, mesh.uv),
                scene.materials[material],
            )


def test_the_live_scene_has_the_normals_of_the_run(chosen):
    """The tiles of the live scene are smoothed differently, and its spheres are not polygons."""
    chosen.page.evaluate(f"size => {{ {LIVE}.size = size; {LIVE}.change(); }}", SIZE)
    chosen.page.evaluate(SETTLED)
    reply = chosen.page.evaluate(NORMALS, SIZE)
    width, height = reply["size"]
    assert (width, height) == SIZE
    seen = np.array(reply["numbers"]).reshape(height, width, 4)[::-1]
    scene = studio(Setting())
    drawn = list(in_view_space(scene))
    camera = Camera(width, height, scene.view.fov, scene.view.near, scene.view.far)
    rendered = rasterise(joined([mesh for mesh, _ in drawn]), camera)
    normals, tiles = mapped_normals(rendered, camera, drawn), seen[..., 3] == 27
    assert (rendered.covered == (seen[..., 3] > 0)).mean() > 0.99
    facing = normals * np.where((normals * rendered.positions).sum(axis=-1, keepdims=True) > 0, -1, 1)
    across = np.linalg.norm(np.cross(facing, seen[..., :3]), axis=-1)
    angles = np.degrees(np.arctan2(across, (facing * seen[..., :3]).sum(axis=-1)))
    smooth = angles[rendered.covered & ~tiles]
    print(np.percentile(smooth, (50, 90, 97)), np.percentile(angles[tiles], (50, 90)), tiles.mean())
    assert np.percentile(smooth, 50) < 0.01 and np.percentile(smooth, 95) < 0.5
    assert np.percentile(angles[tiles], 50) < 3


def test_the_live_scene_mirrors_the_studio_of_the_run(chosen):
    width, height = 256, 128
    panorama = np.array(chosen.page.evaluate(ALL_AROUND, [width, height])).reshape(height, width, 4)[..., :3]
    coarse = panorama.reshape(32, 4, 64, 4, 3).mean(axis=(1, 3))
    wanted = surroundings().reshape(32, 8, 64, 8, 3).mean(axis=(1, 3))
    print(np.corrcoef(coarse.ravel(), wanted.ravel())[0, 1], coarse.sum() / wanted.sum())
    assert np.corrcoef(coarse.ravel(), wanted.ravel())[0, 1] > 0.97
    assert 0.9 < coarse.sum() / wanted.sum() < 1.1


def test_without_webgl2_the_stills_stay_and_a_message_says_why(gl_browser, page_path):
    before = ("delete window.WebGL2RenderingContext", REFUSED)
    reasons = "this browser does not support WebGL 2", "this browser provides no WebGL 2 context"
    for script, why in zip(before, reasons, strict=True):
        page = Opened(gl_browser, page_path, before=script)
        page.page.wait_for_selector(".proof button:nth-child(4)")
        page.page.locator(".proof button").first.focus()
        page.says(".proof [role=status]", f"These images are stills: {why}.")
        assert page.page.locator(".proof canvas[data-live]").count() == 0 and page.said == []
        page.context.close()


MANY = (*CODES, "stereographic", "spherical", "equal_area_octahedral", "latitude_longitude", "xy_sign")


def check_pairs(gl_browser, folder, count: int) -> None:
    """Check that `count` random pairs of codes each show their own images, all drawn live once one of them is."""
    from normalbench.bench.keep.runs import read_run
    from normalbench.bench.show.report import write_report

    run_folder = studio_run(folder, MANY)
    page = Opened(gl_browser, write_report(run_folder, read_run(run_folder), run_folder / "report.html"))
    page.page.evaluate("change({ a: 'stereographic rg8', b: 'octahedral rg8' })")
    page.page.wait_for_selector(".proof canvas[data-live]")
    own: dict[str, np.ndarray] = {}
    rng = np.random.default_rng(count)
    for _ in range(count):
        names = [f"{MANY[place]} rg8" for place in rng.permutation(len(MANY))[:2]]
        page.page.evaluate("([a, b]) => change({ a, b })", names)
        shown = "(names) => viewer.pair.stills.map(({ name }) => name).join() === names.join()"
        page.page.wait_for_function(shown, arg=names)
        texts = page.texts(".proof button > span")[:2]
        assert [text.split(":")[0] for text in texts] == [f"A {names[0]}", f"B {names[1]}"]
        assert all("live, your GPU" in text for text in texts), texts
        for name, image in zip(names, images(page), strict=False):
            assert (own.setdefault(name, image) == image).all(), f"{name} beside {names}"
    assert len({image.tobytes() for image in own.values()}) == len(own) >= 2
    assert page.said == []
    page.context.close()


def test_codes_without_a_still_are_drawn_live(gl_browser, tmp_path):
    check_pairs(gl_browser, tmp_path / "run", count=10)
