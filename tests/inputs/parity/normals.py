"""Normal encodings: hard and random directions, compared in units scaled by the condition of the map."""

import itertools
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
from directions import NOT_DIRECTIONS, hard_directions, random_directions, view_positions

from normalbench.encodings import vec
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.encoding import Encoding
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.codecs.codec_passes import CodecPasses, exact_values

from .comparison import ULP, Comparison, Parity, planes, rows, widened

PACKED = [name for name, storage in STORAGES.items() if storage.is_packed]
# What is laid across channels is rounded as test_storage.py holds it to be, whatever the encoding: with these, which
# between them have two numbers and three, few values, and a choice, it is held once more.
ACROSS = ("octahedral", "octahedral_precise", "signed_octahedral", "tetrahedral", "cube", "xyz_renormalised")
EVERY = sorted(ENCODINGS)


def codecs(storages, roundings=("nearest",), names=EVERY) -> list[Codec]:
    every = (Codec(ENCODINGS[n], STORAGES[s], r) for n, s, r in itertools.product(names, storages, roundings))
    return [codec for codec in every if codec.fits]


def vector(numbers):
    return (vec.Vec2 if len(numbers) == 2 else vec.Vec3)(*numbers)


def codes_by_jax(encoding: Encoding, n: np.ndarray, view: np.ndarray) -> np.ndarray:
    return rows(jax.jit(encoding.encode)(vec.from_array(n), planes(vec.Vec3, view)))


def given_codes(encoding: Encoding, codes: np.ndarray) -> np.ndarray:
    """Return the directions' codes, the first codes replaced by corners, edges and the centre of the code space."""
    corners = np.array(list(itertools.product((-1.0, 0.0, 0.5, 1.0), repeat=codes.shape[1])), np.float32)
    if encoding.sign_bits:
        corners[:, -1] = np.where(corners[:, -1] > 0, 1, -1)
    given = codes.copy()
    given[: len(corners)] = corners
    return given


def condition(function, inputs: np.ndarray) -> np.ndarray:
    """Return how many units the exact map's result moves per unit of its input: 1 to 4096, by differences in float64.

    Where a root cancels, at a horizon or a rim, two correct float32 results may be that far apart.
    """
    with jax.enable_x64(True):

        def exact(a):
            # An operation at a time: each is compiled once for all encodings.
            return jnp.stack([c.astype(jnp.float64) for c in function(a)])

        base = exact(jnp.asarray(inputs.T, jnp.float64))
        moved = jnp.zeros(len(inputs))
        for component, side in itertools.product(range(inputs.shape[1]), (ULP, -ULP)):
            step = np.zeros((inputs.shape[1], 1))
            step[component] = side
            there = exact(jnp.asarray(inputs.T + step))
            moved = jnp.maximum(moved, jnp.abs(there - base).max(axis=0) / ULP)
        return np.clip(np.nan_to_num(np.asarray(moved), nan=4096.0), 1, 4096)


@cache
def expected(encoding: Encoding):
    """Return inputs, JAX's results and the conditions there, which are the same for every mutant of the GLSL."""
    n = np.concatenate([hard_directions(), random_directions(2**16)])
    view = view_positions(len(n))
    codes = codes_by_jax(encoding, n, view)
    given = given_codes(encoding, codes)
    normals = rows(jax.jit(encoding.decode)(vector([*map(jnp.asarray, given.T)]), planes(vec.Vec3, view)))
    with jax.enable_x64(True):
        views = vec.Vec3(*jnp.asarray(view.T, jnp.float64))
        signs = [jnp.asarray(c, jnp.float64) for c in given.T[encoding.components :]]
    encode = condition(lambda a: encoding.encode(vec.Vec3(*a), views), n)
    decode = condition(lambda a: encoding.decode(vector([*a, *signs]), views), given[:, : encoding.components])
    return n, view, codes, given, normals, encode, decode


def misses(encoding: Encoding, n: np.ndarray, codes: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Return how far each direction is from its decoded code, in float64; shape (count, 1)."""
    with jax.enable_x64(True):
        given = vector([jnp.asarray(c, jnp.float64) for c in codes.T])
        decoded = jax.jit(encoding.decode)(given, vec.Vec3(*jnp.asarray(view.T, jnp.float64)))
        return np.linalg.norm(n - rows(decoded), axis=1)[:, None]


def one_side(encoding: Encoding, side: int, given, by_jax, by_gl, conditions) -> Comparison:
    """Compare in units in the last place (of 1, or of the value if it is larger), divided by the map's condition."""
    ulps = np.abs(by_jax.astype(np.float64) - by_gl) / np.maximum(1.0, np.abs(by_jax)) / ULP
    apart = np.where(np.isfinite(ulps), ulps, np.inf).max(axis=1) / conditions
    what, details = f"{encoding.name}_{('encode', 'decode')[side]}", {"condition": conditions}
    allowed, reason = encoding.ulps[side], encoding.ulps_reason
    return Comparison(what, given, by_jax, by_gl, apart, allowed, reason, details=details)


def compared(gl, encoding: Encoding) -> list[Comparison]:
    # A precise variant has the maps of the encoding whose file it shares; how it rounds shows after storage.
    n, view, codes, given, normals, encode_condition, decode_condition = expected(ENCODINGS[encoding.prefix])
    gl_codes, gl_normals = exact_values(gl, encoding, widened(n), widened(view), widened(given))
    gl_codes = gl_codes[:, : codes.shape[1]]
    if encoding.searches:
        # Where two codes are as near, the languages may differ in which, but not in how near it is.
        codes, gl_codes = (misses(encoding, n, code, view) for code in (codes, gl_codes))
        encode_condition = np.ones(len(n))
    return [
        one_side(encoding, 0, n, codes, gl_codes, encode_condition),
        one_side(encoding, 1, given, normals, gl_normals[:, :3], decode_condition),
    ]


def guarded(gl, encoding: Encoding) -> list[Comparison]:
    """Check that zero, NaN and infinite vectors have the code of (0, 0, 1)."""
    n = np.float32(NOT_DIRECTIONS)
    # As many: a processor's wide and narrow instructions may round the same direction differently.
    forward = np.broadcast_to(np.float32([0, 0, 1]), n.shape)
    view = np.broadcast_to(np.float32([0.3, -0.2, -1.0]), n.shape)
    by_jax, forward_by_jax = codes_by_jax(encoding, n, view), codes_by_jax(encoding, forward, view)
    by_gl, forward_by_gl = (
        exact_values(gl, encoding, widened(given), widened(view), widened(by_jax))[0][:, : by_jax.shape[1]]
        for given in (n, forward)
    )
    pairs = (by_jax, forward_by_jax), (by_gl, forward_by_gl)
    are_forward = np.all([np.isfinite(codes) & (codes == wanted) for codes, wanted in pairs], axis=(0, 2))
    apart = np.where(are_forward, 0.0, np.inf)
    return [Comparison(f"{encoding.name}_encode", n, by_jax, by_gl, apart, 0.0, "what is no direction is forward")]


def step_of(codec: Codec, component: int, values: np.ndarray):
    """Return the distance between neighbouring codes. Near zero, half floats are finer than the languages' agreement
    before storage: there the step is the difference that the encoding allows."""
    storage, levels = codec.storage, codec.encoding.levels_of(component)
    if levels:
        return 2 / (levels - 1)
    if storage.is_biased and storage.kind == "float":
        texels = np.maximum(values.astype(np.float64) * 0.5 + 0.5, 2.0**-14)
        return 2 * 2.0 ** (np.floor(np.log2(texels)) - (storage.bits[component] - 5))
    if storage.kind == "float":
        spacing = np.spacing(np.abs(values).astype(np.float16)).astype(np.float64)
        return np.maximum(spacing, codec.encoding.ulps[0] * ULP)
    return (2 if storage.kind == "unorm" else 1) / storage.scale(component)


def stored(gl, codec: Codec, is_slow: bool) -> list[Comparison]:
    """Compare codes of 2^16 directions, or 2^18: 99.9% are equal at up to 12 bits, 97% at 16, and no two are more
    than a step apart.

    If precise rounding chooses another code, that code must be as good; an encoder that searches is tested for this
    before storage.
    """
    encoding, side = codec.encoding, 512 if is_slow else 256
    n, view = random_directions(side**2), view_positions(side**2)
    by_jax = rows(jax.jit(codec.stored)(vec.from_array(n), planes(vec.Vec3, view)))
    shape = (side, side, 4)
    with CodecPasses(gl, codec) as passes:
        by_gl = passes.round_trip(widened(n).reshape(shape), widened(view).reshape(shape)).codes.reshape(-1, 4)
    by_gl = by_gl[:, : by_jax.shape[1]]
    # Numbers read back differ by a unit where one language fuses 2 x - 1; codes are whole steps apart, or the same.
    steps = np.stack([np.broadcast_to(step_of(codec, i, c), c.shape) for i, c in enumerate(by_jax.T)], axis=1)
    apart = np.abs(by_jax - by_gl) / steps
    same, share = np.all(apart < 0.5, axis=1), 0.97 if codec.storage.bits[0] == 16 else 0.999
    if encoding.is_precise:
        apart = np.abs(np.subtract(*(misses(encoding, n, codes, view) for codes in (by_jax, by_gl)))) / (8 * ULP)
    # Less than one and a half.
    allowed = np.inf if encoding.searches else np.nextafter(1.5, 0)
    return [Comparison(codec.name, n, by_jax, by_gl, apart.max(axis=1), allowed, same=same, share=share)]


# Every encoding once, and every way to lay numbers across channels once.
FIRST = {codec.encoding.name: codec for codec in codecs(["rg16f", "rgb10a2", "rgba8"])}
PARITY = Parity(
    compared,
    guarded=guarded,
    codecs=[*FIRST.values(), *codecs(PACKED, names=["octahedral"])],
    more_codecs=[
        *codecs(["rgba8", "rgb10a2", "rg16f", "rg8_snorm", "rg16", "rg16_snorm", "r11g11b10f"]),
        *codecs(PACKED, names=ACROSS),
    ],
    stored=stored,
    # Whose comparison sees the shared functions that no other encoding of this list would notice.
    shared={
        "spherical": ["elementary.glsl"],
        "octahedral": ["vec.glsl:sign_not_zero"],
        "cryengine3": ["vec.glsl:unit(vec2"],
        "per_pixel_view": ["vec.glsl:unit(vec3"],
    },
)
