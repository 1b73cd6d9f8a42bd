"""The encoder and its decoder in a file, found by the types and the names of functions."""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from types import MappingProxyType
from typing import Any

from ....encodings import kinds
from ....encodings.kinds import WORD, kind_spoken_of, words_in

NORMAL = 3
# One value of 32 bits, and how many numbers it is measured as.
PACKED, HALVES = ("uint", "int", "float"), 2
# Of a function's name, in lower case. Those of a decoder are looked for first: "unpack" has "pack" in it, and
# UnpackNormalOctRectEncode of Unity's HDRP decodes.
DECODES, ENCODES = ("unpack", "decode", "decompress"), ("pack", "encode", "compress")

# What stands in a name for a code.
CODES = ("oct", "hemi", "sphere", "stereo", "uv", "packed", "encoded")
# In the name of a function that takes or gives a normal, in lower case.
NORMALS = ("norm", "nrm", "oct", "unitvec", "direction")
# A word in that of one of colours, depths and the like.
OF_COLOURS = {
    *("color", "colour", "rgb", "rgbe", "rgbm", "radiance", "irradiance", "luminance", "hdr", "depth", "albedo"),
    *("ycocg", "co", "cg", "ycbcr", "yuv", "hsv", "hsl", "luv", "xyy", "srgb", "tonemap", "tint"),
}

# Encoders times decoders of a file that are tried with each other; to look through more takes seconds.
MOST_PAIRED = 10_000

IS_OF = "` measures it"
OF_OTHERS = "{} is of {}, not of {}: `{}" + IS_OF

NO_PAIR = "no encoder and decoder found"
# Behind the name of a pair that was not measured.
IF_NAMED = "is measured only if named"
BY_PARAMETER = "{} returns nothing; write a function that returns the value of the output parameter"


@dataclass(frozen=True)
class Place:
    """A number or a vector in a function's input or output.

    Attributes:
        path: its name in a program, such as s.normalWS for a field of parameter s; empty for a whole result.
        kind: the type of its numbers: float, uint, int or bool.
        size: the number of its components, 1 to 4.
    """

    path: str
    kind: str
    size: int


@dataclass(frozen=True)
class Parameter:
    """A parameter of a function.

    Attributes:
        name: its name.
        kind: its type, in HLSL.
        is_given: whether the function reads it: `in` or `inout`.
        is_made: whether the function writes it: `out` or `inout`.
        has_default: whether it can be omitted in a call.
        places: its numbers and vectors.
    """

    name: str
    kind: str
    is_given: bool
    is_made: bool
    has_default: bool
    places: tuple[Place, ...]


@dataclass(frozen=True)
class Function:
    """A function.

    Attributes:
        name: its name.
        result: the number of components of its result; 0 unless the result is a vector of two or three numbers.
        given: the number of components of each parameter, counted in the same way.
        kind: the type of its result, as written in the source.
        takes: the type of its first parameter if this is a single 32-bit integer or float; else empty.
        parameters: its parameters, if the compiler reports them.
        results: the numbers and vectors of its result, if the compiler reports them.
    """

    name: str
    result: int
    given: tuple[int, ...]
    kind: str = field(default="", compare=False)
    takes: str = field(default="", compare=False)
    parameters: tuple[Parameter, ...] = field(default=(), compare=False)
    results: tuple[Place, ...] = field(default=(), compare=False)

    @property
    def takes_view(self) -> bool:
        """Whether the function has a second parameter, the view-space position."""
        return len(self.given) == 2

    def called(self, given: str) -> str:
        """Return the text of a call with this argument, and with `view` if the function takes a view position."""
        return f"{self.name}({given}, view)" if self.takes_view else f"{self.name}({given})"

    @property
    def may_encode(self) -> bool:
        """Whether the function takes a normal, perhaps with a view position, and returns two or three numbers."""
        return self.result > 0 and self.takes_a_normal

    @property
    def takes_a_normal(self) -> bool:
        """Whether the function takes a normal, and nothing else except a view-space position."""
        return self.given in ((NORMAL,), (NORMAL, NORMAL))

    @property
    def gives_by_parameter(self) -> bool:
        """Whether the function's first parameter is a vector of two or three numbers and it returns nothing."""
        return self.kind == "void" and self.given[:1] > (0,)

    @property
    def packs(self) -> bool:
        """Whether the function takes a normal, with or without a view-space position, and returns a 32-bit value."""
        return self.takes_a_normal and self.kind in PACKED

    @property
    def unpacks(self) -> bool:
        """Whether the function takes a 32-bit value, with or without a view-space position, and returns a normal."""
        return self.result == NORMAL and self.takes in PACKED and self.given[1:] in ((), (NORMAL,))

    @property
    def given_type(self) -> str:
        """The type of the function's first parameter, in HLSL."""
        return self.takes or f"float{self.given[0]}"

    @property
    def result_type(self) -> str:
        """The type of the function's result, in HLSL."""
        return self.kind if self.kind in PACKED else f"float{self.result}"

    @property
    def may_decode(self) -> bool:
        """Whether the function takes only a code, with or without a view-space position, and returns a normal."""
        return self.result == NORMAL and self.given[:1] > (0,) and self.given[1:] in ((), (NORMAL,))


@dataclass(frozen=True)
class Pair:
    """An encoder and its decoder."""

    encode: Function
    decode: Function

    @property
    def components(self) -> int:
        """The number of components of the code; a 32-bit value counts as two halves."""
        return HALVES if self.is_packed else self.encode.result

    @property
    def is_packed(self) -> bool:
        """Whether the code is a single 32-bit integer or float, which is stored unchanged."""
        return self.encode.packs

    @property
    def named(self) -> str:
        """The name by which the pair is requested: ENCODE:DECODE."""
        return f"{self.encode.name}:{self.decode.name}"


class NoPairError(Exception):
    """No encoder and decoder were found.

    Attributes:
        alone: the known facts about an encoder or a decoder without a partner; empty if there is neither.
    """

    alone: Mapping[str, Any] = MappingProxyType({})


class SeveralPairsError(NoPairError):
    """Several pairs of an encoder and its decoder were found.

    Attributes:
        named: the name by which each pair is requested.
    """

    def __init__(self, file: str, named: Sequence[str]):
        several = "several encoders; name one" if len(named) > 1 else "functions that may be a pair; name them"
        super().__init__(f"it has {several}: {', '.join(f'{file}:{name}' for name in named[:6])}")
        self.named = named


def pair_of(
    functions: Sequence[Function], asked: tuple[str, str] | None = None, file: str = "", own: Collection[str] = ()
) -> Pair:
    """Return the pair of an encoder and its decoder from a file's functions.

    Args:
        file: the file's name in messages.
        asked: the names of the two requested functions; None to find them.
        own: the names of the functions defined in the file itself, rather than in its includes.

    Raises:
        NoPairError: no pair fits.
        SeveralPairsError: several pairs fit; the message names them.
    """
    some = [function for function in functions if not asked or function.name in asked]
    pairs = [pair for pair in _fitting(some) if asked in (None, (pair.encode.name, pair.decode.name))]
    packed = [pair for pair in packed_pairs(some) if asked in (None, (pair.encode.name, pair.decode.name))]
    if asked:
        return _asked(functions, asked, [*pairs, *packed])
    mine = [pair for pair in pairs if pair.encode.name in own and pair.decode.name in own]
    named = _by_name(mine) or _by_name(pairs) or packed
    if not named and (other := _of_something_else(functions, file, (kinds.FRAME,))):
        # Of frames whose helpers are of normals.
        raise NoPairError(other)
    best = named or _by_size(mine) or _by_size(pairs)
    # Others are of colours or motion.
    best = [pair for pair in best if not has_side_of_colours(pair)]
    best = [pair for pair in best if speaks_of_normals(pair)] or [pair for pair in best if not speaks_of_others(pair)]
    # Overloads differ in the view alone.
    names = list(dict.fromkeys(pair.named for pair in best))
    if names and (meant := _by_parameter(functions, best)):
        raise NoPairError(BY_PARAMETER.format(meant))
    if len(names) == 1 and (named or not _is_half_named(best[0])):
        return best[0]
    if names:
        raise SeveralPairsError(file, names)
    if too_many(*_sides(functions)):
        encoders, decoders = map(len, _sides(functions))
        message = f"{encoders} functions may encode and {decoders} may decode, but no two have matching names"
        raise NoPairError(f"{message}; name two: {file}:ENCODE:DECODE")
    if other := _of_something_else(functions, file):
        raise NoPairError(other)
    wanted = "float2 (or float3) ENCODE(float3 n) and float3 DECODE(float2 code)"
    raise NoPairError(f"{_none_fits(functions)}; the two functions must be {wanted}")


def _is_half_named(pair: Pair) -> bool:
    """Whether only one of the two names shows its function's role; the other function may be for something else."""
    return bool(role(pair.encode.name)) != bool(role(pair.decode.name))


def _fitting(functions: Sequence[Function]) -> Iterator[Pair]:
    """Yield the pairs of functions whose types match; if there are too many of them, only those with equal stems."""
    encoders, decoders = _sides(functions)
    needs_name = too_many(encoders, decoders)
    for encode, decode in itertools.product(encoders, decoders):
        is_named = not needs_name or stem(encode.name) == stem(decode.name)
        if is_named and decode.given[0] == encode.result and encode.name != decode.name:
            yield Pair(encode, decode)


def _sides(functions: Sequence[Function]) -> tuple[list[Function], list[Function]]:
    return [function for function in functions if function.may_encode], [
        function for function in functions if function.may_decode
    ]


def too_many(encoders: Sequence[Function], decoders: Sequence[Function]) -> bool:
    """Whether there are too many encoders and decoders to try all pairs of them."""
    return len(encoders) * len(decoders) > MOST_PAIRED


def packed_pairs(defined: Sequence[Function]) -> list[Pair]:
    """Return the pairs named as encoder and decoder whose code is a single 32-bit value of the same type."""
    sides = [function for function in defined if function.packs], [function for function in defined if function.unpacks]
    alike = (both for both in itertools.product(*sides) if stem(both[0].name) == stem(both[1].name))
    return _by_name([Pair(encoder, other) for encoder, other in alike if encoder.kind == other.takes])


def _asked(functions: Sequence[Function], asked: tuple[str, str], pairs: Sequence[Pair]) -> Pair:
    if pairs:
        return pairs[0]
    missing = [name for name in asked if name not in {candidate.name for candidate in functions}]
    if missing:
        known = ", ".join(dict.fromkeys(candidate.name for candidate in functions)) or "none"
        raise NoPairError(f"unknown function {missing[0]}; known: {known}")
    for function in functions:
        if function.name in asked and function.gives_by_parameter:
            raise NoPairError(BY_PARAMETER.format(function.name))
    encode, decode = asked
    raise NoPairError(f"{encode} must take a float3 and return what {decode} takes; {decode} must return a float3")


def _by_name(pairs: Sequence[Pair]) -> list[Pair]:
    """Return the pairs whose names show an encoder and a decoder; if any of them share a stem, only these."""
    named = [pair for pair in pairs if role(pair.encode.name) == "encode" and role(pair.decode.name) == "decode"]
    same = [pair for pair in named if stem(pair.encode.name) == stem(pair.decode.name)]
    return same or named


def _by_parameter(functions: Sequence[Function], best: Sequence[Pair]) -> str:
    """Return the name of a function that returns nothing but is named as the partner of a function in the best pairs;
    empty if there is no such function.

    A function that returns a code in its place is probably one of its helpers.
    """
    if any(stem(pair.encode.name) == stem(pair.decode.name) for pair in best):
        return ""
    sides = {(role(function.name), stem(function.name)) for pair in best for function in (pair.encode, pair.decode)}
    other = {"encode": "decode", "decode": "encode"}
    voids = (function.name for function in functions if function.gives_by_parameter)
    return next((name for name in voids if (other.get(role(name)), stem(name)) in sides), "")


def speaks_of_normals(pair: Pair) -> bool:
    """Whether a pair's names show that it is for normals."""
    return name_speaks_of_normals(pair.named)


def name_speaks_of_normals(name: str) -> bool:
    """Whether a function's name shows that it is for normals."""
    return any(word in name.lower() for word in NORMALS)


def has_side_of_colours(pair: Pair) -> bool:
    """Whether one function's name refers to normals and the other function's name to colours."""
    sides = pair.encode.name, pair.decode.name
    is_of_colours = [bool(OF_COLOURS & words_in(name)) and not name_speaks_of_normals(name) for name in sides]
    return any(is_of_colours) and speaks_of_normals(pair)


def speaks_of_others(pair: Pair) -> bool:
    """Whether a pair's names show that it is for something other than normals."""
    named = f"{pair.encode.name} {pair.decode.name}"
    kind = kind_spoken_of(named)
    # A code of two numbers is of a direction, such as that to a light.
    is_of_another = bool(kind) and not (kind is kinds.LIGHT and pair.components < NORMAL)
    return not speaks_of_normals(pair) and (bool(OF_COLOURS & words_in(named)) or is_of_another)


def _by_size(pairs: Sequence[Pair]) -> list[Pair]:
    """Return the pairs whose types alone distinguish encoder and decoder, unless their names contradict the types."""
    told = [pair for pair in pairs if pair.components != NORMAL]
    return [pair for pair in told if role(pair.encode.name) != "decode" and role(pair.decode.name) != "encode"]


def _ways(name: str) -> tuple[list[str], list[str]] | None:
    """Return the words for the input and for the output in a function's name, such as NormalToOctahedron or
    oct_from_vec; None if the name does not show them."""
    words = [word.lower() for word in WORD.findall(name)]
    for between in ("to", "from"):
        if between in words[1:-1]:
            index = words.index(between)
            first, last = words[:index], words[index + 1 :]
            return (first, last) if between == "to" else (last, first)
    return None


@cache
def role(name: str) -> str:
    """Return the role that a function's name shows: "encode", "decode", or empty."""
    if ways := _ways(name):
        given, is_code_made = (any(word.startswith(CODES) for word in words) for words in ways)
        if given != is_code_made:
            return "decode" if given else "encode"
    lower = name.lower()
    if any(word in lower for word in DECODES):
        return "decode"
    return "encode" if any(word in lower for word in ENCODES) else ""


@cache
def stem(name: str) -> str:
    """Return a function's name, in lower case, without words for encoding or decoding; two functions with the same
    stem belong together."""
    if ways := _ways(name):
        return " ".join(sorted(" ".join(words) for words in ways))
    return re.sub("|".join((*DECODES, *ENCODES, "_")), "", name.lower())


def alone(functions: Sequence[Function]) -> Pair | None:
    """Return a file's only encoder or decoder, paired with a nameless function; None if there are several or none."""
    encoders = [function for function in functions if function.may_encode and role(function.name) == "encode"]
    decoders = [function for function in functions if function.may_decode and role(function.name) == "decode"]
    if len(encoders) + len(decoders) != 1:
        return None
    size = encoders[0].result if encoders else decoders[0].given[0]
    return Pair(*(encoders or [Function("", size, (NORMAL,))]), *(decoders or [Function("", NORMAL, (size,))]))


def _of_something_else(functions: Sequence[Function], file: str, among: Collection[kinds.Kind] = kinds.KINDS) -> str:
    """Return a message if function names show that a file without a pair encodes something else; else empty."""
    for name in (function.name for function in functions if role(function.name)):
        if (kind := kind_spoken_of(name)) and kind in among and not name_speaks_of_normals(name):
            return OF_OTHERS.format(name, kind.plural, kinds.NORMAL.plural, kind.command.format(file))
    return ""


def _none_fits(functions: Sequence[Function]) -> str:
    encoders = [candidate.name for candidate in functions if candidate.may_encode and role(candidate.name) != "decode"]
    decoders = [candidate.name for candidate in functions if candidate.may_decode and role(candidate.name) != "encode"]
    for function in functions:
        if function.gives_by_parameter and role(function.name):
            return BY_PARAMETER.format(function.name)
    others = [
        candidate
        for candidate in functions
        if candidate.takes_a_normal and not candidate.result and role(candidate.name) == "encode"
    ]
    if others and not encoders:
        return f"{others[0].name} returns a {others[0].kind}, but a code must have two or three unpacked numbers"
    if encoders and not decoders:
        return f"{encoders[0]} has no decoder"
    if decoders and not encoders:
        return f"{decoders[0]} has no encoder"
    return NO_PAIR
