"""Whether the GL device of this process was lost. Imports nothing heavy: a table that draws nothing opens none."""

from __future__ import annotations

from ....gbuffer.gl.opened import OPENED
from ..output.errors import MissingError


def require_living_device() -> None:
    """Raise MissingError if an open OpenGL device no longer answers, because its last results are not valid figures."""
    for gl in OPENED:
        if not gl.answers:
            raise MissingError(f"{gl.renderer} was lost by its driver and no longer draws; run the same command again")
