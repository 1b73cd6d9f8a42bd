"""A codec's code in a language: its functions and its storage's, without anything else."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template

from ....encodings.codecs.codec import Codec
from ....gbuffer.codecs.codec_passes import encoding_defines
from ....gbuffer.gl.shader import Source
from ..translator.c_writer import CWriter
from ..translator.glsl_parser import read_glsl
from ..translator.glsl_writer import EsslWriter, GlslWriter
from ..translator.hlsl_writer import HlslWriter
from ..translator.msl_writer import MslWriter
from ..translator.reduce import reduced
from ..translator.tree import Program, TranslationError
from ..translator.wgsl_writer import WgslWriter
from ..translator.writer import Writer
from .channels import TEMPLATE, Channels

ROOT = Path(__file__).with_name("codec.glsl")


@dataclass(frozen=True)
class Language:
    """A language that codes are written in.

    Attributes:
        title: what a reader calls it.
        ending: of its files.
        writer: what writes it from a tree; None for Python, whose files are made from the Python twin.
        mark: what comments begin with.
    """

    title: str
    ending: str
    writer: type[Writer] | None
    mark: str = "//"


LANGUAGES: Mapping[str, Language] = MappingProxyType(
    {
        "hlsl": Language("HLSL", ".hlsl", HlslWriter),
        "slang": Language("Slang", ".slang", HlslWriter),
        "glsl": Language("GLSL", ".glsl", GlslWriter),
        "essl": Language("GLSL ES", ".essl", EsslWriter),
        "wgsl": Language("WGSL", ".wgsl", WgslWriter),
        "msl": Language("Metal", ".metal", MslWriter),
        "c": Language("C", ".h", CWriter),
        "python": Language("Python, NumPy", ".py", None, "#"),
    }
)


@cache
def _template() -> Template:
    environment = Environment(
        loader=FileSystemLoader(TEMPLATE.parent), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template(TEMPLATE.name)


def program_of(codec: Codec, prefix: str) -> Program:
    """The six functions of a codec as a tree, and what they need.

    Raises:
        ShaderError: its GLSL cannot be read, or is of half arithmetic or a chain.
        TranslationError: its GLSL has what cannot be translated.
    """
    encoding = codec.encoding
    defines = encoding_defines(encoding)
    source = Source(ROOT, defines, {"ENCODING": encoding.glsl})
    storage = _template().render(Channels(codec).context(), encode=defines["ENCODE"], decode=defines["DECODE"])
    try:
        program = read_glsl(f"{source.text}\n{storage}")
    except TranslationError as error:
        # At the place in the file that it was included from.
        raise TranslationError(source.explain(re.sub(r"^(\d+):\d+: ", r"0:\1: ", str(error)))) from error
    encode = "nearest_encode" if encoding.is_precise else str(defines["ENCODE"])
    roots = {encode: "encode", str(defines["DECODE"]): "decode"}
    roots |= {name: name for name in ("pack", "unpack", "to_target", "from_target")}
    return reduced(program, roots, prefix, encoding.prefix)
