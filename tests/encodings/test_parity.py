"""The two languages agree: before storage to a few units in the last place, after it code for code."""

import itertools
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from directions import NOT_DIRECTIONS, hard_directions, random_directions, view_positions
from mutants import part_of, swapped_calls

from normalbench.bench.normals.normal_sets import hemisphere, playground, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings import vec
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import ROUNDINGS, STORAGES
from normalbench.gbuffer.codecs.codec_passes import CodecPasses, exact_values
from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError

ULP = 2.0**-23
WHOLE = [name for name, storage in STORAGES.items() if not storage.is_packed and name != "rgba32f"]
PACKED = [name for name, storage in STORAGES.items() if storage.is_packed]
# What is laid across channels is rounded as test_storage.py holds it to be, whatever the encoding: with these, which
# between them have two numbers and three, few values, and a choice, it is held once more.
ACROSS = ("octahedral", "octahedral_precise", "signed_octahedral", "tetrahedral", "cube", "xyz_renormalised")
EVERY = sorted(ENCODINGS)


def planes(array: np.ndarray) -> vec.Vec3:
    return vec.Vec3(*(jnp.asarray(np.ascontiguousarray(c)) for c in array.T[:3]))


def widened(array: np.ndarray) -> np.ndarray:
    return np.concatenate([array, np.zeros((len(array), 4 - array.shape[1]), np.float32)], axis=1)


def codes_by_jax(encoding, n: np.ndarray, view: np.ndarray) -> np.ndarray:
    code = jax.jit(encoding.encode)(vec.from_array(n), planes(view))
    return np.stack([np.asarray(c) for c in code], axis=1)


def normals_by_jax(encoding, code: np.ndarray, view: np.ndarray) -> np.ndarray:
    vector = vec.Vec2 if code.shape[1] == 2 else vec.Vec3
    n = jax.jit(encoding.decode)(vector(*(jnp.asarray(c) for c in code.T)), planes(view))
    return np.stack([np.asarray(c) for c in n], axis=1)


def given_codes(encoding, codes: np.ndarray) -> np.ndarray:
    """Codes to decode: those of the directions, the first replaced by corners, edges and centre of the code space."""
    corners = np.array(list(itertools.product((-1.0, 0.0, 0.5, 1.0), repeat=codes.shape[1])), np.float32)
    if encoding.sign_bits:
        corners[:, -1] = np.where(corners[:, -1] > 0, 1, -1)
    given = codes.copy()
    given[: len(corners)] = corners
    return given


def condition(function, inputs: np.ndarray) -> np.ndarray:
    """How many units the exact map's result moves for a unit of its input: 1 to 4096, by differences in float64.

    Where a root cancels, at a horizon or a rim, two right float32 results lie that far apart.
    """
    with jax.enable_x64(True):
        exact = jax.jit(lambda a: jnp.stack([c.astype(jnp.float64) for c in function(a)]))
        base = exact(jnp.asarray(inputs.T, jnp.float64))
        moved = jnp.zeros(len(inputs))
        for component, side in itertools.product(range(inputs.shape[1]), (ULP, -ULP)):
            step = np.zeros((inputs.shape[1], 1))
            step[component] = side
            there = exact(jnp.asarray(inputs.T + step))
            moved = jnp.maximum(moved, jnp.abs(there - base).max(axis=0) / ULP)
        return np.clip(np.nan_to_num(np.asarray(moved), nan=4096.0), 1, 4096)


def worst_of(what: str, inputs, expected, got, conditions) -> tuple[float, str]:
    """The largest difference in units in the last place (of 1, or of the value where it is larger), less what the
    condition of the map there excuses, and its story."""
    ulps = np.abs(expected.astype(np.float64) - got) / np.maximum(1.0, np.abs(expected)) / ULP
    ulps = np.where(np.isfinite(ulps), ulps, np.inf).max(axis=1)
    excused = ulps / conditions
    i = int(np.argmax(excused))
    story = f"JAX {expected[i]!r}, GLSL {got[i]!r}, {ulps[i]:.1f} ulp where the map's condition is {conditions[i]:.0f}"
    return float(excused[i]), f"{what} {inputs[i]!r}: {story}"


@cache
def inputs_and_expected(name: str):
    """The harness's inputs, the JAX results and their conditions; the same for every mutant of the GLSL."""
    encoding = ENCODINGS[name]
    n = np.concatenate([hard_directions(), random_directions(2**16)])
    view = view_positions(len(n))
    codes = codes_by_jax(encoding, n, view)
    given = given_codes(encoding, codes)
    vector = vec.Vec2 if codes.shape[1] == 2 else vec.Vec3
    with jax.enable_x64(True):
        views = vec.Vec3(*jnp.asarray(view.T, jnp.float64))
        signs = [jnp.asarray(c, jnp.float64) for c in given.T[encoding.components :]]
    encode_condition = condition(lambda a: encoding.encode(vec.Vec3(*a), views), n)
    free = given[:, : encoding.components]
    decode_condition = condition(lambda a: encoding.decode(vector(*a, *signs), views), free)
    return n, view, codes, given, normals_by_jax(encoding, given, view), encode_condition, decode_condition


def misses(encoding, n: np.ndarray, codes: np.ndarray, view: np.ndarray) -> np.ndarray:
    """How far each direction is from what its code decodes to, in float64; of shape (count, 1)."""
    vector = vec.Vec2 if codes.shape[1] == 2 else vec.Vec3
    with jax.enable_x64(True):
        given = (jnp.asarray(c, jnp.float64) for c in codes.T)
        decoded = jax.jit(encoding.decode)(vector(*given), vec.Vec3(*jnp.asarray(view.T, jnp.float64)))
        return np.linalg.norm(n - np.stack([np.asarray(c) for c in decoded], axis=1), axis=1)[:, None]


def disagreement(gl, encoding) -> tuple[tuple[float, str], tuple[float, str]]:
    """The worst difference of encode and of decode over the harness's inputs."""
    n, view, codes, given, normals, encode_condition, decode_condition = inputs_and_expected(encoding.name)
    gl_codes, gl_normals = exact_values(gl, encoding, widened(n), widened(view), widened(given))
    gl_codes = gl_codes[:, : codes.shape[1]]
    if encoding.searches:
        # Where two codes are as near, the languages may differ in which, but not in how near it is.
        by_jax, by_gl = (misses(encoding, n, found, view) for found in (codes, gl_codes))
        encoded = worst_of(f"{encoding.name}_encode's miss", n, by_jax, by_gl, np.ones(len(n)))
    else:
        encoded = worst_of(f"{encoding.name}_encode", n, codes, gl_codes, encode_condition)
    return (
        encoded,
        worst_of(f"{encoding.name}_decode", given, normals, gl_normals[:, :3], decode_condition),
    )


@pytest.mark.parametrize("name", EVERY)
def test_before_storage_the_languages_differ_by_no_more_ulps_than_the_encoding_states(gl, name):
    encoding = ENCODINGS[name]
    for (ulps, story), allowed in zip(disagreement(gl, encoding), encoding.ulps, strict=True):
        assert ulps <= allowed, f"{story}; allowed {allowed}: {encoding.ulps_reason}"


def codecs(storages, roundings=("nearest",), names=EVERY, marks=()) -> list:
    every = (Codec(ENCODINGS[n], STORAGES[s], r) for n, s, r in itertools.product(names, storages, roundings))
    return [pytest.param(codec, id=codec.name, marks=marks) for codec in every if codec.fits]


@pytest.mark.parametrize("codec", [*codecs(["rgba8", "rgb10a2", "rg16f"]), *codecs(PACKED, names=ACROSS)])
def test_stored_codes_agree(gl, codec):
    """Equal for 99.9 % of 2^16 directions at up to 12 bits, for 97 % at 16, nowhere more than a step apart.

    Where precise rounding takes another code that one must be as good; an encoder that searches is held to that before
    storage.
    """
    check_stored_codes(gl, codec, 256)


@pytest.mark.slow
@pytest.mark.parametrize(
    "codec",
    [
        *codecs(["rgba8", "rgb10a2", "rg16f", "rg8_snorm", "rg16", "rg16_snorm", "r11g11b10f"]),
        *codecs(PACKED, names=ACROSS),
    ],
)
def test_stored_codes_of_more_directions_agree(gl, codec):
    """As above, of 2^18, in more storages."""
    check_stored_codes(gl, codec, 512)


def check_stored_codes(gl, codec, side: int) -> None:
    """Of side^2 directions."""
    n, view = random_directions(side**2), view_positions(side**2)
    code = jax.jit(codec.stored)(vec.from_array(n), planes(view))
    by_jax = np.stack([np.asarray(c) for c in code], axis=1)
    shape = (side, side, 4)
    with CodecPasses(gl, codec) as passes:
        by_gl = passes.round_trip(widened(n).reshape(shape), widened(view).reshape(shape)).codes.reshape(-1, 4)
    by_gl = by_gl[:, : by_jax.shape[1]]
    # Numbers read back differ by a unit where one language fuses 2 x - 1; codes are whole steps apart, or the same.
    steps = np.stack([np.broadcast_to(step_of(codec, i, c), c.shape) for i, c in enumerate(by_jax.T)], axis=1)
    apart = np.abs(by_jax - by_gl) / steps
    equal = np.mean(np.all(apart < 0.5, axis=1))
    wanted = 0.97 if codec.storage.bits[0] == 16 else 0.999
    assert equal >= wanted, f"{codec.name}: {equal:.5f} of the codes are equal, wanted {wanted}"
    if codec.encoding.searches:
        return
    if codec.encoding.is_precise:
        by_jax, by_gl = (misses(codec.encoding, n, codes, view) for codes in (by_jax, by_gl))
        apart = np.abs(by_jax - by_gl) / (8 * ULP)
    worst = np.unravel_index(np.argmax(apart), apart.shape)[0]
    story = f"{n[worst]!r} is stored as {by_jax[worst]!r} by JAX, {by_gl[worst]!r} by GLSL"
    assert apart.max() < 1.5, f"{codec.name}: {story}, {apart.max():.1f} steps apart"


def step_of(codec, component: int, values: np.ndarray):
    """The distance between neighbouring codes. Half floats are finer near zero than float32 arithmetic on numbers near
    1 is exact: there the step is two of its units."""
    storage, levels = codec.storage, codec.encoding.levels_of(component)
    if levels:
        return 2 / (levels - 1)
    if storage.is_biased and storage.kind == "float":
        texels = np.maximum(values.astype(np.float64) * 0.5 + 0.5, 2.0**-14)
        return 2 * 2.0 ** (np.floor(np.log2(texels)) - (storage.bits[component] - 5))
    if storage.kind == "float":
        return np.maximum(np.spacing(np.abs(values).astype(np.float16)).astype(np.float64), 2 * ULP)
    return (2 if storage.kind == "unorm" else 1) / storage.scale(component)


@pytest.mark.usefixtures("gl")
def test_the_stereographic_scale_is_one_field_for_both_languages():
    """At scale 1 the disk is the hemisphere: better there than a scale for a wider view, and the same by both."""
    psnr = {}
    for scale in (1.0, 1.7777):
        codec = Codec(ENCODINGS["stereographic"].with_parameters({"scale": scale}), STORAGES["rgba8"])
        for backend in ("jax", "glsl"):
            row = quality.measure(quality.Case(codec, hemisphere(2**18), backend))
            psnr[scale, backend] = row["psnr_db"]
        assert abs(psnr[scale, "jax"] - psnr[scale, "glsl"]) <= 0.02, psnr
    assert psnr[1.0, "jax"] > psnr[1.7777, "jax"] + 3, psnr


# Every storage with one encoding, every encoding in one storage, every rounding.
FIRST = [
    *codecs(["rgba8"]),
    *codecs([*WHOLE[1:], *PACKED], names=["octahedral"]),
    *codecs(["rgba8", "rg16f"], ["truncate"], names=["octahedral", "spheremap"]),
    *codecs(["rgba8"], ["truncate_half"], names=["octahedral", "spheremap"]),
]
# Of all pairs a third: each encoding in every third storage, each storage with every third encoding.
REST = [
    *codecs(WHOLE, marks=pytest.mark.slow)[::3],
    *codecs(["rgba8", "rg16f"], ["truncate"], marks=pytest.mark.slow),
    *codecs(["rgba8"], ["truncate_half"], marks=pytest.mark.slow),
    *codecs(PACKED, ROUNDINGS, names=ACROSS, marks=pytest.mark.slow)[::2],
]


@pytest.mark.parametrize("codec", {param.id: param for param in (*REST, *FIRST)}.values())
@pytest.mark.usefixtures("gl")
def test_the_two_back_ends_give_the_same_psnr(codec):
    for normals in (sphere(2**17), playground()):
        by_jax, by_gl = (
            quality.measure(quality.Case(codec, normals, backend))["psnr_db"] for backend in ("jax", "glsl")
        )
        assert abs(by_jax - by_gl) <= 0.02, f"{codec.name} on {normals.name}: JAX {by_jax} dB, GLSL {by_gl} dB"


@pytest.mark.parametrize("name", EVERY)
def test_what_is_no_direction_is_stored_as_forward(gl, name):
    """Zero, NaN and infinite vectors give the code of (0, 0, 1), in both languages."""
    encoding = ENCODINGS[name]
    n = np.concatenate([NOT_DIRECTIONS, [[0, 0, 1]]]).astype(np.float32)
    view = np.broadcast_to(np.float32([0.3, -0.2, -1.0]), n.shape)
    by_jax = codes_by_jax(encoding, n, view)
    by_gl, _ = exact_values(gl, encoding, widened(n), widened(view), widened(by_jax))
    for what, codes in (("JAX", by_jax), ("GLSL", by_gl[:, : by_jax.shape[1]])):
        assert np.all(codes == codes[-1]), f"{name} by {what}: {codes!r}"
        assert np.all(np.isfinite(codes)), f"{name} by {what}: {codes!r}"


@pytest.mark.parametrize("storage", ["rgba8", "rgba16f", "rgba32f"])
@pytest.mark.parametrize("name", EVERY)
def test_every_direction_comes_back_finite(name, storage):
    codec = Codec(ENCODINGS[name], STORAGES[storage])
    n = np.concatenate([hard_directions(), NOT_DIRECTIONS])
    decoded = np.asarray(vec.to_array(codec.round_trip(vec.from_array(n), planes(view_positions(len(n))))))
    bad = ~np.isfinite(decoded).all(axis=1)
    assert not bad.any(), f"{codec.name}: {n[bad][0]!r} comes back as {decoded[bad][0]!r}"


# Which encoding's harness sees the shared functions that no other encoding of this list would notice.
SHARED = {
    "spherical": ["elementary.glsl"],
    "octahedral": ["vec.glsl:sign_not_zero"],
    "cryengine3": ["vec.glsl:unit(vec2"],
    "per_pixel_view": ["vec.glsl:unit(vec3"],
}


def mutants() -> list:
    found = []
    for name in EVERY:
        path = ENCODINGS[name].glsl
        for spec in ["", *SHARED.get(name, [])]:
            file_name, _, function = spec.partition(":")
            file = path.parents[1] / file_name if file_name else path
            text = file.read_text()
            start, end = part_of(text, function)
            for what, changed in swapped_calls(text[start:end]):
                found.append(pytest.param(name, file, text[:start] + changed + text[end:], id=f"{name}: {what}"))
    return found


@pytest.mark.parametrize("name, file, text", mutants())
def test_swapping_two_arguments_is_noticed(gl, monkeypatch, name, file, text):
    """The harness is strict enough: no swap of two arguments in any GLSL function of an encoding goes unseen."""
    original = shader.read_shader
    monkeypatch.setattr(shader, "read_shader", lambda path: text if path == file else original(path))
    try:
        found = disagreement(gl, ENCODINGS[name])
    except ShaderError:
        return  # the types disagree: nobody can ship that
    stories = [story for _, story in found]
    assert any(u > allowed for (u, _), allowed in zip(found, ENCODINGS[name].ulps, strict=True)), stories


def test_the_mutants_cover_every_call():
    """There is something to swap in each encoding but those that are one argument deep."""
    names = {str(m.values[0]) for m in mutants()}
    assert names == set(EVERY)
    assert len(mutants()) > 40
