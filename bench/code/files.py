"""The files of a codec's code: one of a language, and its look-up tables beside it."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from dataclasses import dataclass

from ...encodings.codecs.codec import Codec
from ..output.errors import UsageError
from ..translator.tree import Program, TranslationError
from ..translator.writer import identifier
from .emit import LANGUAGES, program_of
from .numpy_source import numpy_source
from .run.interface import Interface
from .tables import table_files
from .verify import interface_of

WIDTH = 118


@dataclass(frozen=True, eq=False)
class Code:
    """A codec's code in one language, without its head.

    Attributes:
        codec, language: what it is of; `language` is a key of LANGUAGES.
        prefix: what its names begin with.
        body: its text.
        interface: how its functions are called.
    """

    codec: Codec
    language: str
    prefix: str
    body: str
    interface: Interface

    @property
    def name(self) -> str:
        """Of the file: the codec and the language's ending."""
        return file_name(self.codec, self.language)

    def text(self, head: Iterable[str]) -> str:
        """The file, under a comment of these paragraphs."""
        mark = LANGUAGES[self.language].mark
        lines = (line for said in head for line in textwrap.wrap(said, WIDTH, subsequent_indent="  ") or [""])
        return "".join(f"{mark} {line}".rstrip() + "\n" for line in lines) + f"\n{self.body}"

    def files(self, head: Iterable[str]) -> dict[str, bytes]:
        """All its files, by name."""
        beside = table_files(self.interface.tables, self.language, self.prefix)
        return {self.name: self.text(head).encode(), **beside}


def file_name(codec: Codec, language: str) -> str:
    """What the file of a codec's code is called."""
    return identifier(codec.name) + LANGUAGES[language].ending


def code_of(codec: Codec, language: str, prefix: str = "") -> Code:
    """A codec's code in a language.

    Args:
        codec: one whose storage holds what its encoding makes.
        language: a key of LANGUAGES.
        prefix: what every name begins with; the codec's name where it is empty.

    Raises:
        UsageError: the encoding has what cannot be translated.
        ShaderError: its GLSL cannot be read, or is of half arithmetic or a chain.
    """
    prefix = prefix or identifier(codec.name)
    try:
        program = program_of(codec, prefix)
        interface = interface_of(codec, prefix, _takes_view(program, prefix))
        writer = LANGUAGES[language].writer
        sizes = {name: (table.shape[1], table.shape[2]) for name, table in interface.tables.items()}
        body = writer(prefix, sizes).program(program) if writer else numpy_source(codec, prefix)
    except TranslationError as error:
        raise UsageError(_untranslatable(codec, str(error))) from error
    return Code(codec, language, prefix, body, interface)


def _untranslatable(codec: Codec, said: str) -> str:
    """Why a file is not translated; the place is in the user's file where that is GLSL."""
    encoding = codec.encoding
    if encoding.source in (None, encoding.glsl):
        return f"{encoding.glsl}: {said}"
    return f"{encoding.source}: its translation to GLSL has what is not written in other languages: {said}"


def _takes_view(program: Program, prefix: str) -> bool:
    return len(program.function(f"{prefix}_encode").parameters) > 1
