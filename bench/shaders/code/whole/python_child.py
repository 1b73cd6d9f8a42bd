"""Runs a file of a layout's code in NumPy: `code.py` and `given.npy` of a folder become `made.npy` there."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from ....ground.machine import children
from ...translator.tree import scalar_of, size_of
from ..run.python_child import imported


def fields_of(rows: np.ndarray, kinds: list[str]) -> list[np.ndarray]:
    """The fields of a structure, by their types, of rows of 32-bit words."""
    found, at = [], 0
    for kind in kinds:
        size = size_of(kind)
        part = rows[:, at : at + size] if size > 1 else rows[:, at]
        found.append(part if scalar_of(kind) == "uint" else part.view(np.float32))
        at += size
    return found


def rows_of(fields: Any, kinds: list[str], count: int) -> np.ndarray:
    """The rows of a structure: uint32 of shape (count, numbers)."""
    parts = []
    for field, kind in zip(fields, kinds, strict=True):
        size, plain = size_of(kind), np.asarray(field, np.uint32 if scalar_of(kind) == "uint" else np.float32)
        # What does not depend on the row is given once.
        whole = np.broadcast_to(plain, (count, size) if size > 1 else (count,))
        parts.append(np.ascontiguousarray(whole).view(np.uint32).reshape(count, size))
    return np.concatenate(parts, axis=1)


def main(words: list[str]) -> None:
    """Run both functions. Raises whatever they raise."""
    children.limit_this_process()
    place, prefix, surface, targets = Path(words[0]), words[1], words[2].split(","), words[3].split(",")
    settings = [kind for kind in words[4].split(",") if kind]
    module, rows = imported(place / "code.py"), np.ascontiguousarray(np.load(place / "given.npy"))
    width, end = sum(map(size_of, surface)), sum(map(size_of, (*surface, *targets)))
    behind = fields_of(np.ascontiguousarray(rows[:, end:]), settings)
    packed = getattr(module, f"{prefix}_pack")(
        getattr(module, f"{prefix}_surface")(*fields_of(np.ascontiguousarray(rows[:, :width]), surface)), *behind
    )
    unpacked = getattr(module, f"{prefix}_unpack")(
        getattr(module, f"{prefix}_targets")(*fields_of(np.ascontiguousarray(rows[:, width:end]), targets)), *behind
    )
    made = [rows_of(packed, targets, len(rows)), rows_of(unpacked, surface, len(rows))]
    np.save(place / "made.npy", np.concatenate(made, axis=1))


if __name__ == "__main__":
    main(sys.argv[1:])
