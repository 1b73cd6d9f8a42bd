"""What GLSL has and NumPy has not: functions of a file's own. Vectors are the last axis of an array."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

# By name; each is written where the file or another one needs it.
HELPERS: Mapping[str, str] = MappingProxyType(
    {
        "_parts": '''def _parts(v):
    """The components of vectors: arrays without the last axis."""
    return np.moveaxis(v, -1, 0)''',
        "_vector": '''def _vector(*parts):
    """Vectors of components."""
    return np.stack(np.broadcast_arrays(*parts), axis=-1)''',
        "_splat": '''def _splat(x, size):
    """Vectors whose components are all x."""
    return np.stack([x] * size, axis=-1)''',
        "_matrix": '''def _matrix(size, *parts):
    """Matrices of components, column by column: the last axis is a row of a column."""
    m = _vector(*parts)
    return m.reshape(*m.shape[:-1], size, size)''',
        "_array": '''def _array(axes, *values):
    """Arrays of vectors or matrices, whose own axes follow the one that counts them."""
    return np.stack(np.broadcast_arrays(*values), axis=-1 - axes)''',
        "_replaced": '''def _replaced(v, places, value):
    """Vectors with other components at some places."""
    parts = [*np.moveaxis(v, -1, 0)]
    for at, part in zip(places, [value] if len(places) == 1 else np.moveaxis(value, -1, 0)):
        parts[at] = part
    return _vector(*parts)''',
        "_at": '''def _at(a, i, inner=0):
    """Of each array the element i, the nearest where it has none; `inner` axes follow the one that counts elements."""
    first = np.moveaxis(a, -1 - inner, 0)
    i = np.clip(np.asarray(i, np.int32), 0, len(first) - 1)
    if first.ndim == 1 + inner:
        return first[i]
    value = first[0]
    for k in range(1, len(first)):
        value = np.where((i == k)[(..., *[None] * inner)], first[k], value)
    return value''',
        "_put": '''def _put(a, i, value, inner=0):
    """Arrays with another element i, the nearest where they have none."""
    first = np.moveaxis(a, -1 - inner, 0)
    i = np.clip(np.asarray(i, np.int32), 0, len(first) - 1)
    made = [np.where((i == k)[(..., *[None] * inner)], value, element) for k, element in enumerate(first)]
    return np.stack(np.broadcast_arrays(*made), axis=-1 - inner)''',
        "_to_int": '''def _to_int(x):
    """Floats without their fractions: what is no number is 0, and what is out of range the nearest integer."""
    return np.clip(np.nan_to_num(x.astype(np.float64), nan=0.0), -(2.0**31), 2.0**31 - 1).astype(np.int32)''',
        "_to_uint": '''def _to_uint(x):
    """Floats without their fractions: what is no number is 0, and what is out of range the nearest integer."""
    return np.clip(np.nan_to_num(x.astype(np.float64), nan=0.0), 0.0, 2.0**32 - 1).astype(np.uint32)''',
        "_quotient": '''def _quotient(a, b):
    """Whole numbers divided toward zero; a / 0 is a."""
    whole = np.asarray(a, np.int64)
    divisor = np.where(b == 0, np.int64(1), b)
    return (np.sign(whole) * np.sign(divisor) * (np.abs(whole) // np.abs(divisor))).astype(a.dtype)''',
        "_remainder": '''def _remainder(a, b):
    """What a division toward zero leaves, with the sign of a; a % 0 is 0."""
    return np.where(b == 0, 0, a - _quotient(a, b) * b).astype(a.dtype)''',
        "_fma": '''def _fma(a, b, c):
    """a b + c, rounded once."""
    return (np.asarray(a, np.float64) * b + c).astype(np.float32)''',
        "_clamp": '''def _clamp(x, low, high):
    """Numbers from low to high; what is no number is low."""
    return np.fmin(np.fmax(x, low), high)''',
        "_fract": '''def _fract(x):
    """The fraction."""
    return x - np.floor(x)''',
        "_mix": '''def _mix(a, b, t):
    """From a to b by t."""
    return a * (1.0 - t) + b * t''',
        "_step": '''def _step(edge, x):
    """0 below the edge, else 1."""
    return np.where(x < edge, np.float32(0.0), np.float32(1.0))''',
        "_smoothstep": '''def _smoothstep(low, high, x):
    """From 0 at low to 1 at high, level at both."""
    t = np.fmin(np.fmax((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)''',
        "_dot": '''def _dot(a, b):
    """Scalar products, summed in order."""
    first, *others = np.moveaxis(a * b, -1, 0)
    for product in others:
        first = first + product
    return first''',
        "_length": '''def _length(v):
    """Lengths of vectors."""
    return np.sqrt(_dot(v, v))''',
        "_distance": '''def _distance(a, b):
    """Lengths of differences."""
    return _length(a - b)''',
        "_normalize": '''def _normalize(v):
    """Vectors of length 1."""
    return v * (1.0 / np.sqrt(_dot(v, v)))[..., None]''',
        "_cross": '''def _cross(a, b):
    """Vector products."""
    turned, back = [1, 2, 0], [2, 0, 1]
    return a[..., turned] * b[..., back] - a[..., back] * b[..., turned]''',
        "_reflect": '''def _reflect(incident, n):
    """Directions reflected by planes of normals n."""
    return incident - (2.0 * _dot(n, incident))[..., None] * n''',
        "_times": '''def _times(m, v):
    """Matrices times vectors: sums of columns, in order."""
    first, *others = np.moveaxis(m * v[..., :, None], -2, 0)
    for column in others:
        first = first + column
    return first''',
        "_product": '''def _product(a, b):
    """Products of matrices."""
    return np.stack([_times(a, b[..., at, :]) for at in range(b.shape[-2])], axis=-2)''',
        "_fetched": '''def _fetched(table, place):
    """Texels of a table, four numbers each."""
    height, width, channels = table.shape
    x, y = np.clip(place[..., 0], 0, width - 1), np.clip(place[..., 1], 0, height - 1)
    texels = table[y, x]
    return np.concatenate([texels, np.zeros((*texels.shape[:-1], 4 - channels), np.float32)], axis=-1)''',
    }
)


def needed(helpers: Iterable[str]) -> list[str]:
    """Helpers and those that they call, in an order in which each calls only those before it."""
    found = {*helpers}
    for name in reversed([*HELPERS]):
        if name in found:
            found |= HELPERS.keys() & set(re.findall(r"\b_\w+(?=\()", HELPERS[name]))
    return [name for name in HELPERS if name in found]
