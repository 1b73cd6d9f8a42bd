"""Encodings of a kind by their names on the command line: from the catalogue, and from users' own files."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Mapping
from functools import partial
from typing import Any, TypeVar

from .....encodings.catalogue import LIGHT_ENCODINGS
from .....encodings.codecs.files import called
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.kinds import LIGHT, AnyEncoding, Kind, kind_spoken_of
from .....encodings.storages.storage import LIGHT_STORAGES
from ....ground.machine import children
from ....ground.machine.systems import forks
from ....ground.options.words import Names
from ....ground.output.errors import MissingError, SeveralEncodersError, UsageError, leave_out
from ....ground.user_files import UserFile, check_word, names_an_encoder
from ....shaders.languages.pairs import NORMALS, role
from ....shaders.languages.programs import has_halves
from ....shaders.languages.translated import translated
from ...names.light_buffers import light_buffers_named
from ..looked_at import choose_or_look
from .own import Own, OwnKind
from .table import OWN

CALLED = re.compile(r"\b([A-Za-z_]\w*)\s*\(")
# As long as a first look at a file of normals.
TIME_LIMIT = 60.0
LOOK = "normalbench.bench.subjects.codecs.kinds.look"
IN_32_BITS = "it declares 16-bit numbers, but is computed in 32 bits"
UNIT = "its codes are in [0, 1]; every storage holds them unchanged, signed and float included"

T = TypeVar("T", bound=AnyEncoding)


def own_codes_named(kind: Kind, names: Names, catalogue: Mapping[str, T], what: str = "") -> list[T]:
    """Return the encodings of a kind with these names: from the catalogue, or from users' shader files.

    A file gets a first look in a separate process. If its encoding does not compile, does not end or is not finite,
    the file is reported on standard error and left out.

    Args:
        what: the word for an encoding in messages; by default, the kind's name and `encoding`.

    Raises:
        UsageError: a name is unknown, or no encoding is left.
        MissingError: no encoding is left, because a compiler or a device is missing.
    """
    for word in names:
        if isinstance(word, str):
            check_word(word, catalogue, has_format=kind is LIGHT)
            if kind not in OWN and names_an_encoder(word):
                raise UsageError(f"{word}: only the catalogue's encodings of {kind.plural} can be measured")
    return choose_or_look(what or f"{kind.name} encoding", names, catalogue, partial(_looked_at, kind))


def light_codecs_named(names: Names) -> list[LightCodec]:
    """Return the light buffers with these names, including users' files (see `light_buffers_named`).

    Raises: the exceptions of `own_codes_named`.
    """
    own = tuple(word for word in names if isinstance(word, str) and names_an_encoder(word))
    others = [word for word in names if word not in own]
    buffers = light_buffers_named(others) if others or not own else []
    try:
        files = own_codes_named(LIGHT, own, LIGHT_ENCODINGS, "light buffer") if own else []
    except (UsageError, MissingError) as error:
        if not others:
            raise
        leave_out(str(error))
        files = []
    codecs = [LightCodec(encoding, LIGHT_STORAGES[encoding.storages[0]]) for encoding in files]
    return [*buffers, *codecs]


def _looked_at(kind: Kind, file: UserFile) -> tuple[Any, list[str]]:
    own = own_code(kind, file)
    return OWN[kind].encoding(own), [f"{file.plain}: {line}" for line in said_of(own)]


def said_of(own: Own) -> list[str]:
    """Return the remarks on an encoding that can be measured: likely mistakes first, then notes."""
    quiet = {UNIT, *own.found.get("measured", [])}
    return [*own.found.get("wrong", []), *(line for line in notes_of(own) if line not in quiet)]


def notes_of(own: Own) -> list[str]:
    """Return what was assumed and found about a file, in sentences."""
    findings = own.found
    guessed = [*([IN_32_BITS] if has_halves(own.made.text) else []), *([UNIT] if own.is_unit else [])]
    return [*own.made.notes, *findings.get("notes", []), *guessed, *findings.get("measured", [])]


def kind_of(file: UserFile, reason: str) -> OwnKind | None:
    """Return the kind of a user's file that is not an encoding of normals: the first kind that fits, or the kind that
    `reason` names; None if no kind does.

    Args:
        reason: the message that the file is not an encoding of normals.
    """
    fitting = (kind for kind in OWN if _fits(file, kind))
    spoken = (kind for kind in OWN if f"is of {kind.plural}, not of" in reason)
    kind = next(fitting, None) or next(spoken, None)
    return OWN[kind] if kind else None


def kind_by_names(file: UserFile) -> Kind | None:
    """Return the kind that a file's function names indicate, if it is the only one and the file has a pair of that
    kind; otherwise None."""
    try:
        text = file.path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    names = [name for name in CALLED.findall(text) if role(name)]
    spoken = {kind_spoken_of(name) for name in names}
    if len(spoken) != 1 or any(word in name.lower() for name in names for word in NORMALS):
        return None
    (kind,) = spoken
    return kind if kind and _fits(file, kind) else None


def _fits(file: UserFile, kind: Kind) -> bool:
    """Whether a file has at least one pair of functions of a kind."""
    try:
        translated(file, kind=kind)
    except SeveralEncodersError:
        return True
    except (UsageError, MissingError):
        return False
    return True


def own_code(kind: Kind, file: UserFile) -> Own:
    """Return a user's own encoding of a kind, after a first look in a separate process.

    Raises:
        UsageError: the encoding cannot be translated or measured.
        MissingError: a compiler or a device is missing.
    """
    own = examined_code(OWN[kind], file)
    if "broken" in own.found:
        raise UsageError(f"{file}: {own.found['broken']}")
    return own


def examined_code(kind: OwnKind, file: UserFile) -> Own:
    """Return an encoding like `own_code`, but accept functions that are not finite or do not end; this is then listed
    as the first mistake.

    Raises: the exceptions of `own_code`.
    """
    findings = _found(kind.kind, file)
    if "missing" in findings:
        raise MissingError(
            f"{file}: {findings['missing']}" if file.word not in findings["missing"] else findings["missing"]
        )
    if "error" in findings:
        raise UsageError(findings["error"])
    if "broken" in findings:
        findings |= {"wrong": [findings["broken"], *findings.get("wrong", [])]}
    file = file.with_pair(findings["pair"]) if "pair" in findings else file
    return Own(file, translated(file, kind=kind.kind), findings)


def _found(kind: Kind, file: UserFile) -> dict[str, Any]:
    """Return the findings of the first look. Raises UsageError if its process crashes or does not end."""
    try:
        done = forks.finished(LOOK, [kind.name, file.word], TIME_LIMIT)
        output, ended = done.stdout, children.how_it_ended(done)
    except subprocess.TimeoutExpired as error:
        output, ended = str(error.output), f"did not end within {TIME_LIMIT:g} s"
    try:
        return json.loads(output)
    except ValueError:
        raise UsageError(f"{called(str(file))}: its shader {ended}") from None
