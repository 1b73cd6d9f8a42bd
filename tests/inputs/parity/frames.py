"""Encodings of tangent frames: hard normals, half turns, equal components, and tangents where the angle wraps."""

import itertools
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
from neighbours import around

from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.codecs.frame_encoding import FrameEncoding
from normalbench.encodings.frame.octahedral_angle import SEAM
from normalbench.encodings.rotation import Frame, frame_of, rotated_frame
from normalbench.encodings.storages.storage import FRAME_STORAGES
from normalbench.encodings.vec import Vec3, Vec4
from normalbench.gbuffer.codecs.frames.frame_passes import FramePasses, exact_frames

from .comparison import ULP, Comparison, Parity, in_ulps, is_finite, planes, rows

CODECS = [FrameCodec(encoding, storage) for encoding in FRAME_ENCODINGS.values() for storage in FRAME_STORAGES.values()]
CODECS = [codec for codec in CODECS if not codec.misfit]
# Where the random ones are among the frames.
RANDOM = 0, 2**13
LEAST = FRAME_STORAGES["rgb10a2"].numbers(0)[512]


def as_frame(given: np.ndarray) -> Frame:
    """Return rows of normal, hand and tangent as a frame for an encoder."""
    return frame_of(planes(Vec3, given[:, :3]), planes(Vec3, given[:, 4:7]), jnp.asarray(given[:, 3].copy()))


def as_rows(frame: Frame) -> np.ndarray:
    """Return normal, hand, tangent and a zero; (count, 8), as in GLSL."""
    none = np.zeros((len(np.asarray(frame.hand)), 1), np.float32)
    return np.concatenate([rows(frame.normal), np.asarray(frame.hand)[:, None], rows(frame.tangent), none], axis=1)


def of_quaternions(q: np.ndarray) -> np.ndarray:
    """Return frames of quaternions of any length, each with both signs of the hand; float32 (2 count, 8)."""
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    frame = rotated_frame(Vec4(*q.T), np.ones(len(q)))
    right = as_rows(frame).astype(np.float32)
    other = right * np.float32([1, 1, 1, -1, 1, 1, 1, 1])
    return np.concatenate([right, other])


def seam_normals() -> np.ndarray:
    """Return poles, axes, diagonals, the octahedron's fold and edges, and both sides of the fixed tangents' seam."""
    turn = np.linspace(0, 2 * np.pi, 17)[:-1]
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    heights = [0.0, -0.0, 1e-7, -1e-7, 1e-3, -1e-3, *around(np.float32([SEAM]), 2), -0.9999, 0.9999]
    rings = [np.concatenate([ring * (1 - abs(z)), np.full((16, 1), z)], axis=1) for z in heights]
    corners = np.array([c for c in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(c)])
    n = np.concatenate([corners, *rings])
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def about_normals(n: np.ndarray) -> np.ndarray:
    """Return frames around normals, with tangents at and next to every 45°: some are where the angle wraps."""
    s = np.where(n[:, 2] < SEAM / 2, -1.0, 1.0)
    frames = []
    for angle in np.radians([(45 * k + off) for k in range(8) for off in (0, 1e-6, -1e-6)]):
        a = s * n[:, 0] / (s + n[:, 2])
        fixed = np.stack([1 - n[:, 0] * a, -n[:, 1] * a, -s * n[:, 0]], axis=1)
        t = np.cos(angle) * fixed + np.sin(angle) * np.cross(n, fixed)
        frames.append(np.concatenate([n, np.ones((len(n), 1)), t, np.zeros((len(n), 1))], axis=1))
    right = np.concatenate(frames).astype(np.float32)
    return np.concatenate([right, right * np.float32([1, 1, 1, -1, 1, 1, 1, 1])])


@cache
def hard_frames() -> np.ndarray:
    """Return frames with normals in every corner, half turns, equal components, components at and near 0, and random
    frames."""
    rng = np.random.default_rng(0)
    signs = np.array([q for q in itertools.product((-1.0, 0.0, 1.0), repeat=4) if any(q)])
    half_turns = np.concatenate([rng.normal(size=(256, 3)), np.zeros((256, 1))], axis=1)
    nearly = signs[rng.integers(0, len(signs), 1024)] + rng.normal(size=(1024, 4)) * 10 ** rng.uniform(
        -8, -1, (1024, 1)
    )
    frames = [of_quaternions(q) for q in (rng.normal(size=(RANDOM[1] // 2, 4)), signs, half_turns, nearly)]
    return np.concatenate([*frames, about_normals(seam_normals())])


def padded(given: np.ndarray, width: int = 256) -> np.ndarray:
    missing = -len(given) % width
    return np.concatenate([given, np.repeat(given[-1:], missing, axis=0)])


@cache
def encoder(encoding: FrameEncoding):
    return jax.jit(lambda frame: encoding.encode(frame, LEAST))


@cache
def decoder(encoding: FrameEncoding):
    return jax.jit(lambda e: encoding.decode(e, LEAST))


def encoded(encoding: FrameEncoding, frames: np.ndarray) -> np.ndarray:
    return rows(encoder(encoding)(as_frame(frames)))


def decoded(encoding: FrameEncoding, codes: np.ndarray) -> np.ndarray:
    return as_rows(decoder(encoding)(planes(Vec4, codes)))


@cache
def expected(encoding: FrameEncoding):
    """Return frames, normals without tangents, their JAX codes, codes to decode, and the frames decoded by JAX."""
    corners = np.array(list(itertools.product((-1.0, 0.0, 0.5, 1.0), repeat=4)), np.float32)
    bare = hard_frames()[:64] * np.float32([1, 1, 1, 1, 0, 0, 0, 0])
    frames = np.concatenate([hard_frames(), bare, hard_frames()[: len(corners)]])
    codes = encoded(encoding, frames)
    # What storages hand back, all over the frames, and corners, edges and centre of the code space.
    given = codes.copy()
    fitting = [codec for codec in CODECS if codec.encoding is encoding]
    for start, codec in enumerate(fitting):
        given[start :: len(fitting)] = rows(codec.store(planes(Vec4, given[start :: len(fitting)])))
    given[-len(corners) :] = corners
    return frames, codes, given, decoded(encoding, given)


def by_gl(gl, encoding: FrameEncoding, frames: np.ndarray, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return GLSL's codes of frames, and its frames of codes."""
    codes, *parts = exact_frames(gl, encoding, LEAST, frames[:, :4], frames[:, 4:], given)
    return codes, np.concatenate(parts, axis=1)


def compared(gl, encoding: FrameEncoding) -> list[Comparison]:
    """Compare codes, which agree if they are close or decode to frames equally close to the given frame: either of
    two equal components may be the largest, and a w of 0 may be kept on either side of 0."""
    frames, codes, given, back = expected(encoding)
    gl_codes, gl_made = by_gl(gl, encoding, frames, given)
    far = [np.linalg.norm(frames.astype(np.float64) - decoded(encoding, code), axis=1) for code in (codes, gl_codes)]
    apart = np.minimum(in_ulps(codes, gl_codes), abs(far[0] - far[1]) / ULP)
    apart = np.where(np.isfinite(gl_codes).all(axis=1), apart, np.inf)
    name, ulps, reason = encoding.name, encoding.ulps, encoding.ulps_reason
    return [
        Comparison(f"{name}_encode", frames, codes, gl_codes, apart, ulps[0], reason),
        Comparison(f"{name}_decode", given, back, gl_made, in_ulps(back, gl_made), ulps[1], reason),
    ]


def guarded(gl, encoding: FrameEncoding) -> list[Comparison]:
    """Compare NaN, infinities, zeros and vectors that are not at right angles."""
    numbers = np.float32([np.nan, np.inf, -np.inf, 0, -0.0, 1e-30, 3e38, 1])
    given = np.stack(np.meshgrid(*[numbers] * 4), axis=-1).reshape(-1, 4)
    given = np.concatenate([given, given[:, ::-1]], axis=1)
    codes = encoded(encoding, given)
    return [is_finite(f"{encoding.name}_encode", given, codes, by_gl(gl, encoding, given, codes)[0])]


@cache
def round_trip(codec: FrameCodec):
    """Return a function from rows to rows; it is compiled once, because all callers pass the same number of rows."""
    through = jax.jit(codec.round_trip)
    return lambda frames: as_rows(through(as_frame(frames)))


@cache
def trip(codec: FrameCodec) -> np.ndarray:
    """Return the hard frames after a codec's round trip by JAX."""
    return round_trip(codec)(padded(hard_frames()))


@cache
def gl_trip(gl, codec: FrameCodec) -> np.ndarray:
    """Return the hard frames after a codec's round trip by GLSL."""
    frames = padded(hard_frames())
    with FramePasses(gl, codec) as passes:
        parts = passes.round_trip(*(part.reshape(-1, 256, 4) for part in (frames[:, :4], frames[:, 4:])))
    return np.concatenate([part.reshape(-1, 4) for part in parts], axis=1)


def stored(gl, codec: FrameCodec, _: bool) -> list[Comparison]:
    """Compare random frames: 99.5% give the same result as JAX, within the units that encoder and decoder state."""
    chosen = slice(*RANDOM)
    frames, by_jax, by_glsl = (rows[chosen] for rows in (hard_frames(), trip(codec), gl_trip(gl, codec)))
    apart = in_ulps(by_jax, by_glsl)
    same = apart <= sum(codec.encoding.ulps)
    return [Comparison(codec.name, frames, by_jax, by_glsl, apart, np.inf, same=same, share=0.995)]


PARITY = Parity(
    compared,
    guarded=guarded,
    codecs=[*{codec.encoding.name: codec for codec in CODECS}.values()],
    more_codecs=CODECS,
    stored=stored,
    shared={"smallest_three": ["rotation.glsl"]},
)
