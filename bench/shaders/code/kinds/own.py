"""Users' encodings of anything except normals: the results of their two functions, computed by OpenGL."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .....encodings.catalogue import BY_KIND
from .....encodings.kinds import Kind
from .....encodings.vec import CONSTANTS
from .....gbuffer.codecs.harness import check_functions
from .....gbuffer.codecs.own.own_passes import tried
from .....gbuffer.gl.device import device


def is_in(kind: Kind) -> Callable[[Any], bool]:
    """Return a function that tells whether a codec's encoding is the catalogue's encoding of this kind."""
    return lambda codec: BY_KIND[kind].get(codec.encoding.name) is codec.encoding


def defines(encoding: Any, word: str, code: str) -> dict[str, object]:
    """Return the macros of an encoding: the GLSL type of its code, its two functions, and the constants of its file.

    Args:
        word: the ending of the functions' names, such as `_motion`.

    Raises:
        ShaderError: its GLSL file cannot be read or lacks one of its functions.
    """
    check_functions(encoding.glsl, encoding.signatures)
    functions = {"ENCODE": f"{encoding.prefix}_encode{word}", "DECODE": f"{encoding.prefix}_decode{word}"}
    return {"CODE": code, **functions, **CONSTANTS, **encoding.constants}


def by_device(size: int, result: int, store: Callable[[Any, np.ndarray], np.ndarray]) -> Any:
    """Return a function for `CodeKind.by_device`: OpenGL computes a code, JAX stores it, and OpenGL decodes it.

    Args:
        size: the number of components of the code.
        result: the number of values that a decoder returns.
        store: (codec, codes of shape (count, size)) -> the codes as read back from the storage.
    """

    def run(codec: Any, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        encoding, given, more = codec.encoding, _wide(n), _wide(view)
        is_unit = getattr(encoding, "is_unit", False)
        codes = tried(device(), encoding.glsl, encoding.prefix, 1, given, more).codes[:, :size]
        stored = store(codec, codes * np.float32(2) - np.float32(1) if is_unit else codes)
        read = stored * np.float32(0.5) + np.float32(0.5) if is_unit else stored
        back = tried(device(), encoding.glsl, encoding.prefix, 1, given, more, _wide(read)).back[0]
        return stored, back[:, :result]

    return run


def _wide(rows: np.ndarray) -> np.ndarray:
    """Return rows padded with zeros to four numbers, float32 of shape (count, 4)."""
    return np.pad(rows.astype(np.float32), ((0, 0), (0, 4 - rows.shape[1])))
