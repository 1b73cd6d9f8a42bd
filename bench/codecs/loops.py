"""Whether a user's shader ends.

A software driver stops a loop after 65535 turns and goes on with what it has, without a word: so what is measured would
not be what a GPU computes. The loops are counted, and given up just before.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from ...encodings.codecs.encoding import Encoding
from ...gbuffer.codecs.codec_passes import encoding_defines
from ...gbuffer.gl.device import Device, bind
from ...gbuffer.gl.shader import ShaderError, Source

MOST_TURNS = 65534
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
LOOP = re.compile(r"\b(for|while)\s*\(")


def endless(gl: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> str | None:
    """What is to be said of an encoding of which a loop does not end; None where all do, or none can be counted.

    Args:
        n, view: float32 arrays of shape (count, 4).
    """
    text, loops = counted(Source(encoding.glsl).text)
    if not loops:
        return None
    defines = {**encoding_defines(encoding), "LOOPS": loops, "MOST_TURNS": MOST_TURNS}
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        path = Path(folder) / encoding.glsl.name
        path.write_text(text, encoding="utf-8")
        try:
            compute: Any = gl.owned(stack, gl.compute_pass("turns.comp", defines, {"ENCODING": path}))
        except ShaderError:
            # A loop of a form that is not counted; it compiles as it stands, and the time limit is left.
            return None
        tables = encoding.tables().items()
        bind(compute, {name: gl.owned(stack, gl.upload(table)) for name, table in tables})
        found = gl.computed(compute, [n, view], 2)
    for what, flags in zip(("encode", "decode"), found, strict=True):
        if flags[:, 0].any():
            normal = n[np.argmax(flags[:, 0]), :3].tolist()
            return f"a loop of {what} for {normal} takes more than {MOST_TURNS} turns: it does not end, or not soon"
    return None


def counted(text: str) -> tuple[str, int]:
    """GLSL with `turn(number, condition)` for the condition of each loop, and how many loops there are."""
    text, made, end, number = COMMENT.sub(" ", text), [], 0, 0
    for start, stop, kind in _heads(text):
        before, condition, after = _condition(kind, text[start:stop])
        made += [text[end:start], f"{before}turn({number}, {condition.strip() or 'true'}){after}"]
        end, number = stop, number + 1
    return "".join([*made, text[end:]]), number


def _heads(text: str) -> Iterator[tuple[int, int, str]]:
    """What stands in the brackets of each loop: its start and end, and the loop's kind."""
    for match in LOOP.finditer(text):
        depth = 1
        for at in range(match.end(), len(text)):
            depth += {"(": 1, ")": -1}.get(text[at], 0)
            if depth == 0:
                yield match.end(), at, match[1]
                break


def _condition(kind: str, head: str) -> tuple[str, str, str]:
    if kind == "while" or head.count(";") != 2:
        return "", head, ""
    first, condition, then = head.split(";")
    return f"{first};", condition, f";{then}"
