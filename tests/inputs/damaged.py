"""Files damaged in seeded ways, and the errors about them."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import numpy as np

from normalbench.bench.subjects.normals import pixel_files, pixel_process


def refusal(run, path: Path, *arguments: str) -> str:
    """Return the error of `quality` about a file: one line with its name, status 2, and no files left behind."""
    before = set(path.parent.rglob("*"))
    status, out, err = run("quality", "--normals", str(path), "--backend", "jax", *arguments)
    assert (status, out) == (2, ""), (status, out[:200], err)
    assert err.startswith(f"normalbench: {path}: ") and err.count("\n") == 1, err
    assert set(path.parent.rglob("*")) == before
    return err


def in_this_process(path: Path, kind: str, out: Path, mode: str, *names: str) -> None:
    """Do what `pixel_files` does in a process of its own, which takes half a second."""
    try:
        pixel_process.answer(mode, kind, str(path), out, list(names))
    except Exception as error:
        raise pixel_files.refused(path, "it is cut off or damaged") from error


WORDS = [
    b"-1",
    b"0",
    b"1e999",
    b"NaN",
    b"99999999999",
    b'""',
    b"[]",
    b"{}",
    b"null",
    b"true",
    b'"../x"',
    b"\xff",
    b"\n",
    b"/",
]


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """Return the data with a few bytes changed, a run cut out or doubled, a word inserted, or the end cut off."""
    mutant = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        start, length = int(rng.integers(max(len(mutant), 1))), int(rng.integers(1, 9))
        match rng.integers(6):
            case 0 | 1:
                mutant[start : start + 1] = bytes([rng.integers(256)])
            case 2:
                del mutant[start : start + length]
            case 3:
                mutant[start:start] = mutant[start : start + 8 * length]
            case 4:
                mutant[start : start + length] = WORDS[rng.integers(len(WORDS))]
            case _:
                if rng.random() < 0.3:
                    del mutant[start:]
    return bytes(mutant)


def revalued(text: bytes, rng: np.random.Generator) -> bytes:
    """Return JSON with a few of its values replaced by others, so that readers get past its syntax."""
    document = json.loads(text)
    for _ in range(rng.integers(1, 4)):
        holder = document
        while True:
            keys = list(holder) if isinstance(holder, dict) else range(len(holder))
            key = keys[rng.integers(len(keys))]
            if not isinstance(holder[key], dict | list) or not holder[key] or rng.random() < 0.1:
                break
            holder = holder[key]
        values = (*VALUES, [holder[key]] * 3, {"0": holder[key]})
        # A copy, into which the next change may go.
        holder[key] = copy.deepcopy(values[rng.integers(len(values))])
    return json.dumps(document).encode()


VALUES = (
    -1,
    0,
    1,
    2,
    3,
    5,
    1e300,
    -0.0,
    10**400,
    2**31,
    5121,
    5123,
    5126,
    None,
    True,
    "",
    "VEC2",
    "SCALAR",
    [],
    {},
    [0],
)
