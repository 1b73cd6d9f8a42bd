"""Light codecs, the formats of light buffers: a light encoding and its storage."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..storages.rounding import store_texel
from ..storages.rules import of_count
from ..storages.storage import Storage
from ..vec import Vec4
from .light_encoding import LightEncoding

COLOURS = 3


@dataclass(frozen=True)
class LightCodec:
    """A light encoding and the storage for its texels."""

    encoding: LightEncoding
    storage: Storage

    def __post_init__(self) -> None:
        object.__setattr__(self, "storage", of_count(self.storage, 4))

    @property
    def name(self) -> str:
        """The name of the encoding in this format; the format's own name if a texel is the light itself."""
        return self.storage.name if self.encoding.is_plain else self._named[0]

    @property
    def _named(self) -> tuple[str, str]:
        """The name and the title of the encoding in this format."""
        if self.storage.curved:
            return self.encoding.in_curve
        if self.storage.name in self.encoding.storages:
            return self.encoding.name, self.encoding.title
        name = self.encoding.name
        return f"{name}/{self.storage.name}", f"{name.partition(':')[0]} to {self.limit:g} in {self.storage.title}"

    @property
    def title(self) -> str:
        """The human-readable name."""
        lacks = "" if self.has_alpha else ", no fourth channel"
        return f"{self.storage.title}{lacks}" if self.encoding.is_plain else self._named[1]

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's texel; None if it can."""
        encoding, storage = self.encoding, self.storage
        if storage.name in encoding.storages:
            return None
        if encoding.any_bits != storage.kind:
            more = f", and {encoding.any_bits} of any bits" if encoding.any_bits else ""
            return f"{encoding.name} is made for {', '.join(encoding.storages)}{more}"
        return None if storage.channels >= COLOURS else f"{storage.title}: light has {COLOURS} or four components"

    @property
    def bits(self) -> int:
        """The bits of a texel."""
        return sum(self.storage.bits)

    @property
    def codes(self) -> int:
        """The number of possible texels, used or not."""
        return 2**self.bits

    @property
    def bytes_per_pixel(self) -> int:
        """The bytes per pixel of one target, or of two copies if the code is read while it is written."""
        return self.storage.texel_bytes * (2 if self.blend == "read" else 1)

    @property
    def has_alpha(self) -> bool:
        """Whether it holds a fourth number."""
        return self.encoding.has_alpha and self.storage.channels == 4

    @property
    def limit(self) -> float:
        """The brightest white light that the codec can store."""
        return self.storage.largest if self.encoding.is_plain else self.encoding.limit

    @property
    def blend(self) -> str:
        """The method of adding light, one of light_encoding.BLENDS. Numbers across channels cannot be blended."""
        return "read" if self.storage.is_packed else self.encoding.blend

    @property
    def no_light(self) -> float:
        """The value of every channel of a texel without light."""
        return self.encoding.no_light

    @property
    def glsl(self) -> Path:
        """The path of the encoding's GLSL file."""
        return self.encoding.glsl

    def encode(self, light: Vec4) -> Vec4:
        """Return the texel for light (not negative, finite, any shape), before the format stores it."""
        return self.encoding.encode(light)

    def store(self, texel: Vec4, rounding: str = "nearest") -> Vec4:
        """Return a texel (any shape) as the format returns it; 0 in a channel that the format lacks."""
        storage = self.storage
        return Vec4(
            *(store_texel(c, storage, i, rounding) if i < storage.channels else 0.0 * c for i, c in enumerate(texel))
        )

    def decode(self, texel: Vec4) -> Vec4:
        """Return the light in a texel that the format has returned; the fourth number is 0 if the format lacks it."""
        light = self.encoding.decode(texel)
        return light if self.storage.channels == 4 else Vec4(light.x, light.y, light.z, light.x * 0.0)

    def stored(self, light: Vec4) -> Vec4:
        """Encode light and return the texel as the format returns it, not yet decoded."""
        return self.store(self.encode(light))

    def round_trip(self, light: Vec4) -> Vec4:
        """Light encoded, stored and decoded."""
        return self.decode(self.stored(light))
