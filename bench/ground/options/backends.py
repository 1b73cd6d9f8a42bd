"""Back ends as they are named: those that a table has, of all that there are."""

from __future__ import annotations

from collections.abc import Collection

from ..choose import choose
from ..output.errors import UsageError, leave_out

BACKENDS = ("jax", "glsl", "wgsl")


def backends_named(names: str, has: Collection[str]) -> list[str]:
    """The back ends of comma-separated names that a table has; the others are named on standard error.

    Raises:
        UsageError: an unknown name, or none that the table has.
    """
    if names == "all":
        return list(has)
    picked = choose("back end", names, dict(zip(BACKENDS, BACKENDS, strict=True)))
    found, lacking = [name for name in picked if name in has], [name for name in picked if name not in has]
    said = f"{', '.join(lacking)}: this table measures by {' and '.join(has)}"
    if not found:
        raise UsageError(said)
    if lacking:
        leave_out(said)
    return found
