"""Files damaged in seeded ways, and what is said of them."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import numpy as np

from normalbench.bench.subjects.normals import pixel_files, pixel_process


def refusal(run, path: Path, *arguments: str) -> str:
    """What `quality` says of a file, which must be one line with its name, status 2, and nothing left behind."""
    before = set(path.parent.rglob("*"))
    status, out, err = run("quality", "--normals", str(path), "--backend", "jax", *arguments)
    assert (status, out) == (2, ""), (status, out[:200], err)
    assert err.startswith(f"normalbench: {path}: ") and err.count("\n") == 1, err
    assert set(path.parent.rglob("*")) == before
    return err


def in_this_process(path: Path, kind: str, out: Path, mode: str, *names: str) -> None:
    """As `pixel_files` has it done by a process of its own, which takes half a second."""
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
    """A few bytes changed, a run cut out or doubled, a word put in, or the end lost."""
    found = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        at, length = int(rng.integers(max(len(found), 1))), int(rng.integers(1, 9))
        match rng.integers(6):
            case 0 | 1:
                found[at : at + 1] = bytes([rng.integers(256)])
            case 2:
                del found[at : at + length]
            case 3:
                found[at:at] = found[at : at + 8 * length]
            case 4:
                found[at : at + length] = WORDS[rng.integers(len(WORDS))]
            case _:
                if rng.random() < 0.3:
                    del found[at:]
    return bytes(found)


def revalued(text: bytes, rng: np.random.Generator) -> bytes:
    """JSON with a few of its values replaced by others, so that what reads it goes deep."""
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
