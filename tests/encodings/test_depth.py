"""Depth codes: the two languages agree, storage is the device's, and no error is above its bound."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from mutants import part_of, swapped_calls
from neighbours import around

from normalbench.bench.tables.depth import measure as depth
from normalbench.encodings import elementary
from normalbench.encodings.catalogue import DEPTH_ENCODINGS
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.codecs.depth_encoding import ULP
from normalbench.encodings.position import Camera, position_from_linear_depth, position_from_window_depth
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES, store_depth
from normalbench.encodings.vec import Vec2, depth_or_far
from normalbench.gbuffer.codecs import depth_passes
from normalbench.gbuffer.codecs.depth_passes import DepthPasses, exact_values
from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError

EVERY = sorted(DEPTH_ENCODINGS)
SIGNED = [name for name in EVERY if DEPTH_ENCODINGS[name].signed]
CODECS = [DepthCodec(encoding, storage) for encoding in DEPTH_ENCODINGS.values() for storage in DEPTH_STORAGES.values()]
CODECS = [codec for codec in CODECS if codec.fits]
CAMERAS = [Camera(0.1, 1000.0, 60.0, 16 / 9), Camera(1.0, 10.0, 30.0, 1.0), Camera(1e-3, 1e6, 120.0, 2.0)]
# At a far plane of 1 a linear depth is its own number.
UNIT = Camera(0.1, 1.0, 60.0, 1.0)
WINDOWS = [name for name in EVERY if DEPTH_ENCODINGS[name].projection]
STRANGE = np.float32([np.nan, np.inf, -np.inf, 3e38, -3e38, 1e-45, -1e-45, 1e-40, 0.0, -0.0, -1.0])


def hard_depths(camera: Camera, count: int = 2**14) -> np.ndarray:
    """Both planes and three ulps around each, every power of two between, random depths spread evenly by their
    logarithm, and what is beyond; float32."""
    planes = np.float32([camera.near, camera.far])
    around = [planes]
    for towards in (-np.inf, np.inf):
        step = planes
        for _ in range(3):
            step = np.nextafter(step, np.float32(towards))
            around.append(step)
    powers = 2.0 ** np.arange(np.ceil(np.log2(camera.near)), np.log2(camera.far))
    random = np.exp(np.random.default_rng(0).uniform(np.log(camera.near), np.log(camera.far), count))
    beyond = np.repeat([2 * camera.far, 100 * camera.far], 2)
    return np.concatenate([*around, powers, random, beyond]).astype(np.float32)


def hard_numbers(is_signed: bool, count: int) -> np.ndarray:
    """0, 1, halves and quarters, the least steps of each storage from both ends, and random numbers; float32."""
    steps = np.array([1 / storage.scale for storage in DEPTH_STORAGES.values()] + [2.0**-24])
    chosen = np.concatenate([[0, 0.25, 0.5, 1], steps, 1 - steps, np.random.default_rng(1).uniform(0, 1, count)])
    numbers = np.resize(chosen, count).astype(np.float32)
    return np.where(np.arange(count) % 2 == 1, -numbers, numbers) if is_signed else numbers


def exact_and_units(function, inputs: np.ndarray, camera: Camera):
    """The exact map of inputs, in float64, and for each what a unit is: 2^-23 of the result and what 2^-23 of the input
    moves the result by."""
    with jax.enable_x64(True):
        wide = jnp.asarray(inputs, jnp.float64)
        near, far = (jnp.float64(np.float32(plane)) for plane in (camera.near, camera.far))
        exact = np.asarray(function(wide, near, far))
        moved = np.maximum(*(abs(np.asarray(function(wide * (1 + s), near, far)) - exact) for s in (ULP, -ULP)))
    return exact, ULP * abs(exact) + moved


@cache
def expected(name: str, camera: Camera):
    """The harness's points for a shader, and what encoder and decoder make of them by JAX and exactly."""
    encoding = DEPTH_ENCODINGS[name]
    depths = hard_depths(camera)
    depths = np.where(np.arange(len(depths)) % 2 == 1, -depths, depths) if encoding.signed else depths
    numbers = hard_numbers(encoding.signed, len(depths))
    places = np.random.default_rng(2).uniform(-1, 1, (len(depths), 2)).astype(np.float32)
    places[:5] = [(0, 0), (1, 1), (-1, -1), (1, -1), (-1, 1)]
    near, far = jnp.float32(camera.near), jnp.float32(camera.far)
    by_jax = [
        np.asarray(encoding.encode(depth_or_far(jnp.asarray(depths), far), near, far)),
        np.asarray(encoding.decode(jnp.asarray(numbers), near, far)),
    ]
    known = np.minimum(abs(depths.astype(np.float64)), np.float32(camera.far))
    exact = [
        exact_and_units(encoding.encode, np.copysign(known, depths), camera),
        exact_and_units(encoding.decode, numbers, camera),
    ]
    return np.concatenate([places, depths[:, None], numbers[:, None]], axis=1), by_jax, exact


def furthest(what: str, inputs, got, exact, units, other) -> tuple[float, str]:
    """The most units that values are from the exact ones or from the other language's, and the story of that."""
    with np.errstate(invalid="ignore"):
        off = np.maximum(abs(got - exact), abs(got.astype(np.float64) - other)) / np.maximum(units, 2.0**-126)
    off = np.where(np.isfinite(off), off, np.inf)
    i = int(np.argmax(off))
    return float(off[i]), f"{what}({inputs[i]!r}) is {got[i]!r}, exactly {exact[i]!r}, by JAX {other[i]!r}"


def disagreement(gl, name: str, camera: Camera) -> list[tuple[float, str]]:
    """For encode and decode the worst of either language, in units."""
    points, by_jax, exact = expected(name, camera)
    values, _, _ = exact_values(gl, DEPTH_ENCODINGS[name], camera, points)
    found = []
    for verb, column, inputs in (("encode", 0, points[:, 2]), ("decode", 1, points[:, 3])):
        what, theirs = f"{name}_{verb}", by_jax[column]
        by_glsl = furthest(f"GLSL {what}", inputs, values[:, column], *exact[column], theirs)
        found.append(max(by_glsl, furthest(f"JAX {what}", inputs, theirs, *exact[column], theirs)))
    return found


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda c: f"{c.near:g} to {c.far:g}")
@pytest.mark.parametrize("name", EVERY)
def test_both_languages_are_as_near_the_exact_maps_as_the_encoding_states(gl, name, camera):
    encoding = DEPTH_ENCODINGS[name]
    for (units, story), allowed in zip(disagreement(gl, name, camera), encoding.ulps, strict=True):
        assert units <= allowed, f"{story}: {units:.2f} units, allowed {allowed}: {encoding.ulps_reason}"


def positions_by_jax(points: np.ndarray, camera: Camera, projection) -> list[np.ndarray]:
    seen, place = camera.seen(projection), Vec2(*map(jnp.asarray, points[:, :2].T.copy()))
    found = (
        position_from_window_depth(place, jnp.asarray(points[:, 3]), seen.clip, seen.clip_to_view),
        position_from_linear_depth(place, jnp.asarray(points[:, 2]), seen.rays),
    )
    return [np.stack([np.asarray(c) for c in position], axis=1) for position in found]


def positions_apart(gl, name: str, camera: Camera) -> list[tuple[float, str]]:
    """The worst difference of positions by the inverse projection and by the ray, in units in the last place of the
    position, and for the projection times how far its sum cancels."""
    encoding = DEPTH_ENCODINGS[name]
    points = expected(name, camera)[0]
    _, *by_gl = exact_values(gl, encoding, camera, points)
    row, (scale, offset) = camera.clip_to_view(encoding.projection)[3], encoding.projection.clip
    terms = [row[2] * (scale * points[:, 3].astype(np.float64) + offset), np.full(len(points), row[3])]
    cancels = [sum(map(abs, terms)) / np.maximum(abs(sum(terms)), 1e-300), np.ones(len(points))]
    by_jax, found = positions_by_jax(points, camera, encoding.projection), []
    for what, ours, theirs, times in zip(("inverse projection", "eye ray"), by_jax, by_gl, cancels, strict=True):
        with np.errstate(invalid="ignore"):
            off = np.linalg.norm(ours.astype(np.float64) - theirs, axis=1) / np.linalg.norm(ours, axis=1) / times / ULP
        # Where the sum cancels to nothing that float32 keeps, neither language says anything.
        off = np.where(times * POSITION_ULPS[0] * ULP < 0.5, np.where(np.isfinite(off), off, np.inf), 0)
        i = int(np.argmax(off))
        found.append((float(off[i]), f"{name} by {what} of {points[i]!r}: JAX {ours[i]!r}, GLSL {theirs[i]!r}"))
    return found


POSITION_ULPS = (3, 1)


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda c: f"{c.near:g} to {c.far:g}")
@pytest.mark.parametrize("name", WINDOWS)
def test_positions_are_the_same_in_both_languages(gl, name, camera):
    for (ulps, story), allowed in zip(positions_apart(gl, name, camera), POSITION_ULPS, strict=True):
        assert ulps <= allowed, f"{story}: {ulps:.2f} ulps, allowed {allowed}"


@pytest.mark.parametrize("name", WINDOWS)
def test_the_projection_is_the_encodings_own(name):
    """What the inverse projection makes of an exact number lies at the depth it stands for, and on the eye's ray."""
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


# A product of the two that change places: these are not other functions.
SAME_PRODUCT = {
    "linear_decode_depth(float far, float near, float number)",
    "linear_sign_decode_depth(float far, float near, float number)",
    "position_from_linear_depth(vec2 rays, float depth, vec2 place)",
}


def mutants() -> list:
    """(encoding whose harness must notice, file, its text with two arguments exchanged)."""
    files = {name: [(DEPTH_ENCODINGS[name].glsl, "")] for name in EVERY}
    shared = DEPTH_ENCODINGS["window"].glsl.parents[1]
    files["window"] += [(shared / "position.glsl", "")]
    files["linear_sign"] += [(shared / "sign.glsl", ""), (shared / "vec.glsl", "float depth_or_far")]
    found = []
    for name, sources in files.items():
        for file, function in sources:
            text = file.read_text()
            start, end = part_of(text, function)
            for what, changed in swapped_calls(text[start:end]):
                if what not in SAME_PRODUCT:
                    found.append(pytest.param(name, file, text[:start] + changed + text[end:], id=f"{name}: {what}"))
    return found


@pytest.mark.parametrize("name, file, text", mutants())
def test_swapping_two_arguments_is_noticed(gl, monkeypatch, name, file, text):
    """No swap of two arguments in any GLSL function of a depth code goes unseen."""
    original, encoding = shader.read_shader, DEPTH_ENCODINGS[name]
    monkeypatch.setattr(shader, "read_shader", lambda path: text if path == file else original(path))
    try:
        found = list(zip(disagreement(gl, name, CAMERAS[0]), encoding.ulps, strict=True))
        if encoding.projection:
            found += zip(positions_apart(gl, name, CAMERAS[0]), POSITION_ULPS, strict=True)
    except ShaderError:
        return  # the types disagree: nobody can ship that
    assert any(units > allowed for (units, _), allowed in found), [story for (_, story), _ in found]


def test_there_are_mutants_of_every_encoding():
    assert {str(mutant.values[0]) for mutant in mutants()} == set(EVERY) and len(mutants()) > 30


def test_logarithms_and_powers_are_within_two_units_in_the_last_place():
    """Against float64: every octave, both sides of 1, and what the decoder asks for."""
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


def hard_codes(storage) -> np.ndarray:
    """Numbers of [0, 1]: of 16 bits every code and every tie, of 24 those around each carry and random ones, with their
    neighbours; of floats random ones of every exponent, and each half float with the tie behind it."""
    random = np.random.default_rng(3)
    if storage.format.kind == "float":
        halves = np.arange(2**16, dtype=np.uint16).view(np.float16).astype(np.float32)
        halves = np.sort(halves[(halves >= 0) & (halves <= 1)])
        ties = (halves[1:] + halves[:-1]) / 2
        return np.concatenate([around(halves, 1), around(ties, 1), 2.0 ** random.uniform(-30, 0, 2**14)]).astype("f")
    codes = np.arange(2.0**16)
    if storage.bits > 16:
        carries = np.arange(0, 2.0**storage.bits, 2**8)
        codes = np.concatenate([carries - 1, carries, carries + 1, random.integers(0, storage.scale, 2**12)])
    codes = np.clip(np.concatenate([codes, codes + 0.5]), 0, storage.scale)
    return np.clip(around(codes / storage.scale), 0, 1)


def assert_same_bits(inputs, ours, theirs, what: str) -> None:
    # Either side may flush what is below the smallest normal float32, and does or does not by what ran before.
    ours, theirs = (np.where(np.abs(a) < 2.0**-126, np.copysign(np.float32(0), a), a) for a in (ours, theirs))
    different = np.flatnonzero(ours.view(np.uint32) != theirs.view(np.uint32))
    if len(different):
        i = different[0]
        pytest.fail(f"{what}: {len(different)} of {len(inputs)} differ: {inputs[i]!r} is {ours[i]!r}, GL {theirs[i]!r}")


def as_points(depths: np.ndarray, width: int = 1024) -> np.ndarray:
    points = np.zeros((-(-len(depths) // width) * width, 3), np.float32)
    points[: len(depths), 2] = depths
    return points.reshape(-1, width, 3)


def numbers_by_gl(gl, codec: DepthCodec, camera: Camera, depths: np.ndarray) -> np.ndarray:
    with DepthPasses(gl, codec) as passes:
        return passes.round_trip(as_points(depths), camera, False).numbers.ravel()[: len(depths)].copy()


def numbers_by_jax(codec: DepthCodec, camera: Camera, depths: np.ndarray) -> np.ndarray:
    near, far, size = jnp.float32(camera.near), jnp.float32(camera.far), 2**13
    # Always so many at once: JAX compiles each operation for each shape.
    parts = np.pad(depths, (0, -len(depths) % size)).reshape(-1, size)
    return np.concatenate([np.asarray(codec.stored(jnp.asarray(part), near, far)) for part in parts])[: len(depths)]


@pytest.mark.slow
@pytest.mark.parametrize("name", DEPTH_STORAGES)
def test_the_device_stores_numbers_as_the_emulation_says(gl, name):
    """Bit for bit, for numbers that linear depth at a far plane of 1 hands on as they are."""
    codec = DepthCodec(DEPTH_ENCODINGS["linear"], DEPTH_STORAGES[name])
    depths = hard_codes(codec.storage)
    assert_same_bits(depths, numbers_by_jax(codec, UNIT, depths), numbers_by_gl(gl, codec, UNIT, depths), name)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, s in DEPTH_STORAGES.items() if s.is_signed])
def test_the_device_stores_signed_numbers_as_the_emulation_says(gl, name):
    codec = DepthCodec(DEPTH_ENCODINGS["linear_sign"], DEPTH_STORAGES[name])
    depths = hard_codes(codec.storage)
    depths = np.concatenate([depths, -depths])
    assert_same_bits(depths, numbers_by_jax(codec, UNIT, depths), numbers_by_gl(gl, codec, UNIT, depths), name)


@pytest.mark.parametrize("name", [n for n, s in DEPTH_STORAGES.items() if s.home == "attachment"])
def test_a_depth_buffer_clamps_as_the_emulation_does(gl, name):
    storage = DEPTH_STORAGES[name]
    numbers = np.float32([1.5, -1, 3e38, np.inf, -np.inf, 0, 1, 0.5])
    got = depth_passes.through(gl, storage, numbers)
    assert_same_bits(numbers, np.asarray(store_depth(jnp.asarray(numbers), storage)), got, name)


@pytest.mark.parametrize("far", [1.0, 1000.0])
@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_sixteen_bits_in_8_to_8_are_exact_to_half_a_code(gl, backend, far):
    """Linear depth, every code and every tie between codes with neighbours: the stored code is within half a code of
    the exact one, but for what float32 does to the number (a rounding of d / far, one of its product with 65535, and
    one of the share that comes back: two units in the last place), whether or not the low byte carries."""
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
def test_the_sign_of_z_survives_at_the_least_depths(gl, name, storage, backend):
    """Codes 0 and 1 of either sign, -0 and +0 too, come back with their signs and their magnitudes."""
    codec, camera = DepthCodec(DEPTH_ENCODINGS[name], DEPTH_STORAGES[storage]), CAMERAS[0]
    scale = codec.storage.scale // 2 or 2**10
    steps = np.float32([0, 1, 2, scale // 2, scale]) / np.float32(scale) * np.float32(camera.far)
    depths = np.concatenate([steps, -steps])
    numbers = numbers_by_jax(codec, camera, depths) if backend == "jax" else numbers_by_gl(gl, codec, camera, depths)
    assert np.array_equal(np.signbit(numbers), np.signbit(depths)), f"{depths!r} are stored as {numbers!r}"
    whole = numbers / (camera.far if codec.storage.is_open else 1) * scale
    assert np.array_equal(np.rint(abs(whole)), np.tile([0, 1, 2, scale // 2, scale], 2)), f"codes {whole!r}"


@pytest.mark.parametrize("codec", CODECS, ids=lambda codec: codec.name)
def test_whatever_comes_in_a_number_is_stored(gl, codec):
    """NaN, infinity and what is beyond far are stored as far is, under their sign where there is one; without one a
    negative depth is stored as 0 is. Both languages, and no texel that is not a number."""
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
    """z/w = 1 - r moves the depth as much as r does, d^2 (f - n) / (n f) for a unit. So where float32 holds the exact
    number, and nothing else rounds, the errors are as the steps: 2^-24 for z/w in [1/2, 1), 2^(floor(log2 r) - 23) for
    r. In the middle of an octave of r that is 2^(-1 - floor(log2 r)): 16 at depth 1 for near 0.1, 2^14 at 900."""
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


@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_reversed_depth_beats_z_over_w_in_shaders_by_the_distance_over_near(backend):
    """In float32 all the way each rounding of z/w, which is near 1, moves the depth by d^2 / n times 2^-24, and each of
    r, which is relative, by d times 2^-24 (and the position's own do as much): the ratio is d / n times that of how
    many roundings count, which are as many in both within a factor of two."""
    camera = Camera(0.1, 1000.0, 60.0, 16 / 9)
    worst = {}
    for name in WINDOWS:
        codec = DepthCodec(DEPTH_ENCODINGS[name], DEPTH_STORAGES["depth32f"])
        case = depth.Case(codec, "inverse_projection", backend, camera, DISTANCES, 2**12, 0)
        worst[name] = np.array([row["error_max"] for row in depth.measure(case)])
    factors, expected = worst["window"] / worst["reversed_window"], np.array(DISTANCES) / camera.near
    story = f"at {DISTANCES}: {factors.round(1)} times, expected {expected}"
    assert np.all((factors > expected / 2) & (factors < expected * 2)), story


def test_half_a_step_is_what_the_derivative_says():
    """Linear: f / (2 (2^n - 1)) anywhere, twice that with a sign. z/w: d^2 (f - n) / (n f) times 1 / (2 (2^n - 1)), to
    first order. Logarithmic: d ln(f / n) as much. Half floats: half of 2^-10 of the depth's octave."""
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


def cases(backend: str, camera: Camera) -> list:
    distances = (*np.geomspace(camera.near, camera.far, 4).tolist(), None)
    return [
        depth.Case(codec, way, backend, camera, distances, 2**10, 7) for codec in CODECS for way in depth.ways(codec)
    ]


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda c: f"{c.near:g} to {c.far:g}")
@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_no_error_is_above_its_bound(backend, camera):
    """Every code in every storage by every way: each point's own bound, not the row's."""
    for case in cases(backend, camera):
        on = depth.all_points(camera, case.distances, case.count, case.seed)
        found = depth.through(case, on)
        with np.errstate(invalid="ignore"):
            share = np.where(np.isfinite(found.bounds), found.errors / found.bounds, 0)
        i = int(np.argmax(share))
        story = f"{case.name} by {case.rebuilt}, depth {on.depths[i]!r}"
        assert share[i] <= 1, f"{story}: off by {found.errors[i]:.6g}, bound {found.bounds[i]:.6g}"
        assert not found.lost.any(), f"{case.name}: {found.lost.sum()} signs lost"


def test_an_error_is_along_the_eyes_ray():
    """Linear depth in 16 bits: a position is as far off as its depth, times the length of the ray at depth 1."""
    camera = Camera(0.1, 1000.0, 60.0, 16 / 9)
    on = depth.points(camera, None, 256, 0)
    codec = DepthCodec(DEPTH_ENCODINGS["linear"], DEPTH_STORAGES["packed16"])
    found = depth.through(depth.Case(codec, "eye_ray", "jax", camera, (None,), 256, 0), on)
    back = np.asarray(codec.round_trip(jnp.asarray(on.depths), np.float32(0.1), np.float32(1000)), np.float64)
    expected = np.linalg.norm(on.rays(camera), axis=1) * abs(back - on.depths)
    assert found.errors == pytest.approx(expected, rel=1e-3, abs=1e-3)
