"""Whether an encoding exists in JAX, as a twin of its GLSL."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from ....encodings.catalogue import is_in_catalogue
from ....encodings.codecs.encoding import Encoding
from ....encodings.vec import Vec3


class NoTwinError(Exception):
    """Raised for an encoding that exists only in GLSL."""


def lacking_twin(reason: str) -> Callable[..., Any]:
    """Return a function that raises NoTwinError with a reason, in place of an encoder or a decoder without a twin."""

    def lacking(*_: Any) -> Any:
        raise NoTwinError(reason)

    return lacking


@cache
def has_twin(encoding: Encoding) -> bool:
    """Whether an encoding exists in JAX, and not only in GLSL."""
    # Tracing takes a tenth of a second, and those of the catalogue all have one.
    if is_in_catalogue(encoding):
        return True
    # It takes a second to import, which whoever measures nothing need not wait for.
    import jax
    import jax.numpy as jnp

    n = Vec3(*[jax.ShapeDtypeStruct((1,), jnp.float32)] * 3)
    try:
        jax.eval_shape(encoding.encode, n, n)
    except NoTwinError:
        return False
    return True
