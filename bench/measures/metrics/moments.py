"""The fewest statistics that say anything: the squared error and its maximum."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from ....encodings.codecs.codec import Codec
from ....encodings.vec import Vec3, dot

FAST_BLOCK = 2**15
LANES = 256


def squared_errors(codec: Codec):
    """The fastest path: squared error alone, over normals in memory.

    Returns:
        a function of (n, view), planes of a multiple of FAST_BLOCK float32 normals, that gives the sum and the largest
        of |n - n'|^2, float64. One call is one core's work; run shards side by side.
    """

    def scan(n: Vec3, view: Vec3):
        def step(carry, block):
            total, largest = carry
            difference = block[0] - codec.round_trip(*block)
            squared = jax.lax.optimization_barrier(dot(difference, difference))
            return (total + squared.sum(0).astype(jnp.float64), jnp.maximum(largest, squared.max(0))), None

        blocks = jax.tree.map(lambda a: a.reshape(-1, FAST_BLOCK // LANES, LANES), (n, view))
        start = (jnp.zeros(LANES, jnp.float64), jnp.zeros(LANES, jnp.float32))
        (total, largest), _ = jax.lax.scan(step, start, blocks)
        return total.sum(), largest.max().astype(jnp.float64)

    call = jax.jit(scan)

    def run(n: Vec3, view: Vec3) -> tuple[float, float]:
        with jax.enable_x64(True):
            total, largest = call(n, view)
            return float(total), float(largest)

    return run
