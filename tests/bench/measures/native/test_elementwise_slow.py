"""JAX functions in C: the results of each operation, bit for bit, and functions that cannot be written in C."""

import jax
import jax.numpy as jnp

from normalbench.bench.ground.native.elementwise import INFIX, OTHERS
from normalbench.encodings.catalogue import ENCODINGS


def test_every_operation_but_two_is_used():
    """The other operations are used by encodings of the catalogue, by the error metrics or by sets of normals."""
    from normalbench.bench.measures.native import meter
    from normalbench.bench.subjects.normals import normal_sets

    seen: set[str] = set()

    def note(jaxpr):
        for equation in jaxpr.eqns:
            seen.add(equation.primitive.name)
            for inner in equation.params.values():
                if hasattr(inner, "jaxpr"):
                    note(inner.jaxpr)

    ones = jnp.ones(4, jnp.float32)
    three = meter.Vec3(ones, ones, ones)
    for encoding in ENCODINGS.values():
        note(jax.make_jaxpr(lambda n, e=encoding: e.decode(e.encode(n, n), n))(three).jaxpr)
    note(jax.make_jaxpr(lambda n: meter.errors(n, n, True))(three).jaxpr)
    note(jax.make_jaxpr(lambda a: meter.bins_of(a, True))(ones).jaxpr)
    words = jnp.ones(4, jnp.uint32)
    with jax.enable_x64(True):
        note(jax.make_jaxpr(lambda w: normal_sets._direction(w, w, w, w, whole=True))(words).jaxpr)
    assert {*INFIX, *OTHERS} - seen <= {"le", "shift_right_arithmetic"}, {*INFIX, *OTHERS} - seen
