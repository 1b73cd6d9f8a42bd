"""An encoding's GLSL in 16-bit types: the same file, with 16-bit floats, vectors and literals throughout."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import Path

from .....gbuffer.gl.shader import Line, Source

HERE = Path(__file__).resolve().parent
LARGEST = 65504.0
# A number with a point or an exponent; whole numbers without are integers.
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)(?![\w.])")
TYPES = re.compile(r"\b(float|vec[234]|mat[234])\b")
# Their bits are those of 32: `half.glsl` has functions that widen first.
BITS = re.compile(r"\b(floatBitsToUint|floatBitsToInt|uintBitsToFloat|intBitsToFloat)\b")


class HalfSource(Source):
    """A shader in which the included files and the macros at the top use 16-bit types. The shader's own lines and the
    files in this folder are unchanged.

    Args:
        path, defines, names: as for `Source`.
        kept: names of macros that stay unchanged.
    """

    def __init__(
        self, path: str | Path, defines: Mapping[str, object], names: Mapping[str, Path], kept: Collection[str] = ()
    ):
        self._kept = tuple(f"#define {name} " for name in kept)
        super().__init__(path, defines, names)
        changed = [self._line_in_halves(line) for line in self._lines]
        # The macros hold numbers of 16 bits, which the extension must have made known.
        self._lines = sorted(changed, key=lambda line: not line[0].startswith(("#version", "#extension")))
        self.text = "".join(f"{line}\n" for line, _, _ in self._lines)

    def _line_in_halves(self, line: Line) -> Line:
        text, path, number = line
        is_ours = path == self.place or path.parent == HERE
        is_macro = number == 1 and text.startswith("#define") and not text.startswith(self._kept)
        return (in_halves(text), path, number) if is_macro or not is_ours else line


def in_halves(text: str) -> str:
    """Return a line of GLSL with its float types, literals and bit conversions changed to 16 bits; integers are
    unchanged, and literals above 65504 become 65504."""
    text = NUMBER.sub(lambda match: f"{min(float(match[1]), LARGEST)!r}hf", text)
    text = TYPES.sub(lambda match: "float16_t" if match[1] == "float" else f"f16{match[1]}", text)
    return BITS.sub(lambda match: f"half_{match[1]}", text)
