"""Whether a device ends the loops of a user's shader before they are done.

A software driver ends all loops of a shader together after some number of turns, and says nothing: what is measured
then is not what a GPU computes. So a short loop runs behind the user's functions: where theirs were ended, it is too.
"""

from __future__ import annotations

import numpy as np

from ...encodings.codecs.encoding import Encoding
from ..gl.device import Device
from .codec_passes import encoding_defines
from .harness import exact

# Turns of the loop behind; of the longest that `loop_limit` asks for.
FEW, MANY = 4, 2**17


def loop_limit(device: Device) -> int | None:
    """After how many turns the device ends a loop; None where it makes MANY."""
    (made,) = exact(device, "loop_turns.comp", {}, {}, [np.zeros((1, 4), np.float32)], 1, asked_turns=MANY)
    return None if made[0, 0] >= MANY else int(made[0, 0])


def loops_ended(device: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each normal whether the device ended a loop of encode, and of decode.

    Args:
        n, view: float32 arrays of shape (count, 4).

    Returns:
        two arrays of bool of shape (count,); decode's is set too where encode's loop was ended.
    """
    defines, names = encoding_defines(encoding), {"ENCODING": encoding.glsl}
    found = exact(device, "loops_done.comp", defines, names, [n, view], 2, encoding.tables, asked_turns=FEW)
    # What stands behind a loop without an end is not even compiled: nothing is written there.
    encoded, decoded = (flags[:, 0] != 1 for flags in found)
    return encoded, decoded
