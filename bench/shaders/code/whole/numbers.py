"""A number of a layout, as written to a channel or to bits and as read back: `words.glsl` for one word."""

from __future__ import annotations

from dataclasses import dataclass

from .....encodings.storages.storage import ROUNDINGS
from .....gbuffer.codecs.codec_passes import levels_of, storage_kind
from .....gbuffer.gl.shader import glsl_value
from .....gbuffer.layouts.layout import Layout
from .....gbuffer.layouts.words import OTHER, PACKINGS, SIGNED, Word, least_carried
from .surface import WHOLE_NUMBERS

# Floats of 32 bits have all whole numbers up to this many bits and a half.
SURE_BITS = 22
UNORM, SNORM, HALF, SMALL = range(4)


def ways_of(layout: Layout) -> tuple[int, ...]:
    """Return the rounding of each target: 0 if its format rounds, else one more than the rounding's number in
    `storage.glsl`."""
    homes = {word.target for word in layout.words if word.component.startswith("normal.")}
    way = 0 if layout.rounding == "nearest" else ROUNDINGS.index(layout.rounding) + 1
    plain = (target.storage.is_integer or target.storage.curved for target in layout.targets)
    return tuple(0 if is_plain else way * (i in homes) for i, is_plain in enumerate(plain))


@dataclass(frozen=True)
class Number:
    """A word of a layout, as GLSL text."""

    layout: Layout
    word: Word

    @property
    def _storage(self):
        return self.layout.targets[self.word.target].storage

    @property
    def _is_normal(self) -> bool:
        return self.word.component.startswith("normal.")

    @property
    def _is_unit(self) -> bool:
        """Whether the word is a number of the normal in [0, 1], whatever the format of its texels."""
        return self._is_normal and self.layout.encoding.is_unit

    @property
    def _is_signed(self) -> bool:
        return self.word.component.startswith("motion.") or (self._is_normal and not self.layout.encoding.is_unit)

    @property
    def is_whole(self) -> bool:
        """Whether the word is a whole number of the surface."""
        return self.word.component in (*WHOLE_NUMBERS, OTHER)

    @property
    def is_depth(self) -> bool:
        return self.word.component == "depth"

    @property
    def is_open(self) -> bool:
        """Whether numbers above 1 keep their value in the word."""
        return not self.word.bits and storage_kind(self._storage) >= HALF

    @property
    def _is_signed_depth(self) -> str:
        return "true" if self.layout.depth_encoding.signed else "false"

    @property
    def is_carrier(self) -> bool:
        """Whether the word's sign holds a number of the normal's code; signed depths do not count."""
        return bool(self.word.sign) and not self.is_depth

    @property
    def _carries_in_half(self) -> bool:
        """Whether the format stores a signed number x as x/2 + 1/2."""
        return bool(self.word.bits) or storage_kind(self._storage) in (UNORM, SMALL)

    def carried_text(self, x: str, sign: str) -> str:
        """Return the GLSL expression for a share `x`, in [0, 1], with the sign of `sign`, as stored in texels. The
        share is kept above 0, so that rounding preserves the sign."""
        bits = self.word.bits_in(self._storage)
        least = glsl_value(least_carried(self._storage, bits))
        number = f"sign_not_zero({sign}) * clamp({x}, {least}, 1.0)"
        return f"{number} * 0.5 + 0.5" if self._carries_in_half else number

    @property
    def _is_packed_as_said(self) -> bool:
        """Whether the layout's packing applies to this number: a number of the normal that takes many values."""
        return self._is_normal and levels_of(self.layout.encoding)["xyz".index(self.word.component[-1])] == 0

    @property
    def _is_around_zero(self) -> bool:
        is_signed = self._is_packed_as_said and self.layout.packing == SIGNED
        return self.word.component.startswith("motion.") or is_signed

    @property
    def _scale(self) -> int:
        return 2**self.word.bits - 1 if self.word.bits else self._storage.scale(self.word.first)

    @property
    def _unit_in(self) -> str:
        return "{x} * 0.5 + 0.5" if self._is_signed or self._is_unit else "{x}"

    @property
    def _unit_out(self) -> str:
        return "{x} * 2.0 - 1.0" if self._is_signed or self._is_unit else "{x}"

    def bits_text(self, x: str) -> str:
        """Return the GLSL expression for the unsigned integer that stores the number with the expression `x`."""
        scale = self._scale
        if self.is_whole:
            return f"{x} & {scale}u"
        if self.is_depth:
            return f"fixed_code({x}, {scale}.0, {self._is_signed_depth})"
        if self.is_carrier:
            return f"uint(floor({x} * {scale}.0 + 0.5))"
        if self._is_around_zero:
            half = f"{scale // 2}.0"
            held = f"{x} * 0.5 + 0.5" if self._is_unit else x
            return f"uint(roundEven(clamp({held}, -1.0, 1.0) * {half}) + {half})"
        widen, bias = PACKINGS[self.layout.packing] if self._is_packed_as_said else PACKINGS["nearest"]
        part = f"clamp({self._unit_in.format(x=x)}, 0.0, 1.0)"
        whole = f"floor({part} * {scale + widen}{f' + {bias}' if bias else ''})"
        return f"uint({whole if self.word.bits <= SURE_BITS else f'min({whole}, {scale}.0)'})"

    def bits_value(self, integer: str) -> str:
        """Return the GLSL expression for the number that an unsigned integer stands for, from the integer's name."""
        if self.is_whole:
            return integer
        if self.is_depth:
            return f"from_fixed_code({integer}, {self._scale}.0, {self._is_signed_depth})"
        if self.is_carrier:
            return f"float({integer}) / {self._scale}.0 * 2.0 - 1.0"
        if self._is_around_zero:
            half = f"{self._scale // 2}.0"
            value = f"(float({integer}) - {half}) * (1.0 / {half})"
            return f"{value} * 2.0 - 1.0" if self._is_unit else value
        return self._unit_out.format(x=f"float({integer}) / {self._scale}.0")

    def channel_text(self, x: str, is_float: bool = False) -> str:
        """Return the GLSL expression that is written for the number `x` to a channel of its own. The format converts
        the number, or the expression rounds it first."""
        way = ways_of(self.layout)[self.word.target]
        return self._rounded_text(self._plain_text(x, is_float), way - 1) if way else self._plain_text(x, is_float)

    def _rounded_text(self, x: str, way: int) -> str:
        """Return the GLSL expression for the number `x` rounded to a value of the format; `x` itself for 32-bit
        floats. `way` is the number of the rounding in `storage.glsl`."""
        kind, bits = storage_kind(self._storage), self._storage.bits[self.word.first]
        if kind in (HALF, SMALL):
            form = "5, 10, true" if kind == HALF else f"5, {bits - 5}, false"
            return f"round_float({x}, {form}, {'true' if way else 'false'})"
        least = "0.0" if kind == UNORM else "-1.0"
        whole = f"round_whole(clamp({x}, {least}, 1.0), {self._scale}.0, {way}) / {self._scale}.0"
        return whole if kind in (UNORM, SNORM) else x

    def _plain_text(self, x: str, is_float: bool) -> str:
        kind = storage_kind(self._storage)
        if self.is_depth and self.layout.depth_encoding.signed and kind < HALF:
            return f"float(fixed_code({x}, {self._scale}.0, true)) / {self._scale}.0"
        if self.is_whole and not is_float:
            return f"float({x} & {self._scale}u) / {self._scale}.0" if kind in (UNORM, SNORM) else f"float({x})"
        is_halved = self._is_unit or (self._is_signed and kind in (UNORM, SMALL))
        return f"{x} * 0.5 + 0.5" if is_halved else x

    def channel_value(self, x: str, is_float: bool = False) -> str:
        """Return the GLSL expression for the number stored in a channel of its own, from the channel's value `x`."""
        kind = storage_kind(self._storage)
        if self.is_depth and self.layout.depth_encoding.signed and kind < HALF:
            return f"from_fixed_code(uint({x} * {self._scale}.0 + 0.5), {self._scale}.0, true)"
        if self.is_carrier:
            return f"{x} * 2.0 - 1.0" if self._carries_in_half else x
        if self.is_whole and not is_float:
            return f"uint({x} * {self._scale}.0 + 0.5)" if kind in (UNORM, SNORM) else f"uint({x} + 0.5)"
        is_halved = self._is_unit or (self._is_signed and kind in (UNORM, SMALL))
        return f"{x} * 2.0 - 1.0" if is_halved else x
