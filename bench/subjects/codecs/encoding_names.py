"""Encodings by name: the catalogue's, with or without parameters, and users' files, whose reader is imported late."""

from __future__ import annotations

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.encoding import Encoding
from ...ground.options.words import Names
from ...ground.user_files import UserFile, check_word, names_an_encoder
from . import tuned_names
from .looked_at import Looked, choose_or_look


def encodings_named(names: Names) -> list[Encoding]:
    """Return the encodings with these names: the catalogue's, tuned variants, or files that end in one of ENDINGS.

    A file's encoding gets a first look in a separate process. If the encoding does not compile, does not end or is
    not finite, the file is reported on standard error and left out.

    Raises:
        UsageError: a name is unknown, or no encoding is left.
        MissingError: no encoding is left, because a compiler is missing.
    """
    for word in names:
        if isinstance(word, str):
            check_word(word, ENCODINGS)
    settings = [word for word in names if isinstance(word, str) and tuned_names.MARK in word]
    tuned = {word: tuned_names.tuned(word) for word in settings if not names_an_encoder(word)}
    return choose_or_look("encoding", names, {**ENCODINGS, **tuned}, _looked_at, _what_names)


def _looked_at(file: UserFile) -> Looked[Encoding]:
    from .user_encodings import looked_at

    return looked_at(file)


def _what_names(encoding: Encoding) -> str:
    from .user_encodings import what_names

    return what_names(encoding)
