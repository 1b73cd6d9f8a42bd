"""The OpenGL device that this process opened. Imports no OpenGL code, so that checking it does not open a device."""

from __future__ import annotations

from typing import Protocol


class Opened(Protocol):
    """The properties of the device that other modules may query."""

    renderer: str

    @property
    def answers(self) -> bool:
        """Whether the device still works."""
        ...


OPENED: list[Opened] = []
