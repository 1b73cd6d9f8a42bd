"""Random surfaces for testing a layout's code, as rows of 32-bit words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....ground.directions import directions
from ..kinds.depth import FAR, NEAR
from .surface import Contents, Field

# Light up to this, and how far beyond its range a quantity goes.
BRIGHT, BEYOND = 64.0, 1.125
# A number in so many is an end of its range.
ENDS = 16
# Where what functions are given besides lies in a row.
PLACES = {"view": slice(0, 3), "near": slice(3, 4), "far": slice(4, 5)}


def surfaces(contents: Contents, count: int, seed: int = 0) -> np.ndarray:
    """Return surfaces with random field values, some at the ends of a field's range and some beyond it.

    Returns:
        uint32 of shape (count, numbers), in the structure's order; floats are stored as their bits.
    """
    random = np.random.default_rng(seed)
    view = settings(count, seed)[:, PLACES["view"]].view(np.float32)
    return np.concatenate([part for field in contents.fields for part in _numbers(contents, field, random, view)], 1)


def settings(count: int, seed: int = 0) -> np.ndarray:
    """Return the other function inputs for each surface: its view-space position, and the near and far planes.

    Returns:
        uint32 of shape (count, 5), in the order of PLACES; floats are stored as their bits.
    """
    view = np.random.default_rng(seed).uniform((-1.0, -1.0, -3.0), (1.0, 1.0, -0.5), (count, 3))
    planes = np.broadcast_to([NEAR, FAR], (count, 2))
    return np.concatenate([view, planes], axis=1).astype(np.float32).view(np.uint32)


def _numbers(contents: Contents, field: Field, random: np.random.Generator, view: np.ndarray) -> Iterator[np.ndarray]:
    if field.name == "normal":
        yield _normals(contents, random, view).astype(np.float32).view(np.uint32)
        return
    size, count = len(field.components), len(view)
    if field.kind == "uint":
        yield random.integers(0, 2 ** _bits(contents, field), (count, 1), np.uint32)
        return
    largest = field.kept.range if field.kept else 1.0
    share = random.uniform(0.0, 1.0, (count, size)) * BEYOND
    at_end = random.integers(0, ENDS, (count, size))
    share = np.where(at_end == 0, 0.0, np.where(at_end == 1, 1.0, share))
    if any(word.sign for word in field.words):
        # What carries a sign has no room beyond its range.
        share = np.minimum(share, 1.0)
    if field.name == "depth":
        largest, share = 1.0, np.where(at_end == 0, 0.0, NEAR * (FAR / NEAR) ** share)
    if field.name == "motion":
        share *= random.choice([-1.0, 1.0], (count, size)) * 2.0 ** random.uniform(-12, 0, (count, 1))
    if field.name == "emissive":
        largest, share = BRIGHT, share * 2.0 ** random.uniform(-12, 0, (count, 1))
    yield (share * largest).astype(np.float32).view(np.uint32)


def _bits(contents: Contents, field: Field) -> int:
    """Return the number of bits in a field's whole number; if a float stores it, the number of mantissa bits."""
    (word,) = field.words
    storage = contents.layout.targets[word.target].storage
    if word.bits or storage.kind != "float":
        return word.bits or storage.scale(word.first).bit_length()
    return storage.float_form(word.first).mantissa


def _normals(contents: Contents, random: np.random.Generator, view: np.ndarray) -> np.ndarray:
    """Return unit normals in the encoding's domain, (count, 3), starting with those on and near the axes."""
    normals = random.normal(size=view.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    hard = directions()[: len(view) // 2]
    normals[: len(hard)] = hard
    encoding = contents.layout.encoding
    if encoding.domain == "view":
        return np.where((normals * view).sum(axis=1, keepdims=True) > 0, -normals, normals)
    if encoding.domain != "sphere":
        axis = "xyz".index(getattr(encoding, "axis", "z") or "z")
        normals[:, axis] = np.abs(normals[:, axis]) * (getattr(encoding, "sign", 1) or 1)
    return normals
