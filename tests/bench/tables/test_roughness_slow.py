"""The roughness from which an encoding's reflections are acceptable."""

import json
from contextlib import ExitStack
from itertools import product

import numpy as np
import pytest
from test_roughness import CODEC, half_lit

from normalbench.bench.tables.roughness.frames import MOVING, NONE, STILL, Accumulation
from normalbench.bench.tables.roughness.measure import Pictures, RoughnessCase
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import from_array

pytestmark = pytest.mark.usefixtures("gl")


SMALL = ("--size", "64x64", "--environment", "sky", "--storage", "rg8")


@pytest.mark.parametrize(
    "encoding, storage",
    [("octahedral", "rg8"), ("octahedral", "rg8_snorm"), ("octahedral", "rgb8_12_12"), ("cube", "rgb8_10_10_3")],
)
def test_the_shaders_noise_matches_the_emulation(gl, encoding, storage):
    """The G-buffer matches exact normals that JAX encodes, moves by the same noise and stores."""
    codec = Codec(ENCODINGS[encoding], STORAGES[storage])
    case = RoughnessCase((codec,), "panel20", half_lit(), (0.1,), (80, 80))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        axes = pictures.what.view.matrix()[:3, :3]
        exact = from_array(pictures.exact(1).made[0].gbuffer()[1][..., :3] @ axes)
        code = codec.encoding.encode(exact, exact)
        for seen, frame in ((Accumulation(), None), (Accumulation(STILL), 0)):
            noise = np.zeros((80, 80, 4), np.float32)
            if frame is not None:
                # GL's rows begin at the bottom; the tile repeats after 64 pixels.
                noise = np.pad(codec.dither(frame).added, ((0, 16), (0, 16), (0, 0)), mode="wrap")[::-1]
            stored = codec.store(type(code)(*(c + noise[..., i] for i, c in enumerate(code))))
            expected = np.stack([np.asarray(c) for c in codec.encoding.decode(stored, exact)], axis=-1) @ axes.T
            normals = pictures.opened(stack, codec, seen).made[0].gbuffer()[1][..., :3]
            # Near a tie the two languages may round apart: a step of 8 bits is 0.008.
            is_same = np.abs(normals - expected).max(axis=-1) < 1e-5
            assert is_same.mean() > 0.995, f"{1 - is_same.mean()} of pixels differ with {seen}"


def test_noise_makes_steps_less_visible(gl):
    """FLIP on a panel falls in one frame, and more in the mean of eight. Without noise eight frames change little."""
    case = RoughnessCase((CODEC,), "panel4", half_lit(), (0.1,), (64, 64))
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        opened = {way: pictures.opened(stack, CODEC, Accumulation(*way)) for way in product((NONE, MOVING), (1, 8))}
        worst = {way: pictures.figures(frames, 0.3, True)["flip_p99"] for way, frames in opened.items()}
    assert worst[MOVING, 8] < 0.6 * worst[MOVING, 1] and worst[MOVING, 1] < 0.6 * worst[NONE, 1], worst
    assert worst[NONE, 8] == pytest.approx(worst[NONE, 1], rel=0.1), worst


def test_plaster_shows_the_steps_of_an_encoding_at_every_roughness(gl):
    """FLIP is above 0.05 for 7:7 wherever it is measured, but not for 8:8 and 10:10. Roughness affects highlights."""
    codecs = [Codec(ENCODINGS["octahedral"], by_rule("unorm", (bits, bits))) for bits in (7, 8, 10)]
    case = RoughnessCase(tuple(codecs), "plaster", None, (0.05,), (256, 256))
    assert case.name == "plaster in sun"
    with ExitStack() as stack:
        pictures = Pictures(gl, stack, case)
        for roughness in (0.1, 0.6, 1.0):
            figures = [pictures.figures(pictures.opened(stack, c, Accumulation()), roughness, True) for c in codecs]
            coarse, usual, fine = (row["flip_p99"] for row in figures)
            assert coarse > 0.05 > usual > 2 * fine, (roughness, coarse, usual, fine)
        exact = [pictures.exact(1).light(roughness) for roughness in (0.2, 0.6)]
    assert exact[0].max() > 2 * exact[1].max() and np.median(exact[0]) == pytest.approx(np.median(exact[1]), rel=0.05)


def test_an_index_is_not_dithered_and_a_message_says_so(run):
    """The rows of the index without noise are measured."""
    status, out, err = run(
        "roughness", "--object", "panel4", *SMALL, "--encoding", "spherical_fibonacci", "--dither", "still",
        "--threshold", "0.1", "--frames", "1,2", "--format", "json",
    )  # fmt: skip
    rows = json.loads(out)
    assert status == 0, err
    assert len(err.splitlines()) == 1 and "spherical_fibonacci/rg8 cannot be dithered" in err and "an index" in err, err
    skipped = [(row["dither"], row["frames"]) for row in rows if row["skipped"]]
    assert skipped == [("still", 1), ("still", 2)] and len(rows) == 2 + 2 * 25


def test_the_lowest_roughness_meets_its_threshold_and_a_step_lower_does_not(run):
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
