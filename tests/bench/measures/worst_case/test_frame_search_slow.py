"""The largest rotations of tangent-frame codecs: a closed form, samples that stay below, and columns of the table."""

import json
import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.bench.measures.worst_case import frame_search
from normalbench.bench.measures.worst_case.frame_search import worst_frame
from normalbench.bench.tables.frames import measure
from normalbench.bench.tables.frames.sets import rotations
from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.storages.storage import FRAME_STORAGES


def codec_of(encoding: str, storage: str) -> FrameCodec:
    return FrameCodec(FRAME_ENCODINGS[encoding], FRAME_STORAGES[storage])


def test_smallest_three_is_worst_at_four_equal_components():
    """The largest component compensates for the others: errors of e, e and, in the component with the handedness bit,
    2 e move the quaternion by sqrt(1 + 1 + 4 + 16) e, where e is sqrt(1/2) / 65535 at 16 bits. The rotation is twice
    that. The search comes within 2% of it, because no corner of a cell is exactly at that place."""
    closed = math.degrees(2 * math.sqrt(22) * math.sqrt(0.5) / 65535)
    worst = worst_frame(codec_of("smallest_three", "rgba16"))
    assert 0.98 * closed < worst.angle_deg < 1.0001 * closed
    assert np.abs(worst.quaternion) == pytest.approx(0.5, abs=0.02)
    assert worst.moved_deg < 1e-6 * worst.angle_deg


def test_the_reported_frame_has_the_stated_rotation():
    """The codec's float64 maths is run one operation at a time. The frame is at a corner of a cell, so its last bit
    selects one of two codes with nearly the same error."""
    codec = codec_of("octahedral_angle", "rgb10a2")
    worst = worst_frame(codec)
    with jax.enable_x64(True):
        q, hand = jnp.asarray(worst.quaternion)[:, None], jnp.asarray([worst.hand])
        moved = float(frame_search._moves(codec, q, hand)[0])
    assert math.degrees(2 * math.asin(math.sqrt(moved / 8))) == pytest.approx(worst.angle_deg, rel=2e-3)


CODECS = [f"{e.name}/{e.storages[0]}" for e in FRAME_ENCODINGS.values()]
# Three ways to keep a frame: the smaller components, all four, and a normal with an angle.
WAYS = [name for name in CODECS if name.startswith(("smallest_three/", "qtangent/", "octahedral_angle/"))]


@pytest.mark.parametrize("name", WAYS)
def test_no_sample_is_above_the_supremum(name):
    """2^18 rotations by Haar's measure come close to the supremum, and only float32 rounding can exceed it."""
    codec = codec_of(*name.split("/"))
    met = measure.measure(measure.FrameCase(codec, rotations(2**18, 5), "jax"))["rotation_max_deg"]
    assert 0.75 < met / worst_frame(codec).angle_deg < 1.001


def test_the_table_has_the_supremum_on_request(run):
    words = ["frames", "--encoding", "hexadecachoral", "--storage", "rgba8", "--backend", "jax", "--count", "4096"]
    (plain,) = json.loads(run(*words, "--format", "json")[1])
    (row,) = json.loads(run(*words, "--worst-case", "--format", "json")[1])
    assert plain["rotation_sup_deg"] is None
    assert row["rotation_sup_deg"] > row["rotation_max_deg"] == plain["rotation_max_deg"]
    assert row["reached_max_percent"] == pytest.approx(100 * row["limit_max_deg"] / row["rotation_sup_deg"])
