"""The GL device that this process opened. Imports nothing: who asks need not open one."""

from __future__ import annotations

from typing import Protocol


class Opened(Protocol):
    """The properties of the device that others may query."""

    renderer: str

    @property
    def answers(self) -> bool:
        """Whether the device still works."""
        ...


OPENED: list[Opened] = []
