"""From which roughness on a code carries reflections."""

import json
from contextlib import ExitStack

import numpy as np
import pytest

from normalbench.bench.tables.roughness.measure import Case, Pictures, in_order, layout_of
from normalbench.bench.tables.roughness.objects import OBJECTS, busiest
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.environment.environment import Environment, directions
from normalbench.gbuffer.layouts.presets import LAYOUTS

pytestmark = pytest.mark.usefixtures("gl")
CODEC = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])
SMALL = ("--size", "64x64", "--environment", "sky", "--storage", "rg8")


def half_lit() -> Environment:
    """Small, and cheap to filter: bright where x is above 0."""
    light = np.where(directions(32)[..., :1] > 0, 2.0, 0.1) * np.ones(3)
    return Environment("half lit", light.astype(np.float32))


@pytest.mark.parametrize("layout", [LAYOUTS["fp32"], layout_of(CODEC)], ids=["exact", "octahedral rg8"])
@pytest.mark.parametrize("name", OBJECTS)
def test_pictures_that_are_drawn_again_are_those_of_whole_frames(gl, name, layout):
    """One target is overwritten in place of all passes: every pixel is the same to the bit."""
    case = Case((CODEC,), name, half_lit(), (0.1,), (64, 64))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        made = pictures.opened(layout)
        for roughness in (0.0, 0.37, 1.0):
            again = pictures.image(made, roughness)
            made.draw(pictures.what.scene(roughness))
            whole = np.where(pictures.covered[..., None], pictures.display.image(made.image()), 0).astype(np.float32)
            assert np.array_equal(again, whole), f"{np.abs(again - whole).max()} at roughness {roughness}"
        assert pictures.covered.mean() > (0.75 if name == "sphere" else 0.98), f"{pictures.covered.mean()} is covered"


def test_objects_are_turned_to_where_an_environment_is_busiest():
    """Where its halves meet: at x = 0, to half a window."""
    way = busiest(half_lit())
    assert abs(way[0]) < np.sin(np.radians(5)) and np.linalg.norm(way) == pytest.approx(1)


def test_the_least_roughness_keeps_its_threshold_and_a_step_less_does_not(run):
    status, out, err = run(
        "roughness", "--object", "panel20", "--size", "96x96", "--environment", "strips", "--storage", "rg8,rg16",
        "--format", "json",
    )  # fmt: skip
    assert status == 0, err
    rows = json.loads(out)
    answers = {(row["storage"], row["threshold"]): row for row in rows if row["threshold"] is not None}
    assert len(answers) == 4 and len(rows) == 4 + 2 * 24
    for (storage, threshold), row in answers.items():
        assert row["flip_p99"] <= threshold and row["decides"], row
        above = [r for r in rows if r["storage"] == storage and r["threshold"] is None and r["flip_p99"] is not None]
        assert all(r["flip_p99"] <= threshold for r in above if r["roughness"] >= row["roughness"]), (
            storage,
            threshold,
        )
    for storage in ("rg8", "rg16"):
        assert answers[storage, 0.1]["roughness"] <= answers[storage, 0.05]["roughness"]
    assert answers["rg16", 0.1]["roughness"] < answers["rg8", 0.1]["roughness"]


def test_the_object_and_environment_that_need_most_decide():
    """Of each code and threshold one; a row where no roughness is enough needs more than all others."""
    keys = {"encoding": "octahedral", "rounding": "nearest", "bits": 16, "object": "sphere", "environment": "sky"}
    rows = [
        keys | {"storage": storage, "threshold": threshold, "roughness": roughness}
        for storage, threshold, roughness in (
            ("rg8", 0.1, 0.2), ("rg8", 0.1, 0.3), ("rg8", 0.05, None), ("rg8", 0.05, 1.0), ("rg16", 0.1, 0.0)
        )
    ]  # fmt: skip
    decides = [(r["storage"], r["threshold"], r["roughness"]) for r in in_order(rows) if r["decides"]]
    assert sorted(decides, key=str) == [("rg16", 0.1, 0.0), ("rg8", 0.05, None), ("rg8", 0.1, 0.3)]


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--object", "cube"], "unknown object 'cube'; known: all, sphere, panel20, panel4"),
        (["--environment", "moon"], "unknown environment 'moon'"),
        (["--environment", "studio,studio"], "studio is named twice"),
        (["--environment", ","], "name at least one"),
        (["--environment", "missing.hdr"], "missing.hdr"),
        (["--threshold", "0"], "--threshold 0"),
        (["--size", "0x0"], "--size"),
    ],
)
def test_bad_input_is_one_line(run, arguments, said):
    status, out, err = run("roughness", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
