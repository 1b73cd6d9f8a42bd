"""Iterations of a shader's loops, and whether a device ends the loops before they are done.

A software driver ends all loops of a shader together after some number of iterations, without a message; the
figures then differ from those of a GPU. A short loop therefore runs after the user's functions: if their loops were
ended, the short loop is ended too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from ...encodings.codecs.encoding import Encoding
from ...encodings.storages.storage import STORAGES
from ..gl.device import Device
from ..gl.shader import ROOM, ShaderError, Source
from .codec_passes import encoding_defines
from .harness import exact

# Turns of the loop behind; of the longest that `loop_limit` asks for.
FEW, MANY = 4, 2**17
# More loops than that are not counted.
MOST_LOOPS = 32
_COUNTER = "loops_counted.comp"
# What the renderer and the storages write around an encoding.
_NOT_COUNTED = (ROOM, ROOM.parent / "encodings" / "storages")
_LOOP = re.compile(r"\b(for|while)\s*\(")
_NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:[^\n\\]|\\\n|\\)*", re.S | re.M)


def loop_limit(device: Device) -> int | None:
    """Return the number of iterations after which the device ends a loop; None if MANY iterations complete."""
    (turns,) = exact(device, "loop_turns.comp", {}, {}, [np.zeros((1, 4), np.float32)], 1, asked_turns=MANY)
    return None if turns[0, 0] >= MANY else int(turns[0, 0])


def loops_ended(device: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return, for each normal, whether the device ended a loop in encode, and whether it ended a loop in decode.

    Args:
        n, view: float32 arrays of shape (count, 4).

    Returns:
        two arrays of bool of shape (count,); the array for decode is also true where a loop in encode was ended.
    """
    defines, names = encoding_defines(encoding), {"ENCODING": encoding.glsl}
    outputs = exact(device, "loops_done.comp", defines, names, [n, view], 2, encoding.tables, asked_turns=FEW)
    # What stands behind a loop without an end is not even compiled: nothing is written there.
    encoded, decoded = (flags[:, 0] != 1 for flags in outputs)
    return encoded, decoded


def turns_made(device: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how often each loop runs its body for each normal: in encode, and in decode of the resulting code.

    Args:
        n, view: float32 arrays of shape (count, 4).

    Returns:
        two float32 arrays of shape (count, loops), with the loops in the order of the shader's text.

    Raises:
        ShaderError: as in `encoding_defines`, or there are more than MOST_LOOPS loops.
    """
    scale = float(STORAGES["rgba8"].scale(0))
    defines = encoding_defines(encoding) | {"MOST_LOOPS": MOST_LOOPS, "KERNEL_SCALE": scale}
    text, loops = _counted_text(Source(_COUNTER, defines, {"ENCODING": encoding.glsl}))
    if loops > MOST_LOOPS:
        raise ShaderError(f"{encoding.glsl}: {loops} loops; the maximum is {MOST_LOOPS}")
    # A normal once for each loop, which its fourth number names.
    given = np.repeat(n, loops, axis=0)
    given[:, 3] = np.tile(np.arange(loops), len(n))
    with TemporaryDirectory() as folder:
        path = Path(folder, _COUNTER)
        path.write_text(text, encoding="utf-8", newline="\n")
        views = np.repeat(view, loops, axis=0)
        turns, _ = exact(device, str(path), {}, {}, [given, views], 2, encoding.tables) if loops else (given, None)
    encoded, decoded = turns[:, 0], turns[:, 1]
    return encoded.reshape(len(n), loops), decoded.reshape(len(n), loops)


def _counted_text(source: Source) -> tuple[str, int]:
    """Return a shader's text in which a call counts each evaluation of the encoding's loop conditions, and the number
    of these loops. Loops of the renderer and the storages are not counted."""
    text = source.text
    code = _NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    is_counted = [not any(path.is_relative_to(room) for room in _NOT_COUNTED) for path in source.files]
    conditions = [condition for condition in _conditions(code) if is_counted[code.count("\n", 0, condition[0])]]
    for loop, (first, last, function) in reversed(list(enumerate(conditions))):
        text = f"{text[:first]}{function}({loop}, {text[first:last].strip() or 'true'}){text[last:]}"
    return text, len(conditions)


def _conditions(code: str) -> Iterator[tuple[int, int, str]]:
    """Yield the start and end of each loop's condition, and the name of the function that counts evaluations."""
    for match in _LOOP.finditer(code):
        first, parts = match.end(), [match.end()]
        depth, position = 1, first
        while depth and position < len(code):
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(code[position], 0)
            position += 1
            if depth == 1 and code[position - 1] == ";":
                parts.append(position)
        if match[1] == "for" and len(parts) == 3:
            yield parts[1], parts[2] - 1, "next_turn"
        elif match[1] == "while":
            yield first, position - 1, "turn_made" if code[position:].lstrip().startswith(";") else "next_turn"
