"""The code of a whole layout in a language."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template

from .....gbuffer.codecs.codec_passes import encoding_defines
from .....gbuffer.codecs.depth.depth_passes import depth_defines
from .....gbuffer.defines.layouts import curve_defines, curve_files
from .....gbuffer.gl.shader import Source
from .....gbuffer.layouts.layout import Layout
from ....ground.output.errors import UsageError
from ...translator.changes import given_back
from ...translator.glsl_parser import read_glsl
from ...translator.reduce import reduced, table_name
from ...translator.tree import Call, Program, TranslationError, inside
from ...translator.writer import identifier
from ..emit import LANGUAGES
from ..files import commented
from ..fold import folded
from ..tables import table_files, texels_of
from .surface import Contents
from .text import Texts

ROOT = Path(__file__).with_name("gbuffer.glsl")
TEMPLATE = Path(__file__).with_name("gbuffer.glsl.j2")
# What every name begins with, where nobody says otherwise.
PREFIX = "gbuffer"
ROOTS = {"pack_gbuffer": "pack", "unpack_gbuffer": "unpack"}
PAIR = ("pack", "unpack")
# What functions of curves are called here, by what their names end with.
SHORT = {"encode_curve": "to", "decode_curve": "from", "encode_motion": "to", "decode_motion": "from"}
# A layout has one code of depth.
OF_DEPTH = ("encode_depth", "decode_depth")


@dataclass(frozen=True, eq=False)
class GBufferCode:
    """The functions of a layout in one language, without the comment at the head of the file.

    Attributes:
        layout, language: their layout and language; `language` is a key of LANGUAGES.
        prefix: the beginning of their names.
        body: their text.
        texts: their structures.
        settings: the other inputs of both functions, from `view`, `near` and `far`.
        tables: the lookup tables by name, float32 of shape (height, width, channels).
    """

    layout: Layout
    language: str
    prefix: str
    body: str
    texts: Texts
    settings: tuple[str, ...]
    tables: Mapping[str, np.ndarray]

    @property
    def name(self) -> str:
        """The name of the file."""
        return self.layout.name + LANGUAGES[self.language].ending

    def text(self, head: Iterable[str]) -> str:
        """Return the text of the file: the functions under a comment with these paragraphs, in an include guard if
        the language has a preprocessor."""
        guard = self.layout.name if self.prefix == PREFIX else self.prefix
        return commented(self.body, self.language, guard, head)

    def files(self, head: Iterable[str]) -> dict[str, bytes]:
        """Return the contents of all files of the layout, by file name: its functions under a comment with these
        paragraphs, and its lookup tables."""
        beside = table_files(self.tables, self.language, identifier(self.layout.name), self.prefix)
        return {self.name: self.text(head).encode(), **beside}


@cache
def _template() -> Template:
    loader = FileSystemLoader(TEMPLATE.parent)
    environment = Environment(loader=loader, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.get_template(TEMPLATE.name)


def gbuffer_code(layout: Layout, language: str, prefix: str = "") -> GBufferCode:
    """Return the code of a layout in a language.

    Raises:
        UsageError: the layout contains something that cannot be written or translated; one line.
        ShaderError: its GLSL cannot be read.
    """
    texts, prefix = Texts(Contents(layout)), prefix or PREFIX
    own_tables = layout.encoding.tables()
    tables = {table_name(name, prefix, layout.encoding.prefix): table for name, table in own_tables.items()}
    texels = {name: texels_of(table) for name, table in tables.items()}
    try:
        program = _program(texts, prefix)
        body = LANGUAGES[language].writer(prefix, texels, identifier(layout.name)).program(program)
    except TranslationError as error:
        raise UsageError(f"layout {layout.name}: {error}") from error
    settings = tuple(parameter.name for parameter in program.function(f"{prefix}_pack").parameters[1:])
    return GBufferCode(layout, language, prefix, folded(body), texts, settings, tables)


def _program(texts: Texts, prefix: str) -> Program:
    """Return the two functions of a layout, with all that they call, as a syntax tree. Raises ShaderError,
    TranslationError."""
    layout = texts.contents.layout
    defines, files = read_of(layout)
    source, functions = Source(ROOT, defines, files), functions_text(texts)
    for name in ("CODE", "ENCODE", "DECODE", "DEPTH_ENCODE", "DEPTH_DECODE"):
        functions = re.sub(rf"\b{name}\b", str(defines[name]), functions)
    whole = read_glsl(f"{source.text}\n{functions}")
    program = given_back(reduced(whole, ROOTS, prefix, layout.encoding.prefix, pair=PAIR))
    _shorten(program, prefix)
    return program


def functions_text(texts: Texts) -> str:
    """Return the GLSL of a layout's structures and two functions, with macros for the functions that these call."""
    return _template().render(texts.context)


def read_of(layout: Layout) -> tuple[dict[str, object], dict[str, Any]]:
    """Return macros and files for the functions that a layout's code calls, in the form for `Source`. Raises
    ShaderError."""
    defines = {**depth_defines(layout.depth_encoding), **encoding_defines(layout.encoding), **curve_defines(layout)}
    files = {"ENCODING": layout.encoding.glsl, "DEPTH_ENCODING": layout.depth_encoding.glsl}
    return defines, files | {"CURVES": curve_files(layout)}


def _shorten(program: Program, prefix: str) -> None:
    """Rename functions of curves and of depth, and their calls: PREFIX_to_square_root, PREFIX_encode_depth."""
    names = {}
    for function in program.functions:
        match = re.fullmatch(rf"{prefix}_(\w+?)_({'|'.join((*SHORT, *OF_DEPTH))})", function.name)
        if match:
            is_depth = match[2] in OF_DEPTH
            names[function.name] = f"{prefix}_{match[2]}" if is_depth else f"{prefix}_{SHORT[match[2]]}_{match[1]}"
    for function in program.functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.is_own):
            call.name = names.get(call.name, call.name)
        function.name = names.get(function.name, function.name)
