"""The images of a page: they match the run pixel by pixel; as many as fit are shown, the best first."""

import json
import shutil
from pathlib import Path

import numpy as np
from PIL import Image
from test_pictures import codes_of, pick_row, pixels
from test_report import a_run

from normalbench.bench.keep.runs import read_run
from normalbench.bench.show import report as report_command
from normalbench.reports.page import embedded


def answered_run(folder: Path) -> Path:
    """Write a run with an answer for two storages on two scenes, each with images; in rg8 on gloss, red is 2 steps
    off."""
    (folder / "images").mkdir(parents=True)
    of_room = {"scene": "gloss,room", "image_db_room_47": 50.0}
    rows = [
        row | of_room | {"storage": storage, "asked": storage}
        for storage in ("rg8", "rgb10a2")
        for row in (pick_row("fine", 0.2, 9), pick_row("xy", 0.3, 5) | {"bits": 15})
    ]
    for scene in ("gloss", "room"):
        for storage in ("rg8", "rgb10a2"):
            for name in ("fine", "xy"):
                image = Image.new("RGB", (32, 24), (52 if (scene, storage) == ("gloss", "rg8") else 50, 60, 70))
                image.save(folder / f"images/pick-{scene}-power47-{name}-{storage}-final.png")
        Image.new("RGB", (32, 24), (50, 60, 70)).save(folder / f"images/pick-{scene}-power47-reference.png")
    return a_run(folder, {"pick": rows}, request={"tables": ["pick"]})


def test_images_of_an_answer_show_its_scenes_with_the_best_codec_first(tmp_path):
    folder = answered_run(tmp_path / "run")
    first, second = embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects).subjects
    assert [first["title"], second["title"]] == ["the answer on gloss at power 47", "the answer on room at power 47"]
    assert [codec["codec"] for codec in first["codecs"]] == ["fine rg8", "xy rg8", "fine rgb10a2", "xy rgb10a2"]
    assert pixels(first["codecs"][0]["apart"])[0, 0].tolist() == [2, 0, 0]
    assert pixels(second["codecs"][0]["apart"]).max() == 0


def test_images_in_the_page_match_the_run_pixel_by_pixel(results):
    folder, *_ = results
    (subject,) = report_command.gathered(folder, read_run(folder)).subjects
    (inside,) = embedded.gallery([subject]).subjects
    assert (inside["title"], inside["step"]) == ("the normals of playground", 2)
    assert [codec["label"] for codec in inside["codecs"]][:2] == ["octahedral_precise rgba8", "octahedral rgba8"]
    for record in inside["codecs"][:3]:
        name = f"playground-{record['label'].replace(' ', '-')}"
        with (
            np.load(folder / "images" / f"{name}.npz") as kept,
            Image.open(folder / f"images/{name}-decoded.png") as png,
        ):
            assert (pixels(record["angle"])[..., 0] == kept["angle"][::2, ::2]).all(), name
            assert (codes_of(record) == kept["codes"][::2, ::2]).all(), name
            assert (pixels(record["decoded"]) == np.asarray(png)[::2, ::2]).all(), name


def test_images_that_do_not_fit_are_listed_and_the_best_come_first(results):
    (subject,) = report_command.gathered(results[0], read_run(results[0])).subjects
    gallery = embedded.gallery([subject], budget=300_000)
    (shown,) = gallery.subjects
    assert len(json.dumps(gallery.subjects)) <= 310_000
    assert (
        shown["codecs"][0]["label"] == "octahedral_precise rgba8"
        and "xy rgba8, the normals of playground" in gallery.left_out
    )
    assert len(shown["codecs"]) + len(gallery.left_out) == len(subject.codecs)
    ranked = [codec.label for codec in sorted(subject.codecs, key=lambda one: one.rank)]
    assert {c["label"] for c in shown["codecs"]} == set(ranked[: len(shown["codecs"])]), "no worse one in its place"


def test_damaged_images_are_reported(results, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(results[0], folder)
    (folder / "images/playground-octahedral-rgba8.npz").write_bytes(b"PK no")
    (folder / "images/playground-xy-rgba8-decoded.png").write_bytes(b"\x89PNG\r\n\x1a\nno")
    Image.new("RGB", (8, 8)).save(folder / "images/playground-xyz-rgba8-decoded.png")
    gallery = embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects)
    assert sorted(name.split(",")[0] for name in gallery.damaged) == ["octahedral rgba8", "xy rgba8", "xyz rgba8"]
    (folder / "images/playground-normals.png").write_bytes(b"no")
    gallery = embedded.gallery(report_command.gathered(folder, read_run(folder)).subjects)
    assert (gallery.damaged, gallery.subjects) == (["the normals of playground"], [])
