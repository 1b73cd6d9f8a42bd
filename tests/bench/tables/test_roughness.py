"""The roughness from which an encoding's reflections are acceptable."""

from contextlib import ExitStack
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from normalbench.bench.tables.roughness.frames import MOVING, NONE, STILL, Accumulation, draw_again, halton, moved
from normalbench.bench.tables.roughness.measure import Pictures, RoughnessCase, in_order
from normalbench.bench.tables.roughness.objects import OBJECTS, busiest
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.environment.environment import Environment, directions

pytestmark = pytest.mark.usefixtures("gl")


CODEC = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])


def half_lit() -> Environment:
    """Return a small environment that is cheap to filter: bright where x is above 0."""
    light = np.where(directions(32)[..., :1] > 0, 2.0, 0.1) * np.ones(3)
    return Environment("half lit", light.astype(np.float32))


@pytest.mark.parametrize("codec", [None, CODEC], ids=["exact", "octahedral rg8"])
@pytest.mark.parametrize("name", OBJECTS)
def test_redrawn_images_equal_whole_frames(gl, name, codec):
    """Only one target is overwritten, without running all passes; every pixel is the same to the bit."""
    case = RoughnessCase((CODEC,), name, half_lit(), (0.1,), (64, 64))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        frames = pictures.opened(stack, codec, Accumulation())
        for roughness in (0.0, 0.37, 1.0):
            again = pictures.image(frames, roughness)
            frames.made[0].draw(pictures.what.scene(roughness))
            whole = pictures.display.image(frames.made[0].image())
            whole = np.where(frames.covered[..., None], whole, 0).astype(np.float32)
            assert np.array_equal(again, whole), f"{np.abs(again - whole).max()} at roughness {roughness}"
        assert frames.covered.mean() > (0.98 if "panel" in name else 0.75), f"{frames.covered.mean()} is covered"


def test_a_picture_of_several_frames_is_their_mean(gl):
    """Each frame has its own viewpoint and its own noise; the mean is of light, before it is displayed."""
    case = RoughnessCase((CODEC,), "sphere", half_lit(), (0.1,), (48, 48))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        opened = pictures.opened(stack, CODEC, Accumulation(MOVING, 3))
        frames = []
        for drawing in opened.made:
            draw_again(drawing, 0.3)
            frames.append(np.where((drawing.gbuffer()[0][..., 2] != 0)[..., None], drawing.image(), 0.0))
        assert np.allclose(opened.light(0.3), np.mean(frames, axis=0), atol=1e-6)
        apart = [np.abs(a - b).max() for a, b in pairwise(frames)]
        assert min(apart) > 0.01, apart


def test_a_picture_moves_by_the_same_number_of_pixels_as_its_view(gl):
    """The view moves two pixels to the right and one up; except at the border, the shifted image is the same."""
    case = RoughnessCase((CODEC,), "panel20", half_lit(), (0.1,), (64, 64))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        what, light = pictures.what, pictures.exact(1).light(0.3)
        there = replace(what, view=moved(what.view, case.size, 2.0, 1.0)).scene(0.3)
        drawing = pictures.opened(stack, None, Accumulation()).made[0]
        drawing.draw(there)
        # Row 0 is on top: through points above its own middles a row sees what the row before it saw.
        expected, image = light[4:-5, 6:-4], drawing.image()[5:-4, 4:-6]
        assert np.abs(image - expected).max() < 2e-4 * expected.max(), np.abs(image - expected).max()
        unmoved = np.abs(light[5:-4, 4:-6] - expected).max()
        assert unmoved > 2e-3 * expected.max(), unmoved


def test_the_points_within_a_pixel_are_a_halton_sequence():
    assert [halton(index, 2) for index in range(1, 5)] == [1 / 2, 1 / 4, 3 / 4, 1 / 8]
    assert [halton(index, 3) for index in range(1, 5)] == pytest.approx([1 / 3, 2 / 3, 1 / 9, 4 / 9])


def test_objects_are_turned_to_the_busiest_part_of_an_environment():
    """The busiest part is where the two halves meet, at x = 0, to within half a window."""
    way = busiest(half_lit())
    assert abs(way[0]) < np.sin(np.radians(5)) and np.linalg.norm(way) == pytest.approx(1)


def test_the_object_and_environment_that_need_the_most_roughness_decide():
    """One row decides for each encoding and threshold. A row for which no roughness is enough counts as highest."""
    keys = {"encoding": "octahedral", "rounding": "nearest", "bits": 16, "object": "sphere", "environment": "sky"}
    keys |= {"dither": "none", "frames": 1}
    rows = [
        keys | {"storage": storage, "threshold": threshold, "roughness": roughness}
        for storage, threshold, roughness in (
            ("rg8", 0.1, 0.2), ("rg8", 0.1, 0.3), ("rg8", 0.05, None), ("rg8", 0.05, 1.0), ("rg16", 0.1, 0.0)
        )
    ]  # fmt: skip
    decides = [(r["storage"], r["threshold"], r["roughness"]) for r in in_order(rows) if r["decides"]]
    assert sorted(decides, key=str) == [("rg16", 0.1, 0.0), ("rg8", 0.05, None), ("rg8", 0.1, 0.3)]


def test_rows_without_noise_come_before_rows_with_noise():
    """One frame comes before several, and each row decides for itself."""
    row = {"encoding": "octahedral", "storage": "rg8", "rounding": "nearest", "bits": 16, "threshold": 0.1}
    ways = [(MOVING, 1), (NONE, 8), (STILL, 1), (NONE, 1)]
    rows = in_order([row | {"dither": dither, "frames": frames, "roughness": 0.2} for dither, frames in ways])
    assert [(r["dither"], r["frames"]) for r in rows] == [(NONE, 1), (NONE, 8), (STILL, 1), (MOVING, 1)]
    assert all(r["decides"] for r in rows)


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--object", "cube"], "unknown object 'cube'; known: all, sphere, panel20, panel4, plaster"),
        (["--environment", "moon"], "unknown environment 'moon'"),
        (["--environment", ","], "name at least one"),
        (["--environment", "missing.hdr"], "missing.hdr"),
        (["--threshold", "0"], "--threshold 0"),
        (["--size", "0x0"], "--size"),
        (["--dither", "blue"], "unknown dither 'blue'; known: all, none, still, moving"),
        (["--frames", "0"], "--frames 0"),
        (["--frames", "8,65"], "--frames 8,65"),
    ],
)
def test_bad_input_is_a_one_line_error(run, arguments, said):
    status, out, err = run("roughness", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
