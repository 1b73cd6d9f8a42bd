"""Motion codes: the languages agree, targets store as emulated, and no motion has an exact code where it should."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from mutants import swapped_calls

from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.motion.log import OCTAVES, K
from normalbench.encodings.storages.storage import FORMATS, MOTION_STORAGES, STORAGES, Storage
from normalbench.encodings.vec import Vec2
from normalbench.gbuffer.codecs.motion_passes import MotionPasses, exact_motions
from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError

ULP = 2.0**-23
EVERY = sorted(MOTION_ENCODINGS)
# Neither 1 nor a power of two, so that a range that is forgotten or exchanged is seen.
RANGE = 0.3
CODECS = [MotionCodec(e, s) for e in MOTION_ENCODINGS.values() for s in MOTION_STORAGES.values()]


def planes(array: np.ndarray) -> Vec2:
    return Vec2(*(jnp.asarray(np.ascontiguousarray(c)) for c in array.T))


def rows(vector) -> np.ndarray:
    return np.stack([np.asarray(c) for c in vector], axis=1)


@cache
def motions() -> np.ndarray:
    """Motions up to the range: both zeros, its ends, every magnitude down to 2^-40 of it, and random ones."""
    rng = np.random.default_rng(0)
    powers = RANGE * 2.0 ** -np.arange(0, 41)
    line = np.concatenate([[0.0, -0.0], powers, -powers])
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    free = rng.uniform(-RANGE, RANGE, (8192, 2))
    slow = rng.normal(size=(8192, 2)) * RANGE * 10.0 ** rng.uniform(-7, -1, (8192, 1))
    return np.clip(np.concatenate([grid, free, slow]), -RANGE, RANGE).astype(np.float32)


@cache
def expected(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Codes of the motions by JAX; codes to decode, and what JAX makes of them."""
    encoding, largest = MOTION_ENCODINGS[name], np.float32(RANGE)
    codes = rows(jax.jit(encoding.encode)(planes(motions()), largest))
    given = np.random.default_rng(1).permutation(codes.ravel()).reshape(-1, 2)
    return codes, given, rows(jax.jit(encoding.decode)(planes(given), largest))


def disagreement(gl, name: str) -> list[tuple[float, str]]:
    """The worst difference of encode in 2^-23, and of decode in 2^-23 of the range, with its story."""
    codes, given, decoded = expected(name)
    found = exact_motions(gl, MOTION_ENCODINGS[name], RANGE, np.concatenate([motions(), given], axis=1))
    stories = []
    for side, asked, by_jax, by_gl, unit in (
        ("encode", motions(), codes, found[:, :2], ULP),
        ("decode", given, decoded, found[:, 2:], ULP * RANGE),
    ):
        apart = np.abs(by_jax.astype(np.float64) - by_gl).max(axis=1) / unit
        apart = np.where(np.isfinite(by_gl).all(axis=1), apart, np.inf)
        i = int(np.argmax(apart))
        story = f"{name}_{side} {asked[i]!r}: JAX {by_jax[i]!r}, GLSL {by_gl[i]!r}, {apart[i]:.2f} ulps"
        stories.append((float(apart[i]), story))
    return stories


@pytest.mark.parametrize("name", EVERY)
def test_before_storage_the_languages_differ_by_no_more_ulps_than_the_encoding_states(gl, name):
    for (ulps, story), allowed in zip(disagreement(gl, name), MOTION_ENCODINGS[name].ulps, strict=True):
        assert ulps <= allowed, f"{story}; allowed {allowed}: {MOTION_ENCODINGS[name].ulps_reason}"


# A number times a vector is the vector times the number: nothing else changes.
SAME = {"linear_decode_motion(vec2 range, float e)"}
SWAPS = [(name, what, text) for name in EVERY for what, text in swapped_calls(MOTION_ENCODINGS[name].glsl.read_text())]
SWAPS = [(name, what, text) for name, what, text in SWAPS if what not in SAME]


@pytest.mark.parametrize("name, what, text", SWAPS, ids=[f"{name}: {what}" for name, what, _ in SWAPS])
def test_swapping_two_arguments_is_noticed(gl, monkeypatch, name, what, text):
    original, file = shader.read_shader, MOTION_ENCODINGS[name].glsl
    monkeypatch.setattr(shader, "read_shader", lambda path: text if path == file else original(path))
    try:
        found = disagreement(gl, name)
    except ShaderError:
        return  # the types disagree: nobody can ship that
    allowed = MOTION_ENCODINGS[name].ulps
    assert any(ulps > most for (ulps, _), most in zip(found, allowed, strict=True)), [what, found]


@pytest.mark.parametrize("name", EVERY)
def test_an_encoding_is_odd_and_rises_from_0_to_1_at_the_range(name):
    """No motion is 0, the range is 1, and what goes the other way has the other sign."""
    encoding, largest = MOTION_ENCODINGS[name], np.float32(RANGE)
    codes = rows(encoding.encode(planes(np.float32([[0, -0.0], [RANGE, -RANGE]])), largest))
    assert codes == pytest.approx(np.float32([[0, 0], [1, -1]]), abs=4 * ULP)
    line = np.linspace(0, RANGE, 4097, dtype=np.float32)
    one, other = rows(encoding.encode(planes(np.stack([line, -line], axis=1)), largest)).T
    assert np.array_equal(one, -other) and (np.diff(one) > 0).all()


def test_the_constant_of_the_logarithm_is_a_pixel_of_2047():
    """1 + k is 2^11: the two kinds of step meet at 1 / 2047 of the range."""
    assert K == 2047 and 2**OCTAVES == K + 1


def through_jax(codec: MotionCodec, given: np.ndarray) -> np.ndarray:
    return rows(jax.jit(codec.round_trip)(planes(given), np.float32(RANGE)))


def through_gl(gl, codec: MotionCodec, given: np.ndarray) -> np.ndarray:
    with MotionPasses(gl, codec) as passes:
        return passes.round_trip(given.reshape(-1, 256, 2), RANGE).reshape(-1, 2)


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c.name)
def test_a_target_stores_motions_as_the_emulation_says(gl, codec):
    """But for few where float32 falls on either side of a tie; none of those is a step apart or more."""
    given = motions()[-16384:]
    by_jax, by_gl = through_jax(codec, given), through_gl(gl, codec, given)
    apart = np.abs(by_jax.astype(np.float64) - by_gl).max(axis=1)
    other = apart > ULP * RANGE * codec.encoding.ulps[1] * 2
    assert np.mean(other) <= 0.005, f"{np.mean(other):.4%} of the motions come back as others"
    errors = [np.abs(found.astype(np.float64) - given).max(axis=0) for found in (by_jax, by_gl)]
    assert errors[0] == pytest.approx(errors[1], rel=0.01, abs=4 * ULP), codec.name


@pytest.mark.parametrize("codec", CODECS, ids=lambda c: c.name)
def test_no_motion_is_exact_but_in_unorm_that_is_not_centred(gl, codec):
    """UNORM has no code for 0: its two middle codes are half a step from it."""
    still = np.zeros((256, 2), np.float32)
    for found in (through_jax(codec, still), through_gl(gl, codec, still)):
        assert np.isfinite(found).all() and (found == found[0]).all()
        assert (found[0] != 0).all() == codec.storage.is_biased, found[0]


@pytest.mark.parametrize("storage", [s for s in MOTION_STORAGES.values() if s.is_centred], ids=lambda s: s.name)
def test_centred_is_snorms_integers_in_the_unorm_target(storage: Storage):
    """The bias is 127 / 255, 511 / 1023 or 32767 / 65535, as engines write it; the top code is not used."""
    steps = 2 ** storage.bits[0] - 1
    assert storage.target.kind == "unorm" and storage.target.scale(0) == steps
    assert 2 * storage.scale(0) + 1 == steps and storage.count(0) == steps


@pytest.mark.parametrize("name", EVERY)
def test_what_is_beyond_the_range_is_clipped_by_fixed_point_and_kept_by_floats(gl, name):
    """Twice the range comes back as the range, and in half floats as itself."""
    beyond = np.tile(np.float32([[2 * RANGE, -2 * RANGE]]), (256, 1))
    for storage in MOTION_STORAGES.values():
        codec = MotionCodec(MOTION_ENCODINGS[name], storage)
        end = RANGE if codec.clips else 2 * RANGE
        for found in (through_jax(codec, beyond)[0], through_gl(gl, codec, beyond)[0]):
            assert found == pytest.approx([end, -end], rel=0.005), codec.name


def test_linear_in_32_bit_floats_is_exact_and_needs_no_range(gl):
    codec, given = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rgba32f"]), motions()[-16384:]
    assert not codec.needs_range and not codec.clips
    assert np.array_equal(through_jax(codec, given), given) and np.array_equal(through_gl(gl, codec, given), given)


@pytest.mark.parametrize(
    "storage, why",
    [(FORMATS["r16f"], "R16F has 1 channels"), (STORAGES["rgb8_8_8_1"], None)],
    ids=lambda s: str(s)[:12],
)
def test_a_storage_needs_two_channels(storage: Storage, why: str | None):
    found = MotionCodec(MOTION_ENCODINGS["linear"], storage).misfit
    assert (why in found) if why else found is None, found
