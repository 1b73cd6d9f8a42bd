"""Helpers for rows of several sections: tests of values, the names of sets, and the agreement of backends."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..sheets import Row

MADE_FOR = {"hemisphere": "normals with z >= 0", "view": "normals that face the viewer"}
LEADING = "psnr_db"
BACKENDS = {"jax": "JAX", "glsl": "GLSL"}
# Figures that differ by less are said to agree within it.
LEAST_DB = 0.001


def is_number(value: Any) -> bool:
    """Whether a value is a number other than NaN, possibly infinite; text and Booleans are not numbers."""
    return isinstance(value, int | float) and not isinstance(value, bool) and value == value


def is_count(value: Any) -> bool:
    """Whether a value is an integer; a Boolean is not."""
    return isinstance(value, int) and not isinstance(value, bool)


def counted_set(row: Row, rows: Sequence[Row]) -> str:
    """Return the name of a row's set of normals, with the number of normals if rows have sets of this name and
    different sizes, which are not compared."""
    name, counts = (
        str(row.get("normals")),
        {other.get("count") for other in rows if other.get("normals") == row.get("normals")},
    )
    return name if len(counts) == 1 else f"{name} of {row.get('count')} normals"


def agreement(quality: Sequence[Row]) -> str:
    """Return a sentence on how far the figures of two backends differ; empty if no codec was measured with both.

    Args:
        quality: rows of the quality table.
    """
    figures: dict[tuple[Any, ...], dict[Any, float]] = {}
    for row in quality:
        if is_number(row.get(LEADING)):
            key = tuple(row.get(name) for name in ("encoding", "storage", "rounding", "normals", "count"))
            figures.setdefault(key, {})[row.get("backend")] = row[LEADING]
    apart = [_apart(by_backend) for by_backend in figures.values() if len(by_backend) > 1]
    known = [value for value in apart if math.isfinite(value)]
    if not apart:
        return ""
    names = " and ".join(
        BACKENDS.get(name, str(name))
        for name in next(by_backend for by_backend in figures.values() if len(by_backend) > 1)
    )
    return f"{names} agree within {max([*known, LEAST_DB]):.1g} dB."


def _apart(by_backend: Mapping[Any, float]) -> float:
    """Return the difference between the largest and the smallest of a codec's figures; 0 if both are infinite."""
    most, least = max(by_backend.values()), min(by_backend.values())
    return 0.0 if most == least else most - least
