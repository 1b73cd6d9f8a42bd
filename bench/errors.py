"""What can be wrong with a command, and the exit status that says so."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

T = TypeVar("T")


class UsageError(Exception):
    """Bad input or usage: one line that says what would have been right. Exit status 2."""

    exit_code = 2


class MissingError(Exception):
    """This machine lacks something: one line that says what to install. Exit status 3."""

    exit_code = 3


def pick(what: str, names: str, known: Mapping[str, T]) -> list[T]:
    """The values that comma-separated names stand for, or all of them for "all".

    Raises:
        UsageError: an unknown name; the message lists the known ones.
    """
    asked = [name.strip() for name in names.split(",") if name.strip()]
    if not asked:
        raise UsageError(f"no {what} named; known: all, {', '.join(known)}")
    unknown = [name for name in asked if name != "all" and name not in known]
    if unknown:
        raise UsageError(f"unknown {what} {quoted(unknown)}; known: all, {', '.join(known)}")
    chosen = known if "all" in asked else dict.fromkeys(asked)
    return [known[name] for name in chosen]


def quoted(names: Iterable[str]) -> str:
    return ", ".join(repr(name) for name in names)
