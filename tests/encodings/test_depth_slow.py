"""Depth encodings: projections, preserved signs and errors within their bounds."""

import jax.numpy as jnp
import numpy as np
import pytest
from parity.comparison import ULP
from parity.depth import CAMERAS, CODECS
from test_depth import DISTANCES, WINDOWS

from normalbench.bench.tables.depth import measure as depth
from normalbench.encodings import elementary
from normalbench.encodings.catalogue import DEPTH_ENCODINGS
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.shared.position import Camera
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES


def test_logarithms_and_powers_are_within_two_units_in_the_last_place():
    """Compared with float64 in every octave, on both sides of 1, and at the arguments of the decoder."""
    x = np.concatenate([2.0 ** np.random.default_rng(0).uniform(-120, 120, 2**16), 1 + np.linspace(-0.3, 0.45, 2**14)])
    x = x.astype(np.float32)
    log2 = np.log2(x.astype(np.float64))
    off = abs(np.asarray(elementary.log2_of(jnp.asarray(x))) - log2) / np.maximum(abs(log2), 2.0**-126)
    i = int(np.argmax(off))
    assert off[i] <= 2 * ULP, f"log2({x[i]!r}): {off[i] / ULP:.2f} ulps"
    y = np.random.default_rng(1).uniform(-120, 120, 2**16).astype(np.float32)
    power = np.exp2(y.astype(np.float64))
    off = abs(np.asarray(elementary.exp2_of(jnp.asarray(y))) / power - 1)
    i = int(np.argmax(off))
    assert off[i] <= 2 * ULP, f"2^{y[i]!r}: {off[i] / ULP:.2f} ulps"


@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_reversed_depth_beats_z_over_w_in_shaders_by_the_distance_over_near(backend):
    """In float32 throughout, each rounding of z/w, which is near 1, moves the depth by d^2 / n times 2^-24, and each
    rounding of r, which is relative, by d times 2^-24 (as do those of the position). The ratio is d / n times the
    ratio of the numbers of roundings, which are equal within a factor of two."""
    camera = Camera(0.1, 1000.0, 60.0, 16 / 9)
    worst = {}
    for name in WINDOWS:
        codec = DepthCodec(DEPTH_ENCODINGS[name], DEPTH_STORAGES["depth32f"])
        case = depth.DepthCase(codec, "inverse_projection", backend, camera, DISTANCES, 2**12, 0)
        worst[name] = np.array([row["error_max"] for row in depth.measure(case)])
    factors, expected = worst["window"] / worst["reversed_window"], np.array(DISTANCES) / camera.near
    story = f"at {DISTANCES}: {factors.round(1)} times, expected {expected}"
    assert np.all((factors > expected / 2) & (factors < expected * 2)), story


def test_half_a_step_of_depth_matches_the_derivative():
    """Linear: f / (2 (2^n - 1)) anywhere, twice that with a sign. z/w: d^2 (f - n) / (n f) times 1 / (2 (2^n - 1)),
    to first order. Logarithmic: d ln(f / n) times the same factor. Half floats: half of 2^-10 of the depth's
    octave."""
    camera, d = Camera(0.1, 1000.0, 60.0, 1.0), np.array([1.0, 10.0])

    def half(encoding: str, storage: str) -> np.ndarray:
        return DepthCodec(DEPTH_ENCODINGS[encoding], DEPTH_STORAGES[storage]).furthest(d, camera, False)

    assert half("linear", "packed16") == pytest.approx(1000 / 131070)
    assert half("linear_sign", "packed16") == pytest.approx(1000 / 65534)
    assert half("linear", "packed24") == pytest.approx(1000 / 33554430)
    assert half("linear", "r16f") == pytest.approx([2**-11, 8 * 2**-11])
    for name in WINDOWS:
        assert half(name, "depth16") == pytest.approx(d**2 * 999.9 / 100 / 131070, rel=2e-3)
    assert half("logarithmic", "packed16") == pytest.approx(d * np.log(1e4) / 131070, rel=1e-3)


def test_a_position_error_is_along_the_view_ray():
    """Linear depth in 16 bits: a position's error is the depth error times the length of the ray at depth 1."""
    camera = Camera(0.1, 1000.0, 60.0, 16 / 9)
    on = depth.points(camera, None, 256, 0)
    codec = DepthCodec(DEPTH_ENCODINGS["linear"], DEPTH_STORAGES["packed16"])
    measured = depth.through(depth.DepthCase(codec, "eye_ray", "jax", camera, (None,), 256, 0), on)
    back = np.asarray(codec.round_trip(jnp.asarray(on.depths), np.float32(0.1), np.float32(1000)), np.float64)
    expected = np.linalg.norm(on.rays(camera), axis=1) * abs(back - on.depths)
    assert measured.errors == pytest.approx(expected, rel=1e-3, abs=1e-3)


def cases(backend: str, camera: Camera) -> list:
    distances = (*np.geomspace(camera.near, camera.far, 4).tolist(), None)
    return [
        depth.DepthCase(codec, way, backend, camera, distances, 2**10, 7)
        for codec in CODECS
        for way in depth.ways(codec)
    ]


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda c: f"{c.near:g} to {c.far:g}")
@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_no_error_exceeds_its_bound(backend, camera):
    """Every encoding in every storage is reconstructed in every way; each point is compared with its own bound."""
    for case in cases(backend, camera):
        on = depth.all_points(camera, case.distances, case.count, case.seed)
        measured = depth.through(case, on)
        with np.errstate(invalid="ignore"):
            share = np.where(np.isfinite(measured.bounds), measured.errors / measured.bounds, 0)
        i = int(np.argmax(share))
        story = f"{case.name} by {case.rebuilt}, depth {on.depths[i]!r}"
        assert share[i] <= 1, f"{story}: off by {measured.errors[i]:.6g}, bound {measured.bounds[i]:.6g}"
        assert not measured.lost.any(), f"{case.name}: {measured.lost.sum()} signs lost"
