"""Selection of encodings of one kind by name. Users' files get a first look and are left out if it fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from ....encodings.kinds import AnyEncoding
from ...ground.choose import choose
from ...ground.machine.cores import on_all_cores
from ...ground.machine.systems import forks
from ...ground.options.words import Names
from ...ground.output.errors import MissingError, SeveralEncodersError, UsageError, leave_out, tell
from ...ground.user_files import UserFile, names_an_encoder
from ...shaders.languages.pairs import IF_NAMED

T = TypeVar("T", bound=AnyEncoding)
# A code, and lines that are to be said of it.
Looked = tuple[T, list[str]]
TAKEN = "an encoding named {} already exists; rename {}"
# Of one file.
MOST_PAIRS = 8
TWICE = "another file has an encoding named {}; rename {}"


def choose_or_look(
    what: str,
    names: Names,
    known: Mapping[str, T],
    look: Callable[[UserFile], Looked[T]],
    what_names: Callable[[T], str] = lambda _: "the file",
) -> list[T]:
    """Return the encodings with these names: known encodings, or users' files. A file with several pairs stands for
    the pairs that round-trip, up to MOST_PAIRS. Faulty files are reported on standard error and left out.

    Args:
        look: a function that takes a first look at a file; it is called for several files at once.
        what_names: a function that describes where the name of a file's encoding comes from.

    Raises:
        UsageError: a name is unknown, or no encoding is left.
        MissingError: no encoding is left, because a compiler or a device is missing.
    """
    files: dict[str, T] = {}
    complaints, notes = list[Exception](), list[str]()
    typed = [word for word in names if isinstance(word, str) and names_an_encoder(word)]

    def tried(word: str) -> list[tuple[str, Looked[T] | Exception]]:
        try:
            return [(word, look(UserFile(word)))]
        except SeveralEncodersError as error:
            pairs = [UserFile(word).with_pair(pair).word for pair in error.pairs]
            notes.extend(f"{pair} {IF_NAMED}" for pair in pairs[MOST_PAIRS:])
            return [each for pair in pairs[:MOST_PAIRS] for each in tried(pair)]
        except (UsageError, MissingError) as error:
            return [(word, error)]

    looks = dict(zip(typed, on_all_cores(tried, typed, forks.stop), strict=True))
    for word, looked in (each for several in looks.values() for each in several):
        if isinstance(looked, Exception):
            complaints.append(looked)
            continue
        code, remarks = looked
        taken = TAKEN if code.name in known else TWICE if code.name in [other.name for other in files.values()] else ""
        if taken:
            complaints.append(UsageError(f"{word}: {taken.format(code.name, what_names(code))}"))
            continue
        files[word], notes = code, notes + remarks
    failed = {pair for several in looks.values() for pair, _ in several} - {*files}
    pairs = {word: [pair for pair, _ in several] for word, several in looks.items()}
    meant = [pairs.get(word, [word]) if isinstance(word, str) else [word] for word in names]
    left = [word for words in meant for word in words if word not in failed]
    if complaints and not left:
        raise complaints[0]
    chosen = choose(what, left, {**known, **files})
    # At last: an error is one line alone.
    for error in complaints:
        leave_out(str(error))
    for line in notes:
        tell(line)
    return chosen
