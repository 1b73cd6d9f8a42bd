"""Codes within the range of their patch: each number is stored between the least and the largest of its neighbours'.

A patch is some normals that follow each other: vertices of a mesh in its order, or pixels row after row; pixels without
a surface have codes as well. Its two bounds for each number are stored next to it, in 16 bits each, rounded away from
the codes.
"""

from __future__ import annotations

from typing import Any

from ..vec import jnp, maximum, minimum, select

BOUND_BITS = 16
# The integer that stands for 1 in a signed bound.
SCALE = 2.0 ** (BOUND_BITS - 1) - 1.0


def bits_of_bounds(components: int, patch: int, count: int) -> float:
    """The bits of all patches' bounds for each of so many normals; the last patch may be a part."""
    return 2.0 * components * BOUND_BITS * -(-count // patch) / count


def bounds(c: Any, patch: int) -> tuple[Any, Any]:
    """The least and the largest number of each patch as they are stored, float of the shape of c.

    Args:
        c: numbers in [-1, 1], shape (count,) of whole patches; what is not finite does not count.
    """
    held = c.reshape(-1, patch)
    is_number = jnp.isfinite(held)
    low = jnp.floor(jnp.min(select(is_number, held, 1.0), axis=1) * SCALE)
    high = jnp.ceil(jnp.max(select(is_number, held, -1.0), axis=1) * SCALE)
    high = maximum(high, low + 1.0)
    return jnp.repeat(low * (1.0 / SCALE), patch), jnp.repeat(high * (1.0 / SCALE), patch)


def within(c: Any, low: Any, high: Any) -> Any:
    """Numbers between their bounds as numbers in [-1, 1]."""
    return minimum(maximum((c - low) / (high - low) * 2.0 - 1.0, -1.0), 1.0)


def back(e: Any, low: Any, high: Any) -> Any:
    """The numbers again that are `within` their bounds."""
    return low + (e * 0.5 + 0.5) * (high - low)
