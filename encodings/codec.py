"""A codec: an encoding and the storage its numbers go through. It is what is measured."""

from __future__ import annotations

from dataclasses import dataclass

from .encoding import Encoding
from .storage import Storage, store_number
from .vec import Vec3


@dataclass(frozen=True)
class Codec:
    """An encoding, the storage of its components, and how that rounds: "nearest" or "truncate"."""

    encoding: Encoding
    storage: Storage
    rounding: str = "nearest"

    @property
    def name(self) -> str:
        return f"{self.encoding.name}/{self.storage.name}" + ("/truncate" if self.rounding == "truncate" else "")

    @property
    def fits(self) -> bool:
        """Whether the storage has a channel for each component. Sign bits are kept beside it, in the depth's sign."""
        return self.encoding.components <= self.storage.channels

    @property
    def bits(self) -> int:
        """The bits it occupies: of the channels used, and one for each sign bit."""
        return sum(self.storage.bits[: self.encoding.components]) + self.encoding.sign_bits

    def store(self, code):
        """A code (Vec2 or Vec3) as it comes back from the storage. A sign bit comes back as it was."""
        stored = (
            store_number(c, self.storage, i, self.rounding) if i < self.encoding.components else c
            for i, c in enumerate(code)
        )
        return type(code)(*stored)

    def round_trip(self, n: Vec3, view: Vec3) -> Vec3:
        """Unit normals (any shape, as `from_array` makes them) encoded, stored and decoded; not renormalised."""
        return self.encoding.decode(self.store(self.encoding.encode(n, view)), view)
