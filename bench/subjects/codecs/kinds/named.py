"""Codes of a kind as they are named on the command line: the catalogue's, and users' own files."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from .....encodings.catalogue import LIGHT_ENCODINGS
from .....encodings.codecs.files import called
from .....encodings.codecs.kind import LIGHT, AnyEncoding, Kind
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.storages.storage import LIGHT_STORAGES
from ....ground.choose import choose
from ....ground.machine import children
from ....ground.machine.cores import on_all_cores
from ....ground.machine.systems import forks
from ....ground.options.light_names import light_buffers_named
from ....ground.options.words import given_in
from ....ground.output.errors import MissingError, UsageError, leave_out, tell
from ....shaders.languages.pairs import NORMALS, role
from ....shaders.languages.programs import has_halves
from ....shaders.languages.shapes import WORDS, kind_spoken_of
from ....shaders.languages.translated import SeveralEncodersError, translated
from ....shaders.languages.words import check_word, names_an_encoder, split_names, with_pair, without_settings
from .own import Own, OwnKind
from .table import OWN

CALLED = re.compile(r"\b([A-Za-z_]\w*)\s*\(")
# As long as a first look at a file of normals.
TIME_LIMIT = 60.0
LOOK = "normalbench.bench.subjects.codecs.kinds.look"
TAKEN = "there is a {} code named {} already; rename the file"
IN_32_BITS = "it declares numbers of 16 bits, but is computed in 32"
UNIT = "its codes are in [0, 1]; every storage holds them as they are, signed and float ones as well"

T = TypeVar("T", bound=AnyEncoding)


def own_codes_named(kind: Kind, names: str, catalogue: Mapping[str, T], what: str = "") -> list[T]:
    """The codes of a kind that comma-separated names stand for: the catalogue's, or users' files of shaders.

    A file is looked at first, in a process of its own: what does not compile, does not end or is not finite is named on
    standard error and left out.

    Args:
        what: what the names are of, for messages; the kind's encoding if it is not said.

    Raises:
        UsageError: an unknown name, or nothing left.
        MissingError: nothing left, because a compiler or a device is missing.
    """
    words = split_names(names)
    for word in words:
        check_word(word, catalogue, has_format=kind is LIGHT)
    files, complaints, notes = _read_all(kind, [word for word in words if names_an_encoder(word)], catalogue)
    rest = [word for word in words if word in files or not names_an_encoder(word)]
    if complaints and not rest:
        raise complaints[0]
    # A word may have a comma of its own.
    whole = {word: word.replace(",", ";") for word in files}
    known = {whole.get(word, word): one for word, one in {**catalogue, **files, **given_in(names)}.items()}
    asked = ",".join(whole.get(word, word) for word in rest)
    chosen = choose(what or f"{kind.name} encoding", asked, known)
    # At last: an error is one line alone.
    for error in complaints:
        leave_out(str(error))
    for line in notes:
        tell(line)
    return chosen


def light_codecs_named(names: str) -> list[LightCodec]:
    """The light buffers that comma-separated names stand for, users' files among them: see `light_buffers_named`.

    Raises: as own_codes_named.
    """
    words = split_names(names)
    own = [word for word in words if names_an_encoder(word)]
    others = [word for word in words if not names_an_encoder(word)]
    buffers = light_buffers_named(",".join(others)) if others else []
    try:
        files = own_codes_named(LIGHT, ",".join(own), LIGHT_ENCODINGS, "light buffer") if own else []
    except (UsageError, MissingError) as error:
        if not others:
            raise
        leave_out(str(error))
        files = []
    made = [LightCodec(encoding, LIGHT_STORAGES[encoding.storages[0]]) for encoding in files]
    return [*buffers, *made]


def _read_all(
    kind: Kind, words: list[str], catalogue: Mapping[str, Any]
) -> tuple[dict[str, Any], list[Exception], list[str]]:
    """The codes of files, why others are left out, and lines that are to be said of those that are not."""
    found: dict[str, Any] = {}
    complaints: list[Exception] = []
    notes: list[str] = []
    looked = on_all_cores(lambda path: _looked_at(kind, path), map(Path, words), forks.stop)
    for word, own in zip(words, looked, strict=True):
        try:
            read = _checked(own)
            _check_name(read, kind, catalogue, found)
            found[word] = OWN[kind.name].encoding(read)
            notes += [f"{without_settings(word)}: {line}" for line in said_of(read)]
        except (UsageError, MissingError) as error:
            complaints.append(error)
    return found, complaints, notes


def _checked(own: Own | Exception) -> Own:
    """The code. Raises what was raised where there is none."""
    if isinstance(own, Exception):
        raise own
    return own


def _check_name(own: Own, kind: Kind, catalogue: Mapping[str, Any], found: Mapping[str, Any]) -> None:
    """Raises UsageError where rows could not tell a code's name."""
    if own.made.name in catalogue:
        raise UsageError(f"{own.path}: {TAKEN.format(kind.name, own.made.name)}")
    if own.made.name in [one.name for one in found.values()]:
        raise UsageError(f"{own.path}: another file has a code named {own.made.name}; rename the file")


def _looked_at(kind: Kind, path: Path) -> Own | Exception:
    try:
        return own_code(kind, path)
    except (UsageError, MissingError) as error:
        return error


def said_of(own: Own) -> list[str]:
    """What is to be said of a code that can be measured: what is likely wrong first, and then notes."""
    quiet = {UNIT, *own.found.get("measured", [])}
    return [*own.found.get("wrong", []), *(line for line in notes_of(own) if line not in quiet)]


def notes_of(own: Own) -> list[str]:
    """What was guessed and found of a file, in sentences."""
    found = own.found
    guessed = [*([IN_32_BITS] if has_halves(own.made.text) else []), *([UNIT] if own.is_unit else [])]
    return [*own.made.notes, *found.get("notes", []), *guessed, *found.get("measured", [])]


def kind_of(path: Path, said: str) -> OwnKind | None:
    """The kind of a user's file that is no encoding of normals: what its functions' names say, or the first that fits;
    None where none does.

    Args:
        said: why it is no encoding of normals.
    """
    fitting = (name for name in WORDS if _fits(path, name))
    spoken = (name for name, words in WORDS.items() if f"is of {words.plural}, not of" in said)
    name = next(fitting, "") or next(spoken, "")
    return OWN[name] if name else None


def kind_by_names(path: Path) -> Kind | None:
    """The one kind that the names of a file's encoders and decoders speak of, if it has a pair of it; else None."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    names = [name for name in CALLED.findall(text) if role(name)]
    spoken = {kind_spoken_of(name) for name in names}
    if len(spoken) != 1 or any(word in name.lower() for name in names for word in NORMALS):
        return None
    (kind,) = spoken
    return OWN[kind].kind if kind and _fits(path, kind) else None


def _fits(path: Path, kind: str) -> bool:
    """Whether a file has a pair, or several, of a kind."""
    try:
        translated(path, kind=kind)
    except SeveralEncodersError:
        return True
    except (UsageError, MissingError):
        return False
    return True


def own_code(kind: Kind, path: Path) -> Own:
    """A user's own code of a kind, after a first look in a process of its own.

    Raises:
        UsageError: it cannot be translated or measured.
        MissingError: a compiler or a device is missing.
    """
    own = examined_code(OWN[kind.name], path)
    if "broken" in own.found:
        raise UsageError(f"{path}: {own.found['broken']}")
    return own


def examined_code(kind: OwnKind, path: Path) -> Own:
    """The same of a code that may not be finite or not end, which is the first thing that is wrong with it then.

    Raises: as `own_code`.
    """
    found = _found(kind.kind, path)
    if "missing" in found:
        raise MissingError(f"{path}: {found['missing']}" if str(path) not in found["missing"] else found["missing"])
    if "error" in found:
        raise UsageError(found["error"])
    if "broken" in found:
        found |= {"wrong": [found["broken"], *found.get("wrong", [])]}
    word = with_pair(path, found["pair"]) if "pair" in found else path
    return Own(word, translated(word, kind=kind.kind.name), found)


def _found(kind: Kind, path: Path) -> dict[str, Any]:
    """What the first look says. Raises UsageError where its process does not end well."""
    try:
        done = forks.finished(LOOK, [kind.name, str(path)], TIME_LIMIT)
        said, ended = done.stdout, children.how_it_ended(done)
    except subprocess.TimeoutExpired as error:
        said, ended = str(error.output), f"did not end within {TIME_LIMIT:g} s"
    try:
        return json.loads(said)
    except ValueError:
        raise UsageError(f"{called(str(path))}: its shader {ended}") from None
