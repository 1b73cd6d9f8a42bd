"""A codec's code in a language: only the functions of the codec and of its storage."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template

from ....gbuffer.gl.shader import Source
from ..translator.c_writer import CWriter
from ..translator.changes import given_back
from ..translator.glsl_parser import read_glsl
from ..translator.glsl_writer import EsslWriter, GlslWriter
from ..translator.hlsl_writer import HlslWriter
from ..translator.msl_writer import MslWriter
from ..translator.reduce import reduced
from ..translator.tree import Program, TranslationError
from ..translator.wgsl_writer import WgslWriter
from ..translator.writer import PUBLIC, Writer
from .channels import TEMPLATE, Channels
from .kinds.table import kind_of

ROOT = Path(__file__).with_name("codec.glsl")


@dataclass(frozen=True)
class Language:
    """A language in which functions are written. The module of the same name in `run`, if any, runs its files.

    Attributes:
        title: the language's name for readers.
        ending: the extension of its files.
        writer: the class that writes code in the language from a syntax tree.
        advice: a line for users of a file, on versions and compiler options.
        has_preprocessor: whether the language has a preprocessor, so that files need include guards.
    """

    title: str
    ending: str
    writer: type[Writer]
    advice: str
    has_preprocessor: bool = True


LANGUAGES: Mapping[str, Language] = MappingProxyType(
    {
        "hlsl": Language("HLSL", ".hlsl", HlslWriter, "For shader model 5 and later."),
        "slang": Language("Slang", ".slang", HlslWriter, "For Slang, which reads HLSL."),
        "glsl": Language("GLSL", ".glsl", GlslWriter, "For GLSL 4.3 and later, and for Vulkan."),
        "essl": Language("GLSL ES", ".essl", EsslWriter, "For GLSL ES 3.1 and later."),
        "wgsl": Language("WGSL", ".wgsl", WgslWriter, "For WebGPU.", has_preprocessor=False),
        "msl": Language(
            "Metal",
            ".metal",
            MslWriter,
            "For Metal 2 and later. Compile with -fno-fast-math, which preserves rounding.",
        ),
        "c": Language("C", ".h", CWriter, "For C99. Compile with -ffp-contract=off: fused products round differently."),
    }
)


@cache
def _template() -> Template:
    environment = Environment(
        loader=FileSystemLoader(TEMPLATE.parent), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template(TEMPLATE.name)


@lru_cache(1)
def program_of(codec: Any, prefix: str) -> Program:
    """Return the six functions of a codec of any kind as a syntax tree, with everything that they need. The last
    result is cached, because a codec is written in all languages one after the other.

    Raises:
        ShaderError: its GLSL cannot be read, or it uses half arithmetic or is a chain.
        TranslationError: its GLSL contains something that cannot be translated.
    """
    encoding, kind = codec.encoding, kind_of(codec)
    defines = kind.defines(codec)
    source = Source(ROOT, defines, {"ENCODING": encoding.glsl})
    channels = Channels(codec)
    storage = _template().render(channels.context(), encode=defines["ENCODE"], decode=defines["DECODE"])
    try:
        program = read_glsl(f"{source.text}\n{storage}")
    except TranslationError as error:
        # At the place in the file that it was included from.
        raise TranslationError(source.explain(re.sub(r"^(\d+):\d+: ", r"0:\1: ", str(error)))) from error
    variants = {"nearest_encode": channels.numbers.is_precise, "settled_encode": channels.numbers.settle}
    encode = next((name for name, is_made in variants.items() if is_made), str(defines["ENCODE"]))
    own = {"encode": encode, "decode": str(defines["DECODE"])}
    roots = {own.get(name, name): name for name in PUBLIC}
    return given_back(reduced(program, roots, prefix, encoding.prefix, kind.bound(codec)))
