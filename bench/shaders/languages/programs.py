"""The text to compile: a user's source with an entry point, and macros for types that engines define elsewhere."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from ...ground.compilers.lines import bare
from .pairs import Function
from .shaped import ShapedPair
from .source import Source

ENTRY = "normalbench_entry"
# Types that engines define in files of their own: Unity's `real` and Unreal's `MaterialFloat`.
ENGINE_TYPES: Mapping[str, str] = MappingProxyType({"real": "float", "MaterialFloat": "float"})
# Types of 16 bits, which are computed in 32.
HALVES = ("half", "min16float", "min10float", "float16_t")
_HALF = re.compile(rf"\b(?:(?:{'|'.join(HALVES)})(?:[1-4](?:x[1-4])?)?|f16(?:vec|mat)[2-4]|mediump|lowp)\b")
# Of HLSL: as slangc has it, and as glslang reads it, whose `?:` is of vectors.
VERSION, YEAR = "__HLSL_VERSION", "2018"
SIZES = ("", "2", "3", "4")

# In place of a name.
ANY = ""


class Read(NamedTuple):
    """The parts of a source that a compiler reads.

    Attributes:
        source: the part of the source that is compiled, with unchanged line numbers.
        functions: its functions of vectors.
        refused: for the name of each function that is missing from these, the reason.
        lost: for the name of each global or type that is missing from the source, the reason; under ANY, the reason
            for unknown names.
    """

    source: Source
    functions: Sequence[Function]
    refused: Mapping[str, str] = MappingProxyType({})
    lost: Mapping[str, str] = MappingProxyType({})


class TranslationError(Exception):
    """A file that a compiler refuses; the one-line message names the file, and the line and column if known."""


def template(name: str, **words: object) -> str:
    """Return the text of a file in this folder with the names of the keyword arguments replaced by their values."""
    return re.sub(rf"\b(?:{'|'.join(words)})\b", lambda match: str(words[match[0]]), _text(name))


@cache
def _text(name: str) -> str:
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


# Of a code in [0, 1] to [-1, 1], and back.
UNIT_WAYS = (" * 2.0 - 1.0", " * 0.5 + 0.5")


def pair(name: str, components: int, encoder: Function, decoder: Function, is_unit: bool) -> str:
    """Return the GLSL functions NAME_encode and NAME_decode that every program calls; these call two functions above
    them, `encoder` and `decoder`.

    Args:
        is_unit: whether the functions above use codes in [0, 1], which are converted to [-1, 1] on output and back on
            input.
    """
    way_out, way_back = UNIT_WAYS if is_unit else ("", "")
    words = {f"NAME_{side}": f"{name}_{side}" for side in ("encode", "decode")}
    words |= {"ENCODED": encoder.called("n") + way_out, "DECODED": decoder.called(f"e{way_back}")}
    return template("pair.glsl", CODE=f"vec{components}", **words)


# Where a decoder's hand is: a part of its own, a fourth number of the tangent, the side of the bitangent.
HANDS: Mapping[str, str] = MappingProxyType(
    {"hand": "n.w", "tangent": "t.w", "bitangent": "dot(cross(n.xyz, t.xyz), b.xyz)", "": "1.0"}
)


def shaped(name: str, shaped_pair: ShapedPair, is_unit: bool) -> str:
    """Return the GLSL functions that every program calls for an encoding of a kind; they call the adapters above
    them, such as NAME_e_main.

    Args:
        is_unit: as for `pair`.
    """
    text = _text(shaped_pair.shape.template)
    words = {word: word.replace("NAME", name, 1) for word in re.findall(r"\bNAME_\w+", text)}
    back = {part: shaped_pair.decode.size(part) for part in ("hand", "tangent", "bitangent")}
    back["tangent"] //= 4
    hand = next((part for part, size in back.items() if size), "")
    way_out, way_back = UNIT_WAYS if is_unit else ("", "")
    return template(shaped_pair.shape.template, WAY_OUT=way_out, WAY_BACK=way_back, HAND=HANDS[hand], **words)


# What a half of 16 bits holds at most, as shaders write it.
LARGEST = f"{2**16 - 1}.0"
_BITS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "uint": ("{}", "{}"),
        "int": ("uint({})", "int({})"),
        "float": ("floatBitsToUint({})", "uintBitsToFloat({})"),
    }
)


def packed_pair(name: str, encoder: Function, decoder: Function) -> str:
    """Return functions like those of `pair`, for a code that is a 32-bit value; its halves are the two numbers."""
    words = {f"NAME_{side}": f"{name}_{side}" for side in ("encode", "decode", "halves", "whole")}
    way_out, way_back = _BITS[encoder.kind]
    words |= {"ENCODED": way_out.format(encoder.called("n")), "LARGEST": LARGEST}
    words |= {"DECODED": decoder.called(way_back.format(f"{name}_whole(e)"))}
    return template("packed.glsl", **words)


def program(source: Source, function: Function) -> str:
    """Return a source's text with an HLSL entry point that calls one of its functions."""
    arguments = "normalbench_given, normalbench_view" if function.takes_view else "normalbench_given"
    view = ", [[vk::location(1)]] float3 normalbench_view : TEXCOORD1" if function.takes_view else ""
    # What is no float is the same for all of a triangle.
    given = f"nointerpolation {function.given_type}" if function.takes else function.given_type
    words = {"VIEW": view, "RESULT": function.result_type, "GIVEN": given}
    entry = template("entry.hlsl", FUNCTION=function.name, ARGUMENTS=arguments, **words)
    return source.text + bare(entry)


def macros(source: Source, types: Mapping[str, str] = ENGINE_TYPES) -> list[str]:
    """Return macros, as NAME=TEXT, for the types and the HLSL version that a source uses but does not define."""
    words = set(re.findall(r"\w+", source.text))
    used = [(old + size, new + size) for old, new in types.items() for size in SIZES if old + size in words]
    used += [(VERSION, YEAR)] if VERSION in words else []
    return [f"{old}={new}" for old, new in used if not _defines(source.text, old)]


def _defines(text: str, name: str) -> bool:
    return bool(re.search(rf"#[ \t]*define[ \t]+{name}\b|\btypedef\s+\w+\s+{name}\b", text))


def has_halves(text: str) -> bool:
    """Whether a text without comments uses 16-bit floats."""
    return bool(_HALF.search(text))
