"""An encoding's operations in 16-bit types, for compilers to report their cost."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .....encodings.codecs.encoding import Encoding
from .....gbuffer.codecs.codec_passes import encoding_defines
from .....gbuffer.defines.kernels import Operation
from .....gbuffer.gl.shader import ShaderError, Source
from .source import HalfSource

HERE = Path(__file__).parent
# Macros of the kernels around the operation, whose numbers are of 32 bits.
KERNELS = ("GIVEN", "BESIDE", "MADE")


@dataclass(frozen=True, eq=False)
class HalfOperation(Operation):
    """A 16-bit operation with 32-bit inputs and outputs; the empty operation only converts the same numbers."""

    @property
    def empty(self) -> Operation:
        return HalfOperation(HERE / "kernel_half_empty.glsl", self.given, self.beside, self.made)

    @property
    def defines(self) -> dict[str, object]:
        halves = {f"HALF_{name}": f"f16vec{size}" for name, size in (("GIVEN", self.given), ("BESIDE", self.beside))}
        return super().defines | halves

    def source(self, shader: str) -> Source:
        return HalfSource(shader, self.defines, self.names, KERNELS)


def half_operation(encoding: Encoding, operation: str) -> Operation:
    """Return an encoding's "encode" or "decode" as an operation in 16-bit types. Raises ShaderError like
    `encoding_defines`, and if the encoding uses precise rounding."""
    if encoding.is_precise:
        raise ShaderError(f"{encoding.name}: precise rounding is not counted in half arithmetic")
    size = encoding.components + encoding.sign_bits
    given, output_size = (3, size) if operation == "encode" else (size, 3)
    own = encoding_defines(encoding, as_half=True), {"ENCODING": encoding.glsl}
    return HalfOperation(
        HERE / f"kernel_half_{operation}.glsl", given, 3, output_size, *own, encoding.tables, is_portable=False
    )
