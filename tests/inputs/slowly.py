"""Which parameters of a test are quick: the first, which stand for all; the others are slow."""

from collections.abc import Iterable
from typing import Any

import pytest


def all_but(quick: int, values: Iterable[Any]) -> list[Any]:
    """Values for `pytest.mark.parametrize`, as they are or as `pytest.param`; those after the first few are slow.

    A tuple is of several parameters.
    """
    every = list(values)
    return [*every[:quick], *map(_slow, every[quick:])]


def _slow(value: Any) -> Any:
    if isinstance(value, type(pytest.param())):
        return pytest.param(*value.values, marks=[*value.marks, pytest.mark.slow], id=value.id)
    return pytest.param(*(value if isinstance(value, tuple | list) else [value]), marks=pytest.mark.slow)
