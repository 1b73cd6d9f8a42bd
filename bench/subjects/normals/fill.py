"""Normals computed from their indices, by code from the C compiler."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ....encodings.vec import Vec3
from ...ground.native.elementwise import c_function, c_type
from ...ground.native.library import address, library, source

SOURCE = Path(__file__).with_suffix(".c")
LANE = np.dtype(np.uint32)


class Fill:
    """A compiled function that fills planes of normals.

    Args:
        normal_of: an elementwise function (index, *given) that returns a float32 normal.
        types: the types of `given`, whose values a float64 can represent.

    Raises:
        NotElementwiseError, NoCompilerError: the function cannot be compiled here.
    """

    def __init__(self, normal_of: Callable[..., Vec3], types: Sequence[np.dtype]):
        function = c_function("made", normal_of, LANE, *types)
        self._library = library(source(SOURCE, function, [*map(c_type, types)]), "fill")

    def __call__(self, count: int, *given: int) -> Vec3:
        """Return the normals with indices 0 to count - 1."""
        numbers = np.array(given, np.float64)
        planes = Vec3(*(np.empty(count, np.float32) for _ in range(3)))
        self._library.fill(count, address(numbers), *map(address, planes))
        return planes
