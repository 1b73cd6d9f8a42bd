"""The errors of a command, and the exit status of each."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

# Digits that nobody reads to their end, and how many of them are shown.
LONG_NUMBER, DIGITS = re.compile(r"\d{25,}"), 6
# What `lacks_twin` finds in a reason.
NO_TWIN = "has no Python twin"
# Letters of a line: what a word of thousands would make of it is not a message.
LONGEST = 1500


def names_by_reason(left_out: Iterable[tuple[str, str | None]]) -> dict[str, list[str]]:
    """Return, for each reason, the names that are left out because of it."""
    reasons: dict[str, list[str]] = {}
    for name, why in left_out:
        reasons.setdefault(str(why), []).append(name)
    return reasons


def by_reason(left_out: Iterable[tuple[str, str | None]]) -> list[str]:
    """Return a line for each reason: the names left out for it, comma-separated, and then the reason."""
    return [f"{', '.join(names)}: {why}" for why, names in names_by_reason(left_out).items()]


# Where somebody asks for them, the lines about what is left out.
_noted: ContextVar[list[str] | None] = ContextVar("noted", default=None)


def leave_out(line: str) -> None:
    """Report on standard error that something is left out, and why; within `noting_what_is_left_out`, add the line to
    its list instead."""
    if (lines := _noted.get()) is None:
        tell(f"left out: {line}")
    else:
        lines.append(line)


@contextmanager
def noting_what_is_left_out() -> Iterator[list[str]]:
    """Yield the list that `leave_out` adds lines to within the context. Print the lines at the end unless an error is
    raised."""
    lines: list[str] = []
    token = _noted.set(lines)
    try:
        yield lines
    finally:
        _noted.reset(token)
    for line in lines:
        tell(f"left out: {line}")


def lacks_twin(reason: str) -> bool:
    """Whether a row's reason for missing figures is that its encoding is written only for shaders."""
    return NO_TWIN in reason


class UsageError(Exception):
    """Bad input or usage: the message is one line that says what would be right. Exit status 2."""

    exit_code = 2


class SeveralEncodersError(UsageError):
    """A file has several encoders.

    Attributes:
        pairs: the names of each encoder and its decoder, ENCODE:DECODE.
        alone: the translated file with the only function that is named like an encoder; None without such a function.
        failing: the names of pairs that do not round-trip.
    """

    def __init__(self, message: str, pairs: list[str], alone: Any = None, failing: Sequence[str] = ()):
        super().__init__(message)
        self.pairs, self.alone, self.failing = pairs, alone, failing


class MissingError(Exception):
    """This machine lacks something: the message is one line that says what to install. Exit status 3."""

    exit_code = 3


# What this command has told already.
told: set[str] = set()
# Where somebody listens, what is said to standard output and, marked True, to standard error.
_heard: list[list[tuple[bool, str]]] = []


@contextmanager
def hearing() -> Iterator[list[tuple[bool, str]]]:
    """Yield a list of the messages printed within the context, in order: whether each goes to standard error, and its
    text."""
    _heard.append([])
    try:
        yield _heard[-1]
    finally:
        _heard.pop()


def hear(is_error: bool, text: str) -> None:
    """Record a message in the lists of all `hearing` contexts."""
    for listener in _heard:
        listener.append((is_error, text))


def tell(line: str) -> None:
    """Print a line to standard error, once per command.

    The output is one line, and file names in it cannot change the state of the terminal.
    """
    # Here, because every run of pytest imports this module.
    from ....reports.tables import visible

    text = LONG_NUMBER.sub(_cut, visible(" ".join(line.split())))
    shown = text if len(text) <= LONGEST else f"{text[: LONGEST // 2]} ... {text[-LONGEST // 2 :]}"
    if shown not in told:
        told.add(shown)
        hear(True, shown)
        print(f"normalbench: {shown}", file=sys.stderr)


def _cut(number: re.Match[str]) -> str:
    """Return a long number in a short form: its first DIGITS digits, and its number of digits."""
    return f"{number[0][:DIGITS]}... ({len(number[0])} digits)"


def tell_together(first: str, lines: Iterable[str]) -> None:
    """Print a line to standard error, with indented lines that belong to it, even if they were printed before."""
    from ....reports.tables import visible

    for index, line in enumerate((first, *lines)):
        print(("  " if index else "normalbench: ") + visible(" ".join(line.split())), file=sys.stderr)
