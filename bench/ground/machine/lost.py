"""Check for a lost OpenGL device. Imports nothing heavy, so that a table that draws nothing opens no device."""

from __future__ import annotations

from ....gbuffer.gl.opened import OPENED
from ..output.errors import MissingError


def require_living_device() -> None:
    """Raise MissingError if an open OpenGL device no longer responds, because its last results are not valid."""
    for gl in OPENED:
        if not gl.answers:
            raise MissingError(f"{gl.renderer} was lost by its driver and no longer draws; run the same command again")
