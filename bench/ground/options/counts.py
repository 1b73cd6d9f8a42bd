"""Ranges of counts: normals in a set, sides of an image, repetitions. Imports nothing heavy."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, TypeVar

from ..output.errors import UsageError
from .words import Names, text_of

N = TypeVar("N", int, float)

DEFAULT_COUNT = 2**22
MAX_COUNT = 2**40
MAX_REPEATS = 1000
MAX_POWER = 2048
# Issue slots that a limit may be.
MOST_INSTRUCTIONS = 10**6
MAX_OBJECTS, MAX_LIGHTS = 100_000, 10_000


# Of a thousand, and so on, as people write them.
TIMES = {"k": 10**3, "m": 10**6, "g": 10**9}


def whole_number(text: str | int) -> int:
    """Read a whole number as people write it: 1000, 1e6, 4M, 2^22, 1_000_000. Raises ValueError for anything else."""
    word = str(text).strip().replace("_", "").lower()
    if power := re.fullmatch(r"(\d{1,9})(?:\^|\*\*)(\d{1,4})", word):
        return int(power[1]) ** int(power[2])
    if re.fullmatch(r"[-+]?\d+", word):
        return int(word)
    if number := re.fullmatch(r"([-+]?\d+(?:\.\d+)?)(?:e\+?(\d{1,2})|([kmg]))", word):
        from decimal import Decimal

        times = 10 ** int(number[2]) if number[2] else TIMES[number[3]]
        value = Decimal(number[1]) * times
        if value == int(value):
            return int(value)
    raise ValueError(f"{text} is not a whole number, such as 1000, 1e6, 4M or 2^22")


def in_range(option: str, value: float, low: float, high: float) -> None:
    """Raise UsageError if an option's value is out of range."""
    if not low <= value <= high:
        raise UsageError(f"{option} {value}: out of range; use {low} to {high}")


def checked_count(count: int) -> int:
    """Return the count unchanged. Raises UsageError unless it is from 1 to MAX_COUNT."""
    if not 1 <= count <= MAX_COUNT:
        raise UsageError(f"--count {count}: out of range; use 1 to {MAX_COUNT} (2^40)")
    return count


def check_seed(seed: int) -> None:
    """Raise UsageError for a seed that is not from 0 to 2^63 - 1."""
    in_range("--seed", seed, 0, 2**63 - 1)


def checked_sides(text: str, most: int, where: str) -> tuple[int, int]:
    """Return the width and the height of "WxH". Raises UsageError for a malformed size, or a side above `most`."""
    match = re.fullmatch(r"(\d{1,9})x(\d{1,9})", text.strip().lower())
    if not match or not all(1 <= int(side) <= most for side in match.groups()):
        raise UsageError(f"--size {text}: expected WIDTHxHEIGHT, such as 640x480, each from 1 to {most} {where}")
    return int(match[1]), int(match[2])


def checked_numbers(option: str, words: Names, kind: Callable[[str], N], least: N, most: N) -> tuple[N, ...]:
    """Return words as a tuple of numbers without duplicates. Raises UsageError if no word is given, or a number is
    invalid or out of range."""
    try:
        read: Any = whole_number if kind is int else kind
        numbers: tuple[N, ...] = tuple(dict.fromkeys(read(str(word)) for word in words))
    except ValueError:
        numbers = ()
    if not numbers or not all(least <= number <= most for number in numbers):
        between = f"whole numbers from {least} to {most}" if kind is int else f"numbers from {least:g} to {most:g}"
        raise UsageError(f"{option} {text_of(words)}: expected {between}, comma-separated")
    return numbers
