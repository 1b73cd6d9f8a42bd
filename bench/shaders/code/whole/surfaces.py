"""Random surfaces for a layout's code, as rows of 32-bit words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....ground.directions import directions
from .surface import Contents, Field

# Light up to this, and how far beyond its range a quantity goes.
BRIGHT, BEYOND = 64.0, 1.125
# A number in so many is an end of its range.
ENDS = 16


def surfaces(contents: Contents, count: int, seed: int = 0) -> np.ndarray:
    """Surfaces with every value that a field may have, its ends and what lies beyond them among these.

    Returns:
        uint32 of shape (count, numbers), in the order of the structure; floats by their bits.
    """
    random = np.random.default_rng(seed)
    return np.concatenate([part for field in contents.fields for part in _numbers(contents, field, random, count)], 1)


def _numbers(contents: Contents, field: Field, random: np.random.Generator, count: int) -> Iterator[np.ndarray]:
    if field.name == "normal":
        yield _normals(contents, random, count).astype(np.float32).view(np.uint32)
        return
    size = len(field.components)
    if field.kind == "uint":
        yield random.integers(0, 2 ** _bits(contents, field), (count, 1), np.uint32)
        return
    largest = field.kept.range if field.kept else 1.0
    share = random.uniform(0.0, 1.0, (count, size)) * BEYOND
    at_end = random.integers(0, ENDS, (count, size))
    share = np.where(at_end == 0, 0.0, np.where(at_end == 1, 1.0, share))
    if field.name == "motion":
        share *= random.choice([-1.0, 1.0], (count, size)) * 2.0 ** random.uniform(-12, 0, (count, 1))
    if field.name == "emission":
        largest, share = BRIGHT, share * 2.0 ** random.uniform(-12, 0, (count, 1))
    yield (share * largest).astype(np.float32).view(np.uint32)


def _bits(contents: Contents, field: Field) -> int:
    """How many bits a whole number has; in a float as many as it tells apart."""
    (word,) = field.words
    storage = contents.layout.targets[word.target].storage
    if word.bits or storage.kind != "float":
        return word.bits or storage.scale(word.first).bit_length()
    return storage.float_form(word.first).mantissa


def _normals(contents: Contents, random: np.random.Generator, count: int) -> np.ndarray:
    """Unit normals, those along axes and next to them first."""
    made = random.normal(size=(count, 3))
    made /= np.linalg.norm(made, axis=1, keepdims=True)
    hard = directions()[: count // 2]
    made[: len(hard)] = hard
    encoding = contents.layout.encoding
    if encoding.domain != "sphere":
        axis = "xyz".index(getattr(encoding, "axis", "z") or "z")
        made[:, axis] = np.abs(made[:, axis]) * (getattr(encoding, "sign", 1) or 1)
    return made
