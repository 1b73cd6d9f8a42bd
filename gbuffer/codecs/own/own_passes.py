"""A user's two functions of any kind on an OpenGL device, without storage."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....encodings import vec
from ...gl.device import Device
from ..harness import exact

# Turns of the loop behind the functions: see loops.py.
FEW = 4
# What the adapters of a decoder are called, as many as it may have.
RESULTS = ("d", "t", "b")


@dataclass(frozen=True)
class Tried:
    """Results of the functions for some values, float32 arrays of shape (count, 4).

    Attributes:
        codes: results of the encoder.
        back: results of each adapter of the decoder.
        encode_ended: bool of shape (count,), whether the device ended a loop of the encoder.
        decode_ended: the same for the decoder, or for the encoder before it.
    """

    codes: np.ndarray
    back: list[np.ndarray]
    encode_ended: np.ndarray
    decode_ended: np.ndarray


def tried(
    device: Device,
    glsl: Path,
    prefix: str,
    results: int,
    given: np.ndarray,
    more: np.ndarray,
    codes: np.ndarray | None = None,
) -> Tried:
    """Run the adapters of a user's encoder and decoder on the device; return the codes, the decoder's results and,
    for each input, whether a loop of either function was ended.

    Args:
        glsl: a file with the adapters of both functions, whose names begin with the prefix.
        results: number of adapters of the decoder.
        given, more: inputs of each adapter, float32 of shape (count, 4); the last column of `more` is ignored.
        codes: codes to decode instead of the encoder's results, of the same shape; None to decode those results.

    Raises:
        ShaderError: the file does not compile.
    """
    names = [f"{prefix}_{letter}_main" for letter in RESULTS]
    functions = dict(zip(("OWN_FIRST", "OWN_SECOND", "OWN_THIRD"), names, strict=True))
    defines = {"OWN_ENCODE": f"{prefix}_e_main", **functions, "OWN_RESULTS": results, **vec.CONSTANTS}
    arrays = [given, np.concatenate([more[:, :3], np.full((len(given), 1), codes is not None)], axis=1)]
    arrays.append(np.zeros_like(given) if codes is None else codes)
    named = {"OWN_CODE": glsl}
    encoder_codes, *back, encoded, decoded = exact(device, "own_trial.comp", defines, named, arrays, 6, asked_turns=FEW)
    return Tried(encoder_codes, back[:results], encoded[:, 0] != 1, decoded[:, 0] != 1)
