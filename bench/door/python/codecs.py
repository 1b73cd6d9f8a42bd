"""Codecs for NumPy or JAX arrays of shape (..., 3).

The functions can be jitted and, except for rounding, which has no gradient, differentiated. The functions of a user's
shader file without a Python twin are run by OpenGL and can be neither jitted nor differentiated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.storage import ROUNDINGS, FloatForm, Storage
from ....encodings.vec import Vec2, Vec3, Vec4, from_array, to_array
from ....gbuffer.codecs.codec_passes import exact_values
from ....gbuffer.gl.device import device
from ...ground.output.errors import UsageError
from ...shaders.code.twin import has_twin
from ...subjects.codecs.names import codecs_named

# Where the view position is not given, the viewer looks along -z.
AHEAD = (0.0, 0.0, -1.0)
CODES = {2: Vec2, 3: Vec3, 4: Vec4}
NORMAL = 3


class Codes(NamedTuple):
    """The stored codes of normals.

    Attributes:
        values: the numbers that the texels represent, float32 of shape (..., components). `decode` takes them.
        integers: the stored integers, of the same shape; for floating-point storages, the bits of the floats.
    """

    values: Any
    integers: Any


def encoding(
    name: str,
    encode: Callable[[Vec3, Vec3], Any],
    decode: Callable[[Any, Vec3], Vec3],
    components: int = 2,
    domain: str = "sphere",
    glsl: Path | None = None,
) -> Encoding:
    """Return an encoding made from your own functions, for `Codec` and for every table.

    Args:
        name: the name in rows.
        encode: (n, view) -> Vec2 or Vec3 of numbers in [-1, 1]; `n` is a unit normal with n.x, n.y, n.z.
        decode: (code, view) -> Vec3.
        components: how many numbers are stored, 2 or 3.
        domain: the normals that the encoding can represent: "sphere", "hemisphere" (z >= 0) or "view".
        glsl: the file with the encoding's GLSL twin; without a twin, rows measured in GLSL state that it is missing.
    """
    if not name.isidentifier() or components not in CODES:
        raise UsageError(f"encoding {name!r}: the name must be an identifier, and components must be 2 or 3")
    if name in ENCODINGS:
        raise UsageError(f"encoding {name!r} already exists in the catalogue; choose another name")
    twin = glsl or Path(f"{name}.glsl")
    return Encoding(name, name, encode, decode, components, domain, "the caller's own", twin, (0, 0), "not compared")


def codec_of(codec: Codec | str) -> Codec:
    """Return a given codec, or the codec with a name, "encoding/storage" or "encoding/storage/rounding". An encoding
    may be a file.

    Raises:
        UsageError: no codec has this name.
        MissingError: a user's shader has no Python twin, and this machine has no OpenGL device.
    """
    if isinstance(codec, Codec):
        chosen_codec = codec
    else:
        before, _, last = codec.rpartition("/")
        before, rounding = (before, last) if last in ROUNDINGS else (codec, "nearest")
        name, _, storage = before.rpartition("/")
        if not (name and storage):
            raise UsageError(f'codec {codec!r}: name an encoding and a storage, such as "octahedral/rg8"')
        several = codecs_named((name,), (storage,), (rounding,))
        if len(several) != 1:
            raise UsageError(f"codec {codec!r} names {len(several)} codecs; name exactly one")
        (chosen_codec,) = several
    if chosen_codec.misfit:
        raise UsageError(f"{chosen_codec.name}: {chosen_codec.misfit}")
    return (
        chosen_codec
        if has_twin(chosen_codec.encoding)
        else replace(chosen_codec, encoding=_by_gl(chosen_codec.encoding))
    )


def _by_gl(encoding: Encoding) -> Encoding:
    """Return an encoding whose encoder and decoder take arrays and are run by OpenGL."""
    gl = device()

    def run(side: int, given: Any, view: Vec3) -> Any:
        shape = jnp.broadcast_shapes(*(jnp.shape(component) for component in (*given, *view)))
        rows, views = (_rows_of_four(vector, shape) for vector in (given, view))
        outputs = exact_values(gl, encoding, rows, views, rows)[side]
        size = NORMAL if side else encoding.components
        return CODES[size](*(jnp.asarray(outputs[:, i]).reshape(shape) for i in range(size)))

    return replace(encoding, encode=lambda n, view: run(0, n, view), decode=lambda code, view: run(1, code, view))


def _rows_of_four(vector: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return a vector of arrays, broadcast to a shape, as float32 of shape (count, 4), padded with zeros."""
    columns = [np.broadcast_to(np.asarray(component, np.float32), shape).ravel() for component in vector]
    return np.stack([*columns, *[np.zeros_like(columns[0])] * (4 - len(columns))], axis=1)


def encode(codec: Codec | str, normals: Any, view: Any = None) -> Codes:
    """Encode unit normals and store them.

    Args:
        codec: a Codec, or its name, such as "octahedral/rg8".
        normals: unit vectors in view space (z towards the viewer), shape (..., 3).
        view: view-space positions of the same shape, for encodings that need them; None for points on the -z axis.

    Returns:
        the stored numbers as `values` and the stored integers as `integers`, both of shape (..., components).

    Raises:
        UsageError: no codec has this name, or an array has the wrong shape.
    """
    chosen, n = codec_of(codec), _planes("normals", normals)
    stored = chosen.stored(n, _view_or_ahead(view, n))
    integers = [_integer(chosen, component, c) for component, c in enumerate(stored)]
    return Codes(jnp.stack(list(stored), axis=-1), jnp.stack(integers, axis=-1))


def decode(codec: Codec | str, codes: Any, view: Any = None) -> Any:
    """Return the normals that stored numbers decode to.

    Args:
        codes: the result of `encode`, or its `values`, shape (..., components).
        view: as for `encode`.

    Returns:
        float32 array of shape (..., 3), as the decoder returns it: not normalised again.

    Raises:
        UsageError: no codec has this name, or an array has the wrong shape.
    """
    chosen = codec_of(codec)
    values = jnp.asarray(codes.values if isinstance(codes, Codes) else codes)
    if jnp.issubdtype(values.dtype, jnp.integer):
        raise UsageError(f"codes have type {values.dtype}; decode takes the result of encode, or its values in [-1, 1]")
    values = values.astype(jnp.float32)
    size = chosen.encoding.components + chosen.encoding.sign_bits
    if values.ndim < 1 or values.shape[-1] != size:
        raise UsageError(f"codes have shape {values.shape}; {chosen.name} requires (..., {size})")
    code = CODES[size](*(values[..., i] for i in range(size)))
    return to_array(chosen.encoding.decode(code, _view_or_ahead(view, Vec3(code.x, code.x, code.x))))


def _planes(what: str, array: Any) -> Vec3:
    array = jnp.asarray(array, jnp.float32)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise UsageError(f"{what} have shape {array.shape}; expected (..., 3)")
    return from_array(array)


def _view_or_ahead(view: Any, like: Vec3) -> Vec3:
    if view is not None:
        return _planes("view positions", view)
    return Vec3(*(jnp.full_like(like.x, component) for component in AHEAD))


def _integer(codec: Codec, component: int, number: Any) -> Any:
    """Return the integer, uint32, that a texel stores for a number in one component of a codec."""
    storage: Storage = codec.storage
    if component >= codec.encoding.components:
        return (number > 0).astype(jnp.uint32)
    number = number * 0.5 + 0.5 if storage.is_biased else number
    if storage.kind == "float":
        return _float_integer(storage.float_form(component), number)
    scale = storage.scale(component)
    if storage.kind == "unorm":
        return jnp.rint(number * scale).astype(jnp.uint32)
    signed = jnp.rint(number * scale).astype(jnp.int32)
    # Laid across channels, -1 is the integer 0; else it is two's complement.
    return signed.astype(jnp.uint32) + scale if storage.is_packed else signed.astype(jnp.uint32)


def _float_integer(form: FloatForm, number: Any) -> Any:
    """Return the bits, uint32, of float32 numbers of any shape in a storage's floating-point format."""
    magnitude = abs(number)
    word = jax.lax.bitcast_convert_type(magnitude, jnp.uint32)
    integer = (word >> (23 - form.mantissa)) - jnp.uint32((127 - form.one) << form.mantissa)
    if form.exponent < 8:
        steps = (magnitude * 2.0 ** (form.one - 1 + form.mantissa)).astype(jnp.uint32)
        integer = jnp.where(magnitude < 2.0 ** (1 - form.one), steps, integer)
    endless = jnp.uint32((2**form.exponent - 1) << form.mantissa)
    integer = jnp.where(jnp.isinf(number), endless, integer)
    integer = jnp.where(jnp.isnan(number), endless + jnp.uint32(2 ** (form.mantissa - 1)), integer)
    sign = jnp.signbit(number).astype(jnp.uint32) << (form.bits - 1)
    return integer | sign if form.is_signed else integer
