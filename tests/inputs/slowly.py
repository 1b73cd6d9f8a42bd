"""Which parameters of a test run when: the first few are quick and stand for all; or a tenth, drawn by the commit."""

import random
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest


def all_but(quick: int, values: Iterable[Any]) -> list[Any]:
    """Values for `pytest.mark.parametrize`, as they are or as `pytest.param`; those after the first few are slow.

    A tuple is of several parameters.
    """
    every = list(values)
    return [*every[:quick], *(_marked(value, pytest.mark.slow) for value in every[quick:])]


def a_tenth(cheaper: str, values: Iterable[Any]) -> list[Any]:
    """Values likewise, of which each commit draws a tenth; the nightly runs all.

    Args:
        cheaper: what holds the same fact in every run, as the mark `nightly` names it; the test itself, by its tenth.
    """
    every = list(values)
    drawn = set(random.Random(_commit()).sample(range(len(every)), -(-len(every) // 10)))
    return [value if at in drawn else _marked(value, pytest.mark.nightly(cheaper)) for at, value in enumerate(every)]


@cache
def _commit() -> str:
    """The name of the commit that is tested; empty where there is no repository."""
    words = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    return subprocess.run(words, capture_output=True, text=True).stdout.strip()


def _marked(value: Any, mark: pytest.MarkDecorator) -> Any:
    if isinstance(value, type(pytest.param())):
        return pytest.param(*value.values, marks=[*value.marks, mark], id=value.id)
    return pytest.param(*(value if isinstance(value, tuple | list) else [value]), marks=mark)
