"""Backends by name, and the choice of those that a table supports."""

from __future__ import annotations

from collections.abc import Collection

from ...ground.choose import choose
from ...ground.options.words import Names
from ...ground.output.errors import UsageError, leave_out

BACKENDS = ("jax", "glsl", "wgsl")


def backends_named(names: Names, has: Collection[str]) -> list[str]:
    """Return the back ends that names stand for and that a table has, or all that it has for "all". Others are named
    on standard error.

    Raises:
        UsageError: an unknown name, or none that the table has.
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
        UsageError: as `backends_named`.
        MissingError: JAX is broken, or only GLSL is requested and there is no OpenGL device.
    """
    # It imports JAX, which charts that name back ends do not need.
    from ...ground.machine.devices import require_device, require_jax

    backends = backends_named(names, has)
    require_jax()
    if backends == ["glsl"]:
        require_device()
    return backends
