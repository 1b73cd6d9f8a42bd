"""The images of a page: they match the run pixel by pixel; as many as fit are shown, the best first."""

import base64
import io
from pathlib import Path

import numpy as np
from PIL import Image
from test_report import Read, a_run, quality_row

from normalbench.bench.keep.runs import read_run
from normalbench.bench.show import report as report_command
from normalbench.bench.tables.registry import TABLES
from normalbench.reports.page import embedded
from normalbench.reports.page.pixels import LEAST_LOG2, STEPS_PER_OCTAVE, angle_bytes


def pixels(uri: str) -> np.ndarray:
    with Image.open(io.BytesIO(base64.b64decode(uri.partition(",")[2]))) as image:
        return np.asarray(image.convert("RGB"))


def codes_of(record: dict) -> np.ndarray:
    """Return the codes in a page's images, read in the way of pictures.js."""
    planes = np.concatenate([pixels(uri) for uri in record["codes"]], axis=-1).astype(np.int64)
    sizes, plane = [-(-bits // 8) for bits in record["bits"]], 0
    codes = np.zeros((*planes.shape[:2], len(sizes)), np.int64)
    for level in range(max(sizes)):
        for i, size in enumerate(sizes):
            if level < size:
                codes[..., i] = codes[..., i] * 256 + planes[..., plane]
                plane += 1
    return codes >> np.array([8 * size - bits for size, bits in zip(sizes, record["bits"], strict=True)])


def test_codes_of_any_size_are_recovered_from_images():
    random = np.random.default_rng(0)
    for bits in ((8, 8), (10, 10), (11, 11, 10), (16, 16), (8, 8, 1), (32, 20, 3)):
        codes = np.stack([random.integers(0, 2**n, (6, 9), np.uint32, endpoint=False) for n in bits], axis=-1)
        record = {"codes": embedded._code_uris(codes, bits), "bits": bits}
        assert (codes_of(record) == codes).all(), bits


def test_an_angle_as_a_byte_is_within_the_stated_error():
    degrees = np.array([0.0, 1e-5, 0.003, 0.3, 5.0, 90.0, 180.0, np.nan])
    kept = angle_bytes(degrees, np.ones(8, bool)).astype(float)
    shown = 2.0 ** (LEAST_LOG2 + (kept - 1) / STEPS_PER_OCTAVE)
    assert kept[0] == 1 and (abs(shown[1:7] / degrees[1:7] - 1) < 0.045).all() and kept[7] == 255, "not a number"
    assert (angle_bytes(degrees, np.zeros(8, bool)) == 0).all(), "the background"


def rendered_run(folder: Path) -> Path:
    """Write a run with rendered images: two codecs in rgba8, one with red off by a step and one exact."""
    about = {"pipeline": "hybrid", "scene": "gloss", "power": 47.0, "shadow": True, "layout": "fp32"}
    about |= {"storage": "rgba8", "rounding": "nearest", "light_buffer": "rgba32f", "light_targets": 2}
    rows = [
        TABLES["render"].empty() | about | {"encoding": name, "psnr_db": figure, "normal_psnr_db": figure, "mse": 1e-4}
        for name, figure in (("xy", 40.0), ("octahedral", 50.0))
    ]
    a_run(folder, {"render": [row | {"normal_bits": 16} for row in rows]}, request={"tables": ["render"]})
    image = np.random.default_rng(1).integers(10, 240, (24, 32, 3), np.uint8)
    (folder / "images").mkdir()
    off = {"reference": 0, "fp32-xy-rgba8-rgba32fx2-final": 3, "fp32-octahedral-rgba8-rgba32fx2-final": 0}
    for name, by in off.items():
        moved = image.copy()
        moved[..., 0] += by
        Image.fromarray(moved).save(folder / "images" / f"gloss-power47-hybrid-{name}.png")
    return folder


def test_flip_is_offered_if_the_run_has_it(run, tmp_path):
    folder = rendered_run(tmp_path / "run")
    gathered = report_command.gathered(folder, read_run(folder))
    assert embedded.gallery(gathered.subjects).subjects[0]["flip"] is False
    for name in ("xy", "octahedral"):
        path = folder / f"images/gloss-power47-hybrid-fp32-{name}-rgba8-rgba32fx2-flip.png"
        Image.new("RGB", (32, 24), (128, 128, 128)).save(path)
    for place in ("", "somewhere"):
        assert embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects, place).subjects[0]["flip"]
    (subject,) = embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects).subjects
    assert (pixels(subject["codecs"][0]["flip"]) == 128).all()
    assert run("report", str(folder), "--pictures", "beside", "-o", str(tmp_path / "100%#.html"))[0] == 0
    assert '"100%25%23-pictures/0.js"' in (tmp_path / "100%#.html").read_text(), "an address"


def test_rendered_images_are_stored_as_differences_from_the_exact_image(tmp_path):
    folder = rendered_run(tmp_path / "run")
    (subject,) = embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects).subjects
    assert subject["title"] == "the image of gloss at power 47"
    assert [codec["label"] for codec in subject["codecs"]] == ["octahedral rgba8", "xy rgba8"], "the best first"
    exact, off = pixels(subject["original"]), pixels(subject["codecs"][1]["apart"])
    with Image.open(folder / "images/gloss-power47-hybrid-fp32-xy-rgba8-rgba32fx2-final.png") as final:
        assert (exact + off == np.asarray(final)).all()
    assert (pixels(subject["codecs"][0]["apart"]) == 0).all()


def test_images_next_to_the_page_are_complete_and_full_size(run, tmp_path):
    folder = rendered_run(tmp_path / "run")
    status, out, _ = run("report", str(folder), "--pictures", "beside", "-o", str(tmp_path / "page.html"))
    assert (status, out) == (0, f"{tmp_path / 'page.html'}\n")
    names = sorted(path.name for path in (tmp_path / "page-pictures").iterdir())
    assert names == ["0.js", "1.js"]
    assert (
        (tmp_path / "page-pictures/0.js")
        .read_text()
        .startswith('keepPicture("0.js", {"apart": "data:image/webp;base64,')
    )
    policies = [a["content"] for a in Read((tmp_path / "page.html").read_text()).all("meta") if "http-equiv" in a]
    assert "'self' file:" in policies[0]


def pick_row(encoding: str, mean: float, slots: int) -> dict:
    """Return the row of an encoding in an answer."""
    about = {"asked": "rg8", "storage": "rg8", "encoding": encoding, "normals": "sphere", "scene": "gloss", "bits": 16}
    about |= {
        "aim": "angle",
        "readers": 4,
        "worth": 3.0,
        "enough": 0.35,
        "packed": False,
        "domain": "sphere",
        "family": "navi21",
        "invalid": 0,
    }
    about |= {"dearest_family": "navi21", "lost_percent": 0.0, "against": False, "beside": False, "table": False}
    figures = {"angle_mean_deg": mean, "angle_max_deg": 1.0, "image_db_gloss_47": 50.0, "free_bits": 0}
    costs = {"encode_slots": slots, "decode_slots": 0, "slots_once": slots, "slots": slots, "loops": 0}
    return TABLES["pick"].empty(["gloss_47"]) | about | figures | costs


def test_the_answer_is_on_the_first_screen_and_the_first_line(run, tmp_path):
    """The answer includes its cost, and hostile names are escaped."""
    rows = [pick_row("<b>fine", 0.2, 90), pick_row("_cheap_ www.a.b", 0.3, 10)]
    folder = a_run(tmp_path / "run", {"pick": rows, "quality": [quality_row("xyz")]})
    assert run("report", str(folder))[0] == 0
    page = (folder / "report.html").read_text()
    answer = page.index('<h2 class="lead">rg8, on sphere: take &lt;b&gt;fine.</h2>')
    costs = page.index(
        "90 issue slots to encode and 0 to decode on navi21. With 4 decoding passes this counts as 154, 1.9 times"
    )
    assert answer < costs < page.index('id="quality"')
    assert page.index("Cheaper: _cheap_ www.a.b, 3.5 dB worse") and "<b>fine" not in page
    text = run("report", str(folder), "--markdown")[1]
    assert (
        "**rg8, on sphere: take &#60;b&#62;fine.**" in text
        and "Cheaper: &#95;cheap&#95; www&#46;a&#46;b, 3.5 dB worse" in text
    )


def test_answer_table_is_open_with_rejects_folded_and_its_storage_first(run, tmp_path):
    lost = pick_row("xy", 0.5, 10) | {"domain": "hemisphere", "lost_percent": 50.0}
    rows = [pick_row("octahedral", 0.2, 90), pick_row("spheremap", 0.3, 10), lost]
    sets = [("playground", "rgba8"), ("sphere", "rg8"), ("playground", "rg8")]
    quality = [quality_row("xyz", normals=normals, storage=storage) for normals, storage in sets]
    folder = a_run(tmp_path / "run", {"pick": rows, "quality": quality})
    assert run("report", str(folder))[0] == 0
    page = (folder / "report.html").read_text()
    table, fold = page.index("<div data-codes>"), page.index('<details class="aside">')
    assert page.rindex("<details", 0, table) < page.rindex("</details>", 0, table), "in no fold"
    assert fold < page.index("<p>Left out: xy (") < page.index("</details>", fold) and "<li>Left out" not in page
    titles = [page.index(f"{normals}, {storage}: ") for normals, storage in (sets[1], sets[2], sets[0])]
    assert titles == sorted(titles)
    assert "Left out" not in run("report", str(folder), "--markdown")[1]
