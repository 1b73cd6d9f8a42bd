"""The files with a codec's functions: one file in a language, and the lookup tables next to it."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ....encodings.kinds import NORMAL
from ...ground.output.errors import UsageError
from ...ground.user_files import UserFile
from ..translator.tokens import in_a_comment
from ..translator.tree import TranslationError
from ..translator.writer import identifier
from .emit import LANGUAGES, program_of
from .fold import WIDTH, folded
from .kinds.table import kind_of
from .run.interface import Interface
from .tables import table_files, texels_of
from .verify import interface_of

# What stands before a line of a comment.
MARK = len("// ")


@dataclass(frozen=True, eq=False)
class Code:
    """A codec's code in one language, without the comment at the head of the file.

    Attributes:
        codec, language: the codec and the language, a key of LANGUAGES.
        prefix: the beginning of the names in the code.
        body: the text of the code.
        interface: the interface of its functions.
    """

    codec: Any
    language: str
    prefix: str
    body: str
    interface: Interface

    @property
    def name(self) -> str:
        """The file's name: the codec and the language's extension."""
        return file_name(self.codec, self.language)

    def text(self, head: Iterable[str]) -> str:
        """Return the text of the file: the functions under a comment with these paragraphs, in an include guard if
        the language has a preprocessor."""
        return commented(self.body, self.language, self.guard, head)

    @property
    def guard(self) -> str:
        """The word from which the include guard is made: the prefix unless it is the default, else the codec with its
        storage. Codecs of one kind usually have the same names; if two are included, a compiler should report it."""
        return stem_of(self.codec) if self.prefix == usual_prefix(self.codec) else self.prefix

    def files(self, head: Iterable[str]) -> dict[str, bytes]:
        """Return the contents of all files of the codec, by file name: its functions under a comment with these
        paragraphs, and its lookup tables."""
        beside = table_files(self.interface.tables, self.language, stem_of(self.codec), self.prefix)
        return {self.name: self.text(head).encode(), **beside}


def commented(body: str, language: str, guard: str, head: Iterable[str]) -> str:
    """Return the text of a file under a comment with these paragraphs; indented paragraphs are not wrapped. If the
    language has a preprocessor, the text gets an include guard that is named after `guard`."""
    comment = "".join(in_a_comment(f"// {line}").rstrip() + "\n" for paragraph in head for line in _lines(paragraph))
    if not LANGUAGES[language].has_preprocessor:
        return f"{comment}\n{body}"
    name = f"{identifier(guard).upper()}_INCLUDED"
    return f"{comment}\n#ifndef {name}\n#define {name}\n\n{body}\n#endif\n"


def _lines(paragraph: str) -> list[str]:
    if paragraph.startswith("  "):
        return [paragraph]
    return textwrap.wrap(paragraph, WIDTH - MARK, subsequent_indent="  ", break_on_hyphens=False) or [""]


def file_name(codec: Any, language: str) -> str:
    """Return the name of the file with a codec's functions."""
    return stem_of(codec) + LANGUAGES[language].ending


def usual_prefix(codec: Any) -> str:
    """Return the default beginning of the names of a codec's functions: the word for its kind."""
    return kind_of(codec).prefix


def stem_of(codec: Any) -> str:
    """Return the beginning of the names of a codec's files, an identifier: its kind (except for normals), its
    encoding, its storage, and its rounding (except nearest)."""
    kind = kind_of(codec)
    if kind.kind is NORMAL:
        return identifier(codec.name)
    rounding = getattr(codec, "rounding", "nearest")
    named = f"{kind.kind.word} {kind.named(codec)}/{codec.storage.name}"
    return identifier(named if rounding == "nearest" else f"{named}/{rounding}")


def code_of(codec: Any, language: str, prefix: str = "") -> Code:
    """Return a codec's code in a language.

    Args:
        codec: a codec whose storage holds the code of its encoding.
        language: a key of LANGUAGES.
        prefix: the beginning of every name; if empty, the default of the codec's kind.

    Raises:
        UsageError: the codec can only be measured, or its encoding contains something that cannot be translated.
        ShaderError: its GLSL cannot be read, or it uses half arithmetic or is a chain.
    """
    _check_written(codec)
    prefix = prefix or usual_prefix(codec)
    try:
        program = program_of(codec, prefix)
        interface = interface_of(codec, prefix, program)
        writer = LANGUAGES[language].writer
        texels = {name: texels_of(table) for name, table in interface.tables.items()}
        body = writer(prefix, texels, stem_of(codec)).program(program)
    except TranslationError as error:
        raise UsageError(_untranslatable_reason(codec, str(error))) from error
    return Code(codec, language, prefix, folded(body), interface)


def _untranslatable_reason(codec: Any, reason: str) -> str:
    """Return why a codec is not translated, from a translator's message. The text begins with the line in the GLSL,
    or with only the user's file if that was translated to GLSL first."""
    encoding = codec.encoding
    source = getattr(encoding, "source", None)
    if source is None or not UserFile(str(source)).is_translated:
        return reason if re.match(r"\S+:\d+: ", reason) else f"{encoding.glsl}: {reason}"
    what = re.sub(r"^\S*?:?\d+:(\d+:)? ", "", reason).replace("is not a type that is known here", "parameters or types")
    return f"{source}: can be measured, but cannot be written in other languages: {what}"


def _check_written(codec: Any) -> None:
    """Raise UsageError for a codec that can only be measured."""
    if getattr(codec.encoding, "before", None):
        raise UsageError(f"{codec.encoding.name}: a chain of codecs cannot be written; write each codec separately")
    if getattr(codec.storage, "code", None):
        raise UsageError(f"{codec.name}: it packs its own bytes; use your functions as they are")
    if getattr(codec.storage, "curved", 0):
        raise UsageError(f"{codec.name}: {codec.storage.title} converts colours itself; write the curve srgb in r8")
