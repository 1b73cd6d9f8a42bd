"""Built-in functions that every shading language has, by their GLSL names, and the types of their results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from .tree import scalar_of, size_of, vector

# Those that give what their largest argument is.
LIKE_GIVEN = frozenset(
    (
        *("abs", "sign", "floor", "ceil", "fract", "trunc", "round", "roundEven", "sqrt", "inversesqrt", "normalize"),
        *("min", "max", "clamp", "mix", "step", "smoothstep", "pow", "exp", "exp2", "log", "log2", "fma"),
        *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "reflect"),
    )
)
# Those that have no whole numbers: GLSL makes floats of what they are given.
OF_FLOATS = LIKE_GIVEN - {"abs", "sign", "min", "max", "clamp"} | {"dot", "length", "distance", "cross"}
OF_VECTORS = frozenset(("dot", "length", "distance"))
BITS: Mapping[str, str] = MappingProxyType(
    {"floatBitsToInt": "int", "floatBitsToUint": "uint", "intBitsToFloat": "float", "uintBitsToFloat": "float"}
)
FETCH = "texelFetch"


def result_of(name: str, given: Sequence[str]) -> str | None:
    """Return the type of a built-in function's result for arguments of these types; None for an unknown name."""
    if name in LIKE_GIVEN:
        size = max(map(size_of, given))
        return vector(scalar_of(given[0]), size)
    if name in OF_VECTORS:
        return "float"
    if name == "cross":
        return "vec3"
    if name == "transpose":
        return given[0] if given[0].startswith("mat") else None
    if name in ("any", "all"):
        return "bool"
    if name in BITS:
        return vector(BITS[name], size_of(given[0]))
    return "vec4" if name == FETCH else None
