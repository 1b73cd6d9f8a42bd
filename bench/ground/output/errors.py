"""What can be wrong with a command, and the exit status that says so."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import TypeVar

from .spelling import meant, spelled

T = TypeVar("T")
# Digits that nobody reads to their end, and how many of them are shown.
LONG_NUMBER, DIGITS = re.compile(r"\d{25,}"), 6
# What a reason says of an encoding that is written for shaders alone.
NO_TWIN = "has no Python twin"
# Letters of a line: what a word of thousands would make of it is not a message.
LONGEST = 1500


def names_by_reason(left_out: Iterable[tuple[str, str | None]]) -> dict[str, list[str]]:
    """For each reason the names of what is left out for it."""
    reasons: dict[str, list[str]] = {}
    for name, why in left_out:
        reasons.setdefault(str(why), []).append(name)
    return reasons


def by_reason(left_out: Iterable[tuple[str, str | None]]) -> list[str]:
    """A line for each reason, with the names of what is left out for it."""
    return [f"{', '.join(names)}: {why}" for why, names in names_by_reason(left_out).items()]


# Where somebody asks for them, the lines about what is left out.
_noted: ContextVar[list[str] | None] = ContextVar("noted", default=None)


def leave_out(line: str) -> None:
    """Say what is not measured, and why."""
    if (lines := _noted.get()) is None:
        tell(f"left out: {line}")
    else:
        lines.append(line)


@contextmanager
def noting_what_is_left_out() -> Iterator[list[str]]:
    """The lines about what is left out meanwhile, which are said at its end; not where it is refused, in one line."""
    lines: list[str] = []
    token = _noted.set(lines)
    try:
        yield lines
    finally:
        _noted.reset(token)
    for line in lines:
        tell(f"left out: {line}")


class UsageError(Exception):
    """Bad input or usage: one line that says what would have been right. Exit status 2."""

    exit_code = 2


class MissingError(Exception):
    """This machine lacks something: one line that says what to install. Exit status 3."""

    exit_code = 3


# What this command has told already.
told: set[str] = set()


def tell(line: str) -> None:
    """A line to standard error, once in a command.

    Whatever names of files hold, it is one line and leaves the terminal as it is.
    """
    # Here, because every run of pytest imports this module.
    from ....reports.tables import visible

    text = LONG_NUMBER.sub(_cut, visible(" ".join(line.split())))
    shown = text if len(text) <= LONGEST else f"{text[: LONGEST // 2]} ... {text[-LONGEST // 2 :]}"
    if shown not in told:
        told.add(shown)
        print(f"normalbench: {shown}", file=sys.stderr)


def _cut(number: re.Match[str]) -> str:
    """A number of very many digits in short."""
    return f"{number[0][:DIGITS]}... ({len(number[0])} digits)"


def tell_together(first: str, lines: Iterable[str]) -> None:
    """A line to standard error, and indented ones that belong to it; all of them, however often they were said."""
    from ....reports.tables import visible

    for at, line in enumerate((first, *lines)):
        print(("  " if at else "normalbench: ") + visible(" ".join(line.split())), file=sys.stderr)


def pick(what: str, names: str, known: Mapping[str, T]) -> list[T]:
    """The values that comma-separated names stand for, however they are spelled, or all of them for "all".

    Raises:
        UsageError: an unknown name; the message says what may have been meant, and lists the known ones.
    """
    asked = [name.strip() for name in names.split(",") if name.strip()]
    if not asked:
        raise UsageError(f"no {what} named; known: all, {', '.join(known)}")
    found = {name: spelled(what, name, known) for name in asked if name != "all"}
    unknown = [name for name, key in found.items() if key is None]
    if unknown:
        raise _unknown(what, unknown, known, f"all, {', '.join(known)}")
    chosen = known if "all" in asked else dict.fromkeys(key for key in found.values() if key is not None)
    return [known[name] for name in chosen]


def pick_one(what: str, name: str, known: Collection[str]) -> str:
    """The known name that is meant, however it is spelled. Raises UsageError for an unknown one, and for several."""
    key = spelled(what, name.strip(), known)
    if key is None and "," in name:
        raise UsageError(f"one {what} at a time, not {name}; known: {', '.join(known)}")
    if key is None:
        raise _unknown(what, [name], known, ", ".join(known))
    return key


def _unknown(what: str, names: list[str], known: Iterable[str], listed: str) -> UsageError:
    guess = "".join(f" {said}" for name in names if (said := meant(name, known, what)))
    return UsageError(f"unknown {what} {quoted(names)};{guess} known: {listed}")


def pick_or_read(
    what: str, names: str, known: Mapping[str, T], endings: Collection[str], read: Callable[[Path], T]
) -> list[T]:
    """The values that comma-separated names stand for, or files by what their names end in.

    Raises:
        UsageError: an unknown name, or two files of one name, which rows could not tell apart; and what `read` raises.
    """
    check_comma(names)
    words = list(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    files = [Path(word) for word in words if Path(word).suffix.lower() in endings]
    called = [file.name for file in files]
    twice = [name for name in called if called.count(name) > 1]
    if twice:
        raise UsageError(f"two files are called {twice[0]}, which is how rows name them; rename one")
    others = [word for word in words if Path(word).suffix.lower() not in endings]
    try:
        chosen = pick(what, ",".join(others), known) if others or not files else []
    except UsageError as error:
        raise UsageError(f"{error}; or a file that ends in {', '.join(endings)}") from None
    return chosen + [read(file) for file in files]


def check_comma(names: str) -> None:
    """Raises UsageError where a file is named whose name has a comma."""
    if "," in names and names_a_file(names):
        raise UsageError(f"{names}: a comma in a file's name separates two names; rename the file")


def names_a_file(word: str) -> bool:
    """Whether there is a file of this name; of a name that no file can have there is none."""
    with suppress(OSError, ValueError):
        return Path(word).is_file()
    return False


def names_a_folder(word: str) -> bool:
    """Whether there is a folder of this name."""
    with suppress(OSError, ValueError):
        return bool(word) and Path(word).is_dir()
    return False


def quoted(names: Iterable[str]) -> str:
    return ", ".join(repr(name) for name in names)
