"""Names of codes of one kind, of which some are users' files: those are looked at first, and left out where that
fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from ....encodings.kinds import AnyEncoding
from ...ground.choose import choose
from ...ground.machine.cores import on_all_cores
from ...ground.machine.systems import forks
from ...ground.options.words import Names
from ...ground.output.errors import MissingError, UsageError, leave_out, tell
from ...ground.user_files import UserFile, names_an_encoder

T = TypeVar("T", bound=AnyEncoding)
# A code, and lines that are to be said of it.
Looked = tuple[T, list[str]]
TAKEN = "there is a code named {} already; rename {}"
TWICE = "another file has a code named {}; rename {}"


def choose_or_look(
    what: str,
    names: Names,
    known: Mapping[str, T],
    look: Callable[[UserFile], Looked[T]],
    what_names: Callable[[T], str] = lambda _: "the file",
) -> list[T]:
    """Return the codes that names stand for: known ones, or users' files. What is wrong with a file is named on
    standard error, and the file is left out.

    Args:
        look: looks at a file, several at once.
        what_names: what gives a file's code its name.

    Raises:
        UsageError: an unknown name, or nothing left.
        MissingError: nothing left, because a compiler or a device is missing.
    """
    files: dict[str, T] = {}
    complaints, notes = list[Exception](), list[str]()
    typed = [word for word in names if isinstance(word, str) and names_an_encoder(word)]

    def tried(word: str) -> Looked[T] | Exception:
        try:
            return look(UserFile(word))
        except (UsageError, MissingError) as error:
            return error

    for word, looked in zip(typed, on_all_cores(tried, typed, forks.stop), strict=True):
        if isinstance(looked, Exception):
            complaints.append(looked)
            continue
        code, said = looked
        taken = TAKEN if code.name in known else TWICE if code.name in [one.name for one in files.values()] else ""
        if taken:
            complaints.append(UsageError(f"{word}: {taken.format(code.name, what_names(code))}"))
            continue
        files[word], notes = code, notes + said
    left = [word for word in names if word in files or word not in typed]
    if complaints and not left:
        raise complaints[0]
    chosen = choose(what, left, {**known, **files})
    # At last: an error is one line alone.
    for error in complaints:
        leave_out(str(error))
    for line in notes:
        tell(line)
    return chosen
