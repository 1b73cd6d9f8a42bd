"""A first look at a user's GLSL, in a process that may hang or die.

    python -m normalbench.bench.codecs.first_look FILE

Prints one line of JSON: `error`, what the compiler says; `broken`, where it is not finite or does not end; `missing`,
that there is no GL device; else by domain how far a direction is off on average without any storage, and the worst with
what it becomes.
"""

from __future__ import annotations

import itertools
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from ...encodings.codecs.encoding import Encoding
from ...gbuffer.codecs.codec_passes import exact_values
from ...gbuffer.codecs.loops import loop_limit, loops_ended
from ...gbuffer.gl.device import Device, NoDeviceError, device
from ...gbuffer.gl.shader import ShaderError
from ..output.errors import UsageError
from .user_encodings import read_encoding

RANDOM = 4096


def directions() -> np.ndarray:
    """Axes with both zeros and what lies beside them, diagonals, and random directions: float32 of shape (count, 3)."""
    near = (0.0, -0.0, 1e-7, -1e-7, 1e-3, -1e-3)
    sides = itertools.product(range(3), (1.0, -1.0), near, near)
    axes = [np.insert(np.array([a, b]), axis, side) for axis, side, a, b in sides]
    diagonals = [d for d in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(d)]
    random = np.random.default_rng(0).normal(size=(RANDOM, 3))
    found = np.concatenate([axes, diagonals, random])
    return (found / np.linalg.norm(found, axis=1, keepdims=True)).astype(np.float32)


def first_look(path: Path) -> dict[str, Any]:
    """What there is to say of a file; see above."""
    n = directions()
    view = np.tile(np.array([0.1, -0.2, -1.0, 0.0], np.float32), (len(n), 1))
    given = np.concatenate([n, np.zeros((len(n), 1), np.float32)], axis=1)
    try:
        encoding, gl = read_encoding(path), device()
        codes, _ = exact_values(gl, encoding, given, view, given)
        _, decoded = exact_values(gl, encoding, given, view, codes)
        broken = _ended(gl, encoding, given, view)
    except NoDeviceError as error:
        return {"missing": str(error)}
    except (ShaderError, UsageError) as error:
        return {"error": str(error)}
    return broken or _judged(n, codes[:, : encoding.components], decoded[:, :3])


def _ended(gl: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> dict[str, Any]:
    for what, flags in zip(("encode", "decode"), loops_ended(gl, encoding, n, view), strict=True):
        if flags.any():
            said = f"after {loop_limit(gl) or 'too many'} turns in all this device ends a shader's loops without a word"
            return {"broken": f"the loops of {what} for {n[np.argmax(flags), :3].tolist()} do not end here: {said}"}
    return {}


def _judged(n: np.ndarray, codes: np.ndarray, decoded: np.ndarray) -> dict[str, Any]:
    for what, found in (("encode", codes), ("decode", decoded)):
        bad = ~np.isfinite(found).all(axis=1)
        if bad.any():
            return {"broken": f"{what} of {n[bad][0].tolist()} is {found[bad][0].tolist()}, no number"}
    length = np.maximum(np.linalg.norm(decoded, axis=1), 1e-20)
    angles = np.degrees(np.arccos(np.clip(np.sum(n * decoded, axis=1, dtype=np.float64) / length, -1, 1)))
    worst = int(np.argmax(angles))
    return {
        "mean_deg": {"sphere": float(angles.mean()), "hemisphere": float(angles[n[:, 2] >= 0].mean())},
        "worst": n[worst].round(4).tolist(),
        "becomes": decoded[worst].round(4).tolist(),
    }


if __name__ == "__main__":
    print(json.dumps(first_look(Path(sys.argv[1]))))
