"""Curves in shaders: round trips through a real render target, and exact values without a target."""

from __future__ import annotations

import numpy as np

from ....encodings import vec
from ....encodings.codecs.curve_codec import CurveCodec, CurveEncoding
from ....encodings.storages.storage import STORAGES, rounds_to
from ...gl.device import Device
from ..codec_passes import rounding_defines
from ..harness import Passes, check_functions, exact, set_uniforms


def curve_constants(encoding: CurveEncoding) -> dict[str, object]:
    """Return the macros that a curve's GLSL file needs.

    Raises:
        ShaderError: the file cannot be read or lacks one of its functions.
    """
    check_functions(encoding.glsl, encoding.signatures)
    return {**vec.CONSTANTS, **encoding.constants}


def _curve_defines(encoding: CurveEncoding) -> dict[str, object]:
    functions = {"CURVE_ENCODE": f"{encoding.prefix}_encode_curve", "CURVE_DECODE": f"{encoding.prefix}_decode_curve"}
    return curve_constants(encoding) | functions


class CurvePasses(Passes):
    """A curve codec on an OpenGL device; a context manager that releases its resources there.

    Attributes:
        rounded_by: "device" if the format's own conversion rounds as the codec requires, else "shader".

    Raises:
        ShaderError: the curve's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: CurveCodec):
        self.rounded_by, rounds = rounding_defines(device, codec.storage, rounds_to(codec.rounding))
        # A curve's number is a texel's, whatever its format.
        rounds["STORAGE_BIASED"] = 0
        shaders, names = ("curve_encode.frag", "curve_decode.frag"), {"CURVE_ENCODING": codec.encoding.glsl}
        super().__init__(
            device, shaders, _curve_defines(codec.encoding) | rounds, names, {"texels": codec.storage.target}
        )
        for program in (self._encode.program, self._decode.program):
            set_uniforms(program, {"range": codec.range})

    def round_trip(self, quantities: np.ndarray) -> np.ndarray:
        """Return quantities after encoding, storage and decoding.

        Args:
            quantities: float32 of shape (height, width, 2): each quantity, and an offset that is added to its number
                before rounding.

        Returns:
            float32 of shape (height, width).

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        (decoded,) = self._through([STORAGES["rgba32f"]], quantities=quantities)
        return decoded[..., 0]


def exact_curves(device: Device, encoding: CurveEncoding, largest: float, given: np.ndarray) -> np.ndarray:
    """Return the numbers for quantities, and the quantities for numbers, from a compute shader, without storage.

    Args:
        largest: the range.
        given: two quantities and two numbers; float32 of shape (count, 4).

    Returns:
        the numbers for the quantities and the quantities for the numbers; float32 of shape (count, 4).
    """
    names = {"CURVE_ENCODING": encoding.glsl}
    (output,) = exact(device, "curve_parity.comp", _curve_defines(encoding), names, [given], 1, range=largest)
    return output
