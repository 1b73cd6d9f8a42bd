"""Backends by name, and the choice of backends that a table supports."""

from __future__ import annotations

from collections.abc import Collection

from ...ground.choose import choose
from ...ground.options.words import Names
from ...ground.output.errors import UsageError, leave_out

BACKENDS = ("jax", "glsl", "wgsl")


def backends_named(names: Names, has: Collection[str]) -> list[str]:
    """Return the named backends that a table supports, or all of them for "all". Unsupported backends are reported on
    standard error.

    Raises:
        UsageError: a name is unknown, or the table supports no named backend.
    """
    if "all" in names:
        return list(has)
    picked = choose("backend", names, dict(zip(BACKENDS, BACKENDS, strict=True)))
    available, lacking = [name for name in picked if name in has], [name for name in picked if name not in has]
    message = f"{', '.join(lacking)}: this table measures only with {' and '.join(has)}"
    if not available:
        raise UsageError(message)
    if lacking:
        leave_out(message)
    return available


def backends_here(names: Names, has: Collection[str]) -> list[str]:
    """Return the named backends that a table supports, after a check of this machine.

    Raises:
        UsageError: the same errors as in `backends_named`.
        MissingError: JAX is broken, or only GLSL is requested and no OpenGL device is available.
    """
    # It imports JAX, which charts that name back ends do not need.
    from ...ground.machine.devices import require_device, require_jax

    backends = backends_named(names, has)
    require_jax()
    if backends == ["glsl"]:
        require_device()
    return backends
