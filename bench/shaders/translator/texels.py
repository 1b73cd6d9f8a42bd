"""The contents of a program's lookup tables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Texels:
    """A lookup table, as a texture.

    Attributes:
        height, width, channels: its size.
        is_bytes: whether every number is a multiple of 1/255, so that 8 bits are enough; otherwise the numbers are
            32-bit floats.
    """

    height: int
    width: int
    channels: int
    is_bytes: bool = False

    @property
    def format(self) -> str:
        """The texture's DXGI format, such as R8G8_UNORM for bytes or R32G32_FLOAT for floats."""
        letters = "RGBA"[: self.channels]
        bits = 8 if self.is_bytes else 32
        return "".join(f"{letter}{bits}" for letter in letters) + ("_UNORM" if self.is_bytes else "_FLOAT")

    @property
    def bytes(self) -> int:
        """The size of all texels in bytes."""
        return self.height * self.width * self.channels * (1 if self.is_bytes else 4)
