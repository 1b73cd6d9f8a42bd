"""Tangent frame codes: the languages agree, targets store as emulated, and no hand is lost."""

import inspect
import itertools
from functools import cache
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from mutants import swapped_calls
from neighbours import around

from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.frame.octahedral_angle import SEAM
from normalbench.encodings.rotation import Frame, frame_of, frame_of_quaternion, quaternion_of
from normalbench.encodings.storages.storage import FRAME_STORAGES
from normalbench.encodings.vec import Vec3, Vec4
from normalbench.gbuffer.codecs.frame_passes import FramePasses, exact_frames
from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError

ROOT = Path(__file__).parents[2]
ULP = 2.0**-23
EVERY = sorted(FRAME_ENCODINGS)
CODECS = [FrameCodec(encoding, storage) for encoding in FRAME_ENCODINGS.values() for storage in FRAME_STORAGES.values()]
CODECS = [codec for codec in CODECS if not codec.misfit]
# Where the random ones are among the frames.
RANDOM = 0, 2**13
LEAST = FRAME_STORAGES["rgb10a2"].numbers(0)[512]


def planes(kind, array: np.ndarray):
    return kind(*(jnp.asarray(np.ascontiguousarray(c)) for c in array.T))


def rows(planes) -> np.ndarray:
    return np.stack([np.asarray(c) for c in planes], axis=1)


def as_frame(given: np.ndarray) -> Frame:
    """Rows of normal, hand and tangent as a frame for an encoder."""
    return frame_of(planes(Vec3, given[:, :3]), planes(Vec3, given[:, 4:7]), jnp.asarray(given[:, 3].copy()))


def as_rows(frame: Frame) -> np.ndarray:
    """Normal, hand, tangent and nothing; (count, 8), as GLSL has them."""
    none = np.zeros((len(np.asarray(frame.hand)), 1), np.float32)
    return np.concatenate([rows(frame.normal), np.asarray(frame.hand)[:, None], rows(frame.tangent), none], axis=1)


def of_quaternions(q: np.ndarray) -> np.ndarray:
    """Frames of quaternions of any length, each with either hand; float32 of shape (2 count, 8)."""
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    frame = frame_of_quaternion(Vec4(*q.T), np.ones(len(q)))
    one = as_rows(frame).astype(np.float32)
    other = one * np.float32([1, 1, 1, -1, 1, 1, 1, 1])
    return np.concatenate([one, other])


def seam_normals() -> np.ndarray:
    """Poles, axes and diagonals, the octahedron's fold and edges, and both sides of the fixed tangents' seam."""
    turn = np.linspace(0, 2 * np.pi, 17)[:-1]
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    heights = [0.0, -0.0, 1e-7, -1e-7, 1e-3, -1e-3, *around(np.float32([SEAM]), 2), -0.9999, 0.9999]
    rings = [np.concatenate([ring * (1 - abs(z)), np.full((16, 1), z)], axis=1) for z in heights]
    corners = np.array([c for c in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(c)])
    n = np.concatenate([corners, *rings])
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def about_normals(n: np.ndarray) -> np.ndarray:
    """Frames around normals, tangents at every 45 degrees and a little beside, so that some are at the angle's wrap."""
    s = np.where(n[:, 2] < SEAM / 2, -1.0, 1.0)
    found = []
    for angle in np.radians([(45 * k + off) for k in range(8) for off in (0, 1e-6, -1e-6)]):
        a = s * n[:, 0] / (s + n[:, 2])
        fixed = np.stack([1 - n[:, 0] * a, -n[:, 1] * a, -s * n[:, 0]], axis=1)
        t = np.cos(angle) * fixed + np.sin(angle) * np.cross(n, fixed)
        found.append(np.concatenate([n, np.ones((len(n), 1)), t, np.zeros((len(n), 1))], axis=1))
    one = np.concatenate(found).astype(np.float32)
    return np.concatenate([one, one * np.float32([1, 1, 1, -1, 1, 1, 1, 1])])


@cache
def hard_frames() -> np.ndarray:
    """Frames with normals in every corner; half turns, equal components, components at and beside 0; random ones."""
    rng = np.random.default_rng(0)
    signs = np.array([q for q in itertools.product((-1.0, 0.0, 1.0), repeat=4) if any(q)])
    half_turns = np.concatenate([rng.normal(size=(256, 3)), np.zeros((256, 1))], axis=1)
    nearly = signs[rng.integers(0, len(signs), 1024)] + rng.normal(size=(1024, 4)) * 10 ** rng.uniform(
        -8, -1, (1024, 1)
    )
    made = [of_quaternions(q) for q in (rng.normal(size=(RANDOM[1] // 2, 4)), signs, half_turns, nearly)]
    return np.concatenate([*made, about_normals(seam_normals())])


def padded(given: np.ndarray, width: int = 256) -> np.ndarray:
    missing = -len(given) % width
    return np.concatenate([given, np.repeat(given[-1:], missing, axis=0)])


@cache
def expected(name: str):
    """Frames and normals without tangents, their codes by JAX, codes to decode, and what JAX makes of those."""
    encoding = FRAME_ENCODINGS[name]
    frames = np.concatenate([hard_frames(), hard_frames()[:64] * np.float32([1, 1, 1, 1, 0, 0, 0, 0])])
    codes = rows(jax.jit(lambda f: encoding.encode(f, LEAST))(as_frame(frames)))
    # What storages hand back, all over the frames.
    given = codes.copy()
    fitting = [codec for codec in CODECS if codec.encoding is encoding]
    for start, codec in enumerate(fitting):
        given[start :: len(fitting)] = rows(codec.store(planes(Vec4, given[start :: len(fitting)])))
    return frames, codes, given, decoded(name, given)


@cache
def decoder(name: str):
    return jax.jit(lambda e: FRAME_ENCODINGS[name].decode(e, LEAST))


def decoded(name: str, codes: np.ndarray) -> np.ndarray:
    return as_rows(decoder(name)(planes(Vec4, codes)))


def in_ulps(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The largest difference of each row, in 2^-23; what is not a number is as far as can be."""
    apart = np.abs(one.astype(np.float64) - other).max(axis=1) / ULP
    return np.where(np.isfinite(other).all(axis=1), apart, np.inf)


def distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.linalg.norm(one.astype(np.float64) - other, axis=1)


def disagreement(gl, name: str) -> list[tuple[float, str]]:
    """The worst difference of encode and decode, with its story.

    Codes agree if they are near, or stand for frames that are as near to the given one: of two equal components either
    may be the largest, and a w of 0 may be kept on either side of 0.
    """
    frames, codes, given, by_jax = expected(name)
    gl_codes, normals, tangents = exact_frames(gl, FRAME_ENCODINGS[name], LEAST, frames[:, :4], frames[:, 4:], given)
    by_gl = np.concatenate([normals, tangents], axis=1)
    far, gl_far = (distance(frames, decoded(name, found)) for found in (codes, gl_codes))
    encode = np.minimum(in_ulps(codes, gl_codes), abs(far - gl_far) / ULP)
    encode = np.where(np.isfinite(gl_codes).all(axis=1), encode, np.inf)
    decode = in_ulps(by_jax, by_gl)
    i, j = int(np.argmax(encode)), int(np.argmax(decode))
    return [
        (
            float(encode[i]),
            f"{name}_encode {frames[i]!r}: JAX {codes[i]!r}, GLSL {gl_codes[i]!r}, {encode[i]:.1f} ulps",
        ),
        (float(decode[j]), f"{name}_decode {given[j]!r}: JAX {by_jax[j]!r}, GLSL {by_gl[j]!r}, {decode[j]:.1f} ulps"),
    ]


@pytest.mark.parametrize("name", EVERY)
def test_before_storage_the_languages_differ_by_no_more_ulps_than_the_encoding_states(gl, name):
    for (ulps, story), allowed in zip(disagreement(gl, name), FRAME_ENCODINGS[name].ulps, strict=True):
        assert ulps <= allowed, f"{story}; allowed {allowed}: {FRAME_ENCODINGS[name].ulps_reason}"


def mutants() -> list:
    """(encoding whose harness must notice, file, its text with two arguments exchanged)."""
    files = [(name, FRAME_ENCODINGS[name].glsl) for name in EVERY]
    files.append(("smallest_three", FRAME_ENCODINGS["smallest_three"].glsl.parents[1] / "rotation.glsl"))
    return [
        pytest.param(name, file, changed, id=f"{name}: {what}")
        for name, file in files
        for what, changed in swapped_calls(file.read_text())
    ]


@pytest.mark.parametrize("name, file, text", mutants())
def test_swapping_two_arguments_is_noticed(gl, monkeypatch, name, file, text):
    original = shader.read_shader
    monkeypatch.setattr(shader, "read_shader", lambda path: text if path == file else original(path))
    try:
        found = disagreement(gl, name)
    except ShaderError:
        return  # the types disagree: nobody can ship that
    allowed = FRAME_ENCODINGS[name].ulps
    assert any(ulps > most for (ulps, _), most in zip(found, allowed, strict=True)), [story for _, story in found]


@pytest.mark.parametrize("name", EVERY)
def test_a_frame_encoding_is_complete(name):
    encoding = FRAME_ENCODINGS[name]
    assert encoding.hand_in in range(4) and len(encoding.levels) == 4
    assert not encoding.settle or inspect.getdoc(encoding.settle), "special cases are said"


def angles_between(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The angle of the rotation between frames, whatever their hands, in degrees."""
    axes = []
    for frames in (one.astype(np.float64), other.astype(np.float64)):
        n, t = frames[:, :3], frames[:, 4:7]
        axes.append(np.stack([t, np.cross(n, t), n], axis=1))
    squared = ((axes[0] - axes[1]) ** 2).sum(axis=(1, 2))
    return np.degrees(2 * np.arcsin(np.minimum(np.sqrt(squared / 8), 1)))


@cache
def trip(codec: FrameCodec) -> np.ndarray:
    return as_rows(jax.jit(codec.round_trip)(as_frame(padded(hard_frames()))))


@cache
def gl_trip(gl, codec: FrameCodec) -> np.ndarray:
    frames = padded(hard_frames())
    with FramePasses(gl, codec) as passes:
        found = passes.round_trip(*(part.reshape(-1, 256, 4) for part in (frames[:, :4], frames[:, 4:])))
    return np.concatenate([part.reshape(-1, 4) for part in found], axis=1)


# What a frame of a code is off at most, in steps of its widest number. At four equal components the sum of their
# absolutes is 2, and half a step of three numbers moves the fourth by three halves: 2 x 2 x sqrt(3/4 + 9/4) = sqrt(48).
STEPS = {"hexadecachoral": np.sqrt(48)}


def most(codec: FrameCodec) -> float:
    """What a frame can be off at most, in degrees, to first order.

    In steps of the widest number: sqrt(11) of smallest three, whose third number has steps twice as wide, where all
    four are equal; 2.7 of the others. And what float32 adds.
    """
    step = max(2.0 / (codec.storage.levels(i) - 1) for i, levels in enumerate(codec.encoding.levels) if not levels)
    return np.degrees(STEPS.get(codec.encoding.name, np.sqrt(11)) * step) + 1e-4


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c.name)
def test_no_frame_is_far_off_and_no_hand_is_lost(gl, codec):
    frames = padded(hard_frames())
    for language, found in (("JAX", trip(codec)), ("GLSL", gl_trip(gl, codec))):
        assert np.isfinite(found).all(), language
        angles, lost = angles_between(frames, found), found[:, 3] != frames[:, 3]
        i = int(np.argmax(angles))
        assert angles[i] <= most(codec), f"{language}: {frames[i]!r} is {found[i]!r}, {angles[i]:.4g} degrees off"
        assert not lost.any(), f"{language}: {frames[lost][0]!r} is {found[lost][0]!r}"


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c.name)
def test_a_target_stores_frames_as_the_emulation_says(gl, codec):
    """Of random frames, but for few where float32 falls on either side of a tie."""
    chosen = slice(*RANDOM)
    apart = in_ulps(trip(codec)[chosen], gl_trip(gl, codec)[chosen])
    other = np.mean(apart > sum(codec.encoding.ulps))
    assert other <= 0.005, f"{other:.4%} of the frames come back as others"


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c.name)
def test_what_was_stored_is_stored_again_as_it_is(codec):
    """A code stands for a frame whose code it is: always where the angle is of the stored normal. Few of a quaternion's
    do not: of two components that are nearly equal the other becomes the largest, and four come back at length 1, which
    is off their steps."""
    first = trip(codec)
    second = as_rows(jax.jit(codec.round_trip)(as_frame(first)))
    moved = angles_between(first, second) > 1e-4
    settled = codec.encoding.settle is not None
    share = np.mean(moved if settled else moved[slice(*RANDOM)])
    assert share <= (0 if settled else 0.02), f"{share:.4%} of the frames have moved"


def test_no_input_makes_what_is_no_number(gl):
    """NaN, infinities, zeros and vectors that are not at right angles, in both languages."""
    numbers = np.float32([np.nan, np.inf, -np.inf, 0, -0.0, 1e-30, 3e38, 1])
    given = np.stack(np.meshgrid(*[numbers] * 4), axis=-1).reshape(-1, 4)
    given = np.concatenate([given, given[:, ::-1]], axis=1)
    for name in EVERY:
        encoding = FRAME_ENCODINGS[name]
        codes = rows(jax.jit(lambda f, encoding=encoding: encoding.encode(f, LEAST))(as_frame(given)))
        gl_codes, *_ = exact_frames(gl, encoding, LEAST, given[:, :4], given[:, 4:], codes)
        for language, found in (("JAX", codes), ("GLSL", gl_codes)):
            bad = ~np.isfinite(found).all(axis=1)
            assert not bad.any(), f"{name} by {language}: {given[bad][0]!r} gives {found[bad][0]!r}"


def test_half_turns_and_the_identity_have_their_quaternions():
    """The identity is w; a half turn about an axis is that axis."""
    x, _, z = np.eye(3)
    frames = np.float32([[*n, 1, *t, 0] for n, t in ((z, x), (-z, x), (-z, -x), (z, -x))])
    quaternions = rows(quaternion_of(as_frame(frames)))
    expected = np.float32([[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])
    assert quaternions == pytest.approx(expected, abs=1e-7)


def test_the_angles_ends_are_one_angle():
    """A tangent opposite to the fixed one is at -1 or 1, whichever: both come back as it."""
    encoding = FRAME_ENCODINGS["octahedral_angle"]
    ends = np.float32([[0.3, -0.2, angle, 1] for angle in (-1, 1)])
    one, other = decoded(encoding.name, ends)
    assert one == pytest.approx(other, abs=2 * ULP)


def test_a_hand_at_an_end_of_its_range_is_kept():
    """Where the third of three is at its lower end, and where w is 0: the number is a step, and not 0."""
    third = of_quaternions(np.array([[1.0, 0.0, 0.0, 1e-6 - 1.0]]))
    half_turn = of_quaternions(np.array([[0.6, 0.0, 0.8, 0.0]]))
    for name, frames, number in (("smallest_three", third, 2), ("qtangent", half_turn, 3)):
        codes = rows(FRAME_ENCODINGS[name].encode(as_frame(frames), LEAST))
        assert codes[:, number] == pytest.approx([LEAST, -LEAST], rel=2e-3), name
