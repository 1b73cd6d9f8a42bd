"""Tangent frame encodings: bounded errors, preserved handedness and decoded frames that are stored unchanged."""

import inspect

import numpy as np
import pytest
from parity.comparison import ULP, rows
from parity.frames import (
    CODECS,
    RANDOM,
    as_frame,
    decoded,
    gl_trip,
    hard_frames,
    padded,
    round_trip,
    trip,
)

from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.rotation import quaternion_of
from normalbench.encodings.storages.storage import FRAME_STORAGES


@pytest.mark.parametrize("name", sorted(FRAME_ENCODINGS))
def test_a_frame_encoding_is_complete(name):
    encoding = FRAME_ENCODINGS[name]
    assert encoding.components in (3, 4)
    assert encoding.hand_in in (None, *range(encoding.components))
    assert not encoding.settle or inspect.getdoc(encoding.settle), "special cases are said"


def angles_between(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the angle of the rotation between frames, regardless of their handedness, in degrees."""
    axes = []
    for frames in (one.astype(np.float64), other.astype(np.float64)):
        n, t = frames[:, :3], frames[:, 4:7]
        axes.append(np.stack([t, np.cross(n, t), n], axis=1))
    squared = ((axes[0] - axes[1]) ** 2).sum(axis=(1, 2))
    return np.degrees(2 * np.arcsin(np.minimum(np.sqrt(squared / 8), 1)))


# What is rebuilt as a root is off by 2^-11 by float32 alone, where it is near 0.
OF_A_ROOT, BY_A_ROOT_DEG = "rotation_xyz", np.degrees(2.0**-10)


# What a frame of a code is off at most, in steps of its widest number. At four equal components the sum of their
# absolutes is 2, and half a step of three numbers moves the fourth by three halves: 2 x 2 x sqrt(3/4 + 9/4) = sqrt(48).
# The axis of a half turn is off by 2.12 steps, as octahedral normals are, which turns by twice that; the angle is off
# by half a step of half turns: sqrt((2 x 2.12)^2 + (pi / 2)^2) = sqrt(20.5).
STEPS = {"hexadecachoral": np.sqrt(48), "rotation_rodrigues": np.sqrt(12), "axis_angle": np.sqrt(20.5)}


def most(codec: FrameCodec) -> float:
    """Return the largest possible error of a frame in degrees, to first order.

    In steps of the widest number the error is sqrt(11) for smallest three, whose third number has steps twice as
    wide, if all four components are equal, and 2.7 for most other encodings. The error of float32 is added.
    """
    step = max(2.0 / (codec.storage.levels(i) - 1) for i, levels in enumerate(codec.encoding.levels) if not levels)
    if codec.encoding.name == OF_A_ROOT:
        # A half turn has w = 0, and three numbers that are half a step too short have sqrt(sqrt(3) step).
        return np.degrees(2 * np.sqrt(np.sqrt(3) * step + 2.0**-21) + 3 * step)
    return np.degrees(STEPS.get(codec.encoding.name, np.sqrt(11)) * step) + 1e-4


@pytest.mark.parametrize("codec", CODECS[:6], ids=lambda c: c.name)
def test_frame_errors_are_bounded_and_handedness_is_kept(gl, codec):
    frames = padded(hard_frames())
    for language, back in (("JAX", trip(codec)), ("GLSL", gl_trip(gl, codec))):
        assert np.isfinite(back).all(), language
        angles, lost = angles_between(frames, back), back[:, 3] != frames[:, 3]
        i = int(np.argmax(angles))
        assert angles[i] <= most(codec), f"{language}: {frames[i]!r} is {back[i]!r}, {angles[i]:.4g} degrees off"
        assert codec.encoding.hand_in is None or not lost.any(), f"{language}: {frames[lost][0]!r} is {back[lost][0]!r}"


@pytest.mark.parametrize("codec", CODECS[:6], ids=lambda c: c.name)
def test_a_decoded_frame_is_stored_again_unchanged(codec):
    """Encoding a decoded frame gives the same code: always for an angle about the stored normal, and for nearly all
    quaternions. If a quaternion's two largest components are nearly equal, the other may become the largest. Four
    components are normalised when decoded, which moves them off their steps."""
    first = trip(codec)
    second = round_trip(codec)(first)
    moved = angles_between(first, second) > (BY_A_ROOT_DEG if codec.encoding.name == OF_A_ROOT else 1e-4)
    settled = codec.encoding.settle is not None
    share = np.mean(moved if settled else moved[slice(*RANDOM)])
    assert share <= (0 if settled else 0.02), f"{share:.4%} of the frames have moved"


def test_half_turns_and_the_identity_have_the_expected_quaternions():
    """The identity is (0, 0, 0, 1); a half turn about an axis is that axis with w = 0."""
    x, _, z = np.eye(3)
    frames = np.float32([[*n, 1, *t, 0] for n, t in ((z, x), (-z, x), (-z, -x), (z, -x))])
    quaternions = rows(quaternion_of(as_frame(frames)))
    expected = np.float32([[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])
    assert quaternions == pytest.approx(expected, abs=1e-7)


def test_both_ends_of_the_angle_range_decode_to_the_same_tangent():
    """A tangent opposite to the fixed tangent is stored as -1 or 1; both decode to the same tangent."""
    encoding = FRAME_ENCODINGS["octahedral_angle"]
    ends = np.float32([[0.3, -0.2, angle, 1] for angle in (-1, 1)])
    lower, other = decoded(encoding, ends)
    assert lower == pytest.approx(other, abs=2 * ULP)


def test_an_ordinary_component_does_not_fit_in_one_bit():
    """The fourth component of qtangent does not fit in the single bit of 10:10:11:1."""
    reason = FrameCodec(FRAME_ENCODINGS["qtangent"], FRAME_STORAGES["rgba8_10_10_11_1"]).misfit
    assert reason == "component 4 has only 1 bits in 10:10:11:1 in RGBA8; ordinary components need at least 4"
