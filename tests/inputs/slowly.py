"""Cases of a test that are drawn at random for each commit."""

import random
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any


def a_tenth(values: Iterable[Any]) -> list[Any]:
    """Return a tenth of some values in their order, a different tenth for each commit."""
    return one_in(10, values)


def half(values: Iterable[Any]) -> list[Any]:
    """Return half of some values in their order, another half for each commit."""
    return one_in(2, values)


def one_in(of: int, values: Iterable[Any]) -> list[Any]:
    """Return every `of`th of some values on average, in their order, drawn anew for each commit."""
    every = list(values)
    return drawn_of(every, -(-len(every) // of))


def drawn_of(values: Iterable[Any], count: int) -> list[Any]:
    """Return `count` of some values in their order, different values for each commit."""
    every = list(values)
    drawn = set(random.Random(_commit()).sample(range(len(every)), count))
    return [value for index, value in enumerate(every) if index in drawn]


def is_drawn(test: str, of: int) -> bool:
    """Whether a test that runs for one commit in `of` runs for this commit; `test` is its id."""
    return random.Random(f"{_commit()} {test}").randrange(of) == 0


@cache
def _commit() -> str:
    """Return the name of the tested commit, or an empty text without a repository."""
    words = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    return subprocess.run(words, capture_output=True, text=True).stdout.strip()
