"""Of a test's cases those that run by day, drawn by the commit."""

import random
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any


def a_tenth(values: Iterable[Any]) -> list[Any]:
    """A tenth of some values, another one for each commit, in their order. The nightly has them all."""
    every = list(values)
    return drawn_of(every, -(-len(every) // 10))


def drawn_of(values: Iterable[Any], count: int) -> list[Any]:
    """Return so many of some values, others for each commit, in their order."""
    every = list(values)
    drawn = set(random.Random(_commit()).sample(range(len(every)), count))
    return [value for index, value in enumerate(every) if index in drawn]


def is_drawn(test: str, of: int) -> bool:
    """Whether a test that runs for one commit of so many, by its id, runs for this one."""
    return random.Random(f"{_commit()} {test}").randrange(of) == 0


@cache
def _commit() -> str:
    """The name of the commit that is tested; empty where there is no repository."""
    words = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    return subprocess.run(words, capture_output=True, text=True).stdout.strip()
