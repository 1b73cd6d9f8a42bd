"""Depth encodings: projections, preserved signs and errors within their bounds."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from neighbours import around
from parity.comparison import ULP
from parity.depth import CAMERAS, CODECS, exact_and_units, numbers_by_gl, numbers_by_jax, same_bits

from normalbench.encodings.catalogue import DEPTH_ENCODINGS
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.shared.position import Camera
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES, store_depth
from normalbench.gbuffer.codecs.depth import depth_passes

SIGNED = [name for name in sorted(DEPTH_ENCODINGS) if DEPTH_ENCODINGS[name].signed]


WINDOWS = [name for name in sorted(DEPTH_ENCODINGS) if DEPTH_ENCODINGS[name].projection]


STRANGE = np.float32([np.nan, np.inf, -np.inf, 3e38, -3e38, 1e-45, -1e-45, 1e-40, 0.0, -0.0, -1.0])


@pytest.mark.parametrize("name", WINDOWS)
def test_the_inverse_projection_matches_the_encoding(name):
    """The inverse projection of an exact number is at the depth that the number encodes, on the view ray."""
    encoding, camera = DEPTH_ENCODINGS[name], CAMERAS[0]
    depths, place = np.geomspace(camera.near, camera.far, 50), np.array([0.5, -0.25])
    numbers, _ = exact_and_units(encoding.encode, depths, camera)
    scale, offset = encoding.projection.clip
    near_far = np.float32([camera.near, camera.far]).astype(np.float64)
    exact = Camera(*near_far.tolist(), camera.fov, camera.aspect)
    clip = np.stack([*np.broadcast_to(place[:, None], (2, 50)), scale * numbers + offset, np.ones(50)])
    x, y, z, w = exact.clip_to_view(encoding.projection) @ clip
    assert -z / w == pytest.approx(depths, rel=1e-6)
    assert np.stack([x / w, y / w], axis=1) == pytest.approx(depths[:, None] * place * camera.rays, rel=1e-6)


@pytest.mark.parametrize("name", [n for n, s in DEPTH_STORAGES.items() if s.home == "attachment"])
def test_a_depth_buffer_clamps_as_the_emulation_does(gl, name):
    storage = DEPTH_STORAGES[name]
    # Of 1/2, which lies between two codes, devices take either.
    numbers = np.float32([1.5, -1, 3e38, np.inf, -np.inf, 0, 1, 0.25])
    got = depth_passes.through(gl, storage, numbers)
    comparison = same_bits(name, numbers, np.asarray(store_depth(jnp.asarray(numbers), storage)), got)
    assert comparison.agrees, comparison


@pytest.mark.parametrize("far", [1.0, 1000.0])
@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_16_bits_in_two_bytes_are_accurate_to_half_a_code(gl, backend, far):
    """Linear depth is stored at every code and every tie between codes, with neighbours. The stored code is within
    half a code of the exact code, whether or not the low byte carries, except for float32 rounding (of d / far, of
    its product with 65535 and of the decoded share: two units in the last place)."""
    codec, camera = DepthCodec(DEPTH_ENCODINGS["linear"], DEPTH_STORAGES["packed16"]), Camera(0.1, far, 60.0, 1.0)
    codes = np.arange(2.0**16)
    depths = around(np.concatenate([codes, codes[:-1] + 0.5]) / 65535 * far, 1)
    depths = np.sort(np.clip(depths, 0, np.float32(far)))
    numbers = numbers_by_jax(codec, camera, depths) if backend == "jax" else numbers_by_gl(gl, codec, camera, depths)
    stored, exact = numbers.astype(np.float64) * 65535, depths.astype(np.float64) / far * 65535
    off = abs(stored - exact) - exact * 2 * ULP
    i = int(np.argmax(off))
    assert off[i] <= 0.5, f"{depths[i]!r}: code {exact[i]:.5f} is stored as {stored[i]:.5f}"
    assert np.array_equal(np.unique(np.rint(stored)), codes), "some code is never stored"
    assert np.all(np.diff(stored) >= 0), "a farther depth is stored as a nearer one"


@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.parametrize("storage", [name for name, s in DEPTH_STORAGES.items() if s.is_signed])
@pytest.mark.parametrize("name", SIGNED)
def test_the_sign_of_z_survives_at_the_smallest_depths(gl, name, storage, backend):
    """The lowest and highest codes of either sign, including -0 and +0, keep their signs and magnitudes."""
    codec, camera = DepthCodec(DEPTH_ENCODINGS[name], DEPTH_STORAGES[storage]), CAMERAS[0]
    scale = codec.storage.scale // 2 or 2**10
    steps = np.float32([0, 1, 2, scale // 2, scale]) / np.float32(scale) * np.float32(camera.far)
    depths = np.concatenate([steps, -steps])
    numbers = numbers_by_jax(codec, camera, depths) if backend == "jax" else numbers_by_gl(gl, codec, camera, depths)
    assert np.array_equal(np.signbit(numbers), np.signbit(depths)), f"{depths!r} are stored as {numbers!r}"
    whole = numbers / (camera.far if codec.storage.is_open else 1) * scale
    assert np.array_equal(np.rint(abs(whole)), np.tile([0, 1, 2, scale // 2, scale], 2)), f"codes {whole!r}"


@pytest.mark.parametrize("codec", CODECS, ids=lambda codec: codec.name)
def test_nan_infinity_and_depths_beyond_far_are_stored_as_finite_numbers(gl, codec):
    """NaN, infinity and depths beyond far are stored like far, with their sign if the encoding has a sign; otherwise
    a negative depth is stored like 0. This holds for both languages, and every texel is finite."""
    camera = CAMERAS[0]
    beyond = ~(abs(STRANGE) <= camera.far)
    magnitudes = np.where(beyond, np.float32(camera.far), abs(STRANGE))
    same = np.copysign(magnitudes, STRANGE) if codec.encoding.signed else np.where(STRANGE < 0, 0, magnitudes)
    expected = numbers_by_jax(codec, camera, same.astype(np.float32))
    for what, numbers in (
        ("JAX", numbers_by_jax(codec, camera, STRANGE)),
        ("GLSL", numbers_by_gl(gl, codec, camera, STRANGE)),
    ):
        assert np.isfinite(numbers).all(), f"{what}: {STRANGE!r} are stored as {numbers!r}"
        # A unit in the last place for a far plane that a language multiplies by its reciprocal; denormals may be 0.
        off = abs(abs(numbers) - abs(expected)) <= abs(expected) * 2 * ULP + 2.0**-126
        assert off.all(), f"{what}: {STRANGE[~off]!r} are stored as {numbers[~off]!r}, not {expected[~off]!r}"
        if codec.encoding.signed:
            assert np.array_equal(np.signbit(numbers), np.signbit(STRANGE)), f"{what}: {STRANGE!r} as {numbers!r}"


def in_float64(function, values: np.ndarray, camera: Camera) -> np.ndarray:
    with jax.enable_x64(True):
        return np.asarray(function(jnp.asarray(values, jnp.float64), camera.near, camera.far))


DISTANCES = (1.0, 10.0, 100.0, 900.0)


def test_reversed_depth_in_floats_beats_z_over_w_by_the_ratio_of_their_steps():
    """z/w = 1 - r moves the depth as much as r does, d^2 (f - n) / (n f) per unit. So if float32 holds the exact
    number and nothing else rounds, the errors are in the ratio of the steps: 2^-24 for z/w in [1/2, 1),
    2^(floor(log2 r) - 23) for r. In the middle of an octave of r the ratio is 2^(-1 - floor(log2 r)): 16 at depth 1
    for near 0.1, 2^14 at 900."""
    camera = Camera(0.1, 1000.0, 60.0, 1.0)
    for distance in DISTANCES:
        exact = np.random.default_rng(0).uniform(0.97 * distance, 1.03 * distance, 2**14)
        errors, numbers = {}, {}
        for name in WINDOWS:
            encoding = DEPTH_ENCODINGS[name]
            numbers[name] = in_float64(encoding.encode, exact, camera)
            stored = numbers[name].astype(np.float32).astype(np.float64)
            errors[name] = abs(in_float64(encoding.decode, stored, camera) - exact)
        steps = [np.spacing(numbers[name].astype(np.float32)).astype(np.float64) for name in WINDOWS]
        expected = np.mean(steps[WINDOWS.index("window")]) / np.mean(steps[WINDOWS.index("reversed_window")])
        measured = errors["window"].mean() / errors["reversed_window"].mean()
        assert measured == pytest.approx(expected, rel=0.05), f"at {distance}: {measured:.2f} times, not {expected:.2f}"
        assert expected >= distance / camera.near / 4, f"at {distance}: only {expected:.2f} times"
