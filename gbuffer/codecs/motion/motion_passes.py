"""Round trips of motion vectors through a real render target: one fragment pass encodes, a second decodes."""

from __future__ import annotations

import numpy as np

from ....encodings import vec
from ....encodings.codecs.motion_codec import MotionCodec, MotionEncoding
from ....encodings.storages.storage import STORAGES, rounds_to
from ...gl.device import Device
from ..codec_passes import rounding_defines
from ..harness import Passes, check_functions, dithering, exact, set_uniforms


def motion_defines(encoding: MotionEncoding, needs_range: bool) -> dict[str, object]:
    """Return the macros that adapt `motion_code.glsl` to an encoding.

    Raises:
        ShaderError: the encoding's GLSL file cannot be read or lacks one of its functions.
    """
    check_functions(encoding.glsl, encoding.signatures)
    return {
        "MOTION_ENCODE": f"{encoding.prefix}_encode_motion",
        "MOTION_DECODE": f"{encoding.prefix}_decode_motion",
        "MOTION_NEEDS_RANGE": int(needs_range),
        **vec.CONSTANTS,
        **encoding.constants,
    }


class MotionPasses(Passes):
    """A motion codec on an OpenGL device; a context manager that releases its resources there.

    Args:
        noise: noise to add to the codes, float32 of shape (height, width, 4), repeated over the image; None for
            no noise.

    Attributes:
        rounded_by: "device" if the format's own conversion rounds as the codec requests, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: MotionCodec, noise: np.ndarray | None = None):
        storage = codec.storage
        self.rounded_by, rounds = rounding_defines(device, storage, rounds_to(codec.rounding))
        added, tables = dithering(noise)
        defines = motion_defines(codec.encoding, codec.needs_range) | rounds | added
        shaders, names = ("motion_encode.frag", "motion_decode.frag"), {"MOTION_ENCODING": codec.encoding.glsl}
        super().__init__(device, shaders, defines, names, {"texels": storage.target}, tables)

    def round_trip(self, motions: np.ndarray, largest: float) -> np.ndarray:
        """Return motions (screens per frame), float32 of shape (height, width, 2), after a round trip.

        Args:
            largest: the range in screens.

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        for program in (self._encode.program, self._decode.program):
            set_uniforms(program, {"range": largest})
        (decoded,) = self._through([STORAGES["rgba32f"]], motions=motions)
        return decoded[..., :2]


def exact_motions(device: Device, encoding: MotionEncoding, largest: float, given: np.ndarray) -> np.ndarray:
    """Return the codes of motions, and the motions of codes, from a compute shader, without storage.

    Args:
        given: a motion and a code; float32 of shape (count, 4).

    Returns:
        the code of the motion and the motion of the code; float32 of shape (count, 4).
    """
    defines, names = motion_defines(encoding, True), {"MOTION_ENCODING": encoding.glsl}
    (output,) = exact(device, "motion_parity.comp", defines, names, [given], 1, range=largest)
    return output
