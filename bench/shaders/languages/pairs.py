"""The two functions of a file that are an encoder and its decoder, found by their types and their names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

# Result, name and parameters of a definition.
_FUNCTION = re.compile(r"(?<![\w.])([A-Za-z_]\w*)\s+([A-Za-z_]\w*)\s*\(([^(){};]*)\)\s*(?::\s*\w+\s*)?\{")
# Slang's other way to write it: func NAME(n : float3) -> float2.
_ARROW = re.compile(r"\bfunc\s+(\w+)\s*\(([^(){};]*)\)\s*->\s*(\w+)\s*\{")
_TYPEDEF = re.compile(r"\btypedef\s+(\w+)\s+(\w+)\s*;")
_GENERIC = re.compile(r"\bvector\s*<\s*(?:float|half)\s*,\s*([1-4])\s*>")
_VECTOR = re.compile(r"(?:float|half|min16float|min10float|float16_t|vec)([23])")
_QUALIFIERS = {"in", "const", "uniform", "precise", "static", "inline"}
NORMAL = 3
# Of a function's name, in lower case. Those of a decoder are looked for first: "unpack" has "pack" in it, and
# UnpackNormalOctRectEncode of Unity's HDRP decodes.
DECODES, ENCODES = ("unpack", "decode", "decompress"), ("pack", "encode", "compress")

# In the name of a function that takes or gives a normal, in lower case.
NORMALS = ("norm", "nrm", "oct", "unitvec", "direction")

BY_PARAMETER = "{} returns nothing; write a function that returns what it gives through its parameter"


@dataclass(frozen=True)
class Function:
    """A function.

    Attributes:
        name: of it.
        result: how many numbers it gives; 0 where that is no vector of two or three.
        given: how many numbers each of its parameters has, likewise.
        kind: the type of its result, as it is written.
    """

    name: str
    result: int
    given: tuple[int, ...]
    kind: str = field(default="", compare=False)

    @property
    def takes_view(self) -> bool:
        """Whether it has a second parameter, the view-space position."""
        return len(self.given) == 2

    def called(self, given: str) -> str:
        """A call of it, in a function that has the position as `view`."""
        return f"{self.name}({given}, view)" if self.takes_view else f"{self.name}({given})"

    @property
    def may_encode(self) -> bool:
        """Whether it is of a normal, and of a view-space position if of anything else."""
        return self.result > 0 and self.takes_a_normal

    @property
    def takes_a_normal(self) -> bool:
        """Whether it is of a normal, whatever it gives."""
        return self.given in ((NORMAL,), (NORMAL, NORMAL))

    @property
    def gives_by_parameter(self) -> bool:
        """Whether it is of a vector, and returns nothing."""
        return self.kind == "void" and self.given[:1] > (0,)

    @property
    def may_decode(self) -> bool:
        """Whether it gives a normal, of a code and of a view-space position if of anything else."""
        return self.result == NORMAL and self.given[:1] > (0,) and self.given[1:] in ((), (NORMAL,))


@dataclass(frozen=True)
class Pair:
    """An encoder and its decoder."""

    encode: Function
    decode: Function

    @property
    def components(self) -> int:
        """How many numbers their code has."""
        return self.encode.result

    @property
    def named(self) -> str:
        """How it is asked for."""
        return f"{self.encode.name}:{self.decode.name}"


class NoPairError(Exception):
    """There are no two functions that are an encoder and its decoder, or several such pairs."""


def functions(text: str) -> list[Function]:
    """The functions that a preprocessed text in HLSL or Slang defines, outside of structs."""
    text = _ARROW.sub(_as_in_c, _GENERIC.sub(r"float\1", text))
    types = {new: old for old, new in _TYPEDEF.findall(text)}
    found: dict[Function, None] = {}
    for result, name, parameters in _at_the_top(text):
        given = tuple(_size(_type_of(one), types) for one in parameters.split(","))
        found[Function(name, _size(result, types), given, result)] = None
    return list(found)


def _as_in_c(match: re.Match[str]) -> str:
    name, parameters, result = match.groups()
    turned = (" ".join(reversed(one.split(":"))) for one in parameters.split(","))
    return f"{result} {name}({', '.join(turned)}) {{"


def _at_the_top(text: str) -> Iterator[tuple[str, str, str]]:
    """Result, name and parameters of the definitions that stand in no other."""
    depth, last = 0, 0
    for match in _FUNCTION.finditer(text):
        depth += text.count("{", last, match.start()) - text.count("}", last, match.start())
        last = match.start()
        if not depth:
            yield match[1], match[2], match[3]


def _type_of(parameter: str) -> str:
    """The type of a parameter: `in float3 n : NORMAL` has float3; `inout float3 n` is of none."""
    words = [word for word in parameter.partition(":")[0].split() if word not in _QUALIFIERS]
    return words[0] if len(words) == 2 else ""


def _size(kind: str, types: dict[str, str]) -> int:
    """How many numbers a type has; 0 where it is no vector of two or three."""
    match = _VECTOR.fullmatch(types.get(kind, kind))
    return int(match[1]) if match else 0


def pair_of(found: Sequence[Function], asked: tuple[str, str] | None = None, file: str = "") -> Pair:
    """The pair among functions.

    Args:
        file: what messages call the file.
        asked: the names of the two that are meant; None to find them.

    Raises:
        NoPairError: none fits, or several do; the message names them.
    """
    pairs = [pair for pair in _fitting(found) if asked in (None, (pair.encode.name, pair.decode.name))]
    if asked:
        return _asked(found, asked, pairs)
    best = sorted(_by_name(pairs) or _by_size(pairs), key=lambda pair: not speaks_of_normals(pair))
    # Overloads differ in the view alone.
    names = list(dict.fromkeys(pair.named for pair in best))
    if names and (meant := _by_parameter(found, best)):
        raise NoPairError(BY_PARAMETER.format(meant))
    if len(names) == 1:
        return best[0]
    if names:
        raise NoPairError(f"it has several encoders; name one: {', '.join(f'{file}:{one}' for one in names[:6])}")
    wanted = "float2 (or float3) ENCODE(float3 n) and float3 DECODE(float2 code)"
    raise NoPairError(f"{_none_fits(found)}; the two functions must be {wanted}")


def _fitting(found: Sequence[Function]) -> Iterator[Pair]:
    for encode in (one for one in found if one.may_encode):
        for decode in (one for one in found if one.may_decode and one.given[0] == encode.result):
            if encode.name != decode.name:
                yield Pair(encode, decode)


def _asked(found: Sequence[Function], asked: tuple[str, str], pairs: Sequence[Pair]) -> Pair:
    if pairs:
        return pairs[0]
    missing = [name for name in asked if name not in {one.name for one in found}]
    if missing:
        known = ", ".join(dict.fromkeys(one.name for one in found)) or "none"
        raise NoPairError(f"no function is named {missing[0]}; there are: {known}")
    for one in found:
        if one.name in asked and one.gives_by_parameter:
            raise NoPairError(BY_PARAMETER.format(one.name))
    raise NoPairError(f"{asked[0]} must take a float3 and give what {asked[1]} takes; {asked[1]} must give a float3")


def _by_name(pairs: Sequence[Pair]) -> list[Pair]:
    """Those of an encoder and a decoder by their names; of these, those whose names are the same otherwise."""
    named = [pair for pair in pairs if role(pair.encode.name) == "encode" and role(pair.decode.name) == "decode"]
    same = [pair for pair in named if stem(pair.encode.name) == stem(pair.decode.name)]
    return same or named


def _by_parameter(found: Sequence[Function], best: Sequence[Pair]) -> str:
    """The function that is the partner by its name of one in the best pairs, but returns nothing; else empty.

    What returns a code in its place is likely a helper of it.
    """
    if any(stem(pair.encode.name) == stem(pair.decode.name) for pair in best):
        return ""
    sides = {(role(one.name), stem(one.name)) for pair in best for one in (pair.encode, pair.decode)}
    other = {"encode": "decode", "decode": "encode"}
    voids = (one.name for one in found if one.gives_by_parameter)
    return next((name for name in voids if (other.get(role(name)), stem(name)) in sides), "")


def speaks_of_normals(pair: Pair) -> bool:
    """Whether the names of a pair say that it is of normals, and not of colours or motion."""
    return any(word in pair.named.lower() for word in NORMALS)


def _by_size(pairs: Sequence[Pair]) -> list[Pair]:
    """Those whose types alone tell encoder and decoder apart."""
    return [pair for pair in pairs if pair.components != NORMAL]


def role(name: str) -> str:
    """What a function is by its name: "encode", "decode", or empty."""
    lower = name.lower()
    if any(word in lower for word in DECODES):
        return "decode"
    return "encode" if any(word in lower for word in ENCODES) else ""


def stem(name: str) -> str:
    """A function's name without what says that it encodes or decodes."""
    return re.sub("|".join((*DECODES, *ENCODES, "_")), "", name.lower())


def _none_fits(found: Sequence[Function]) -> str:
    encoders = [one.name for one in found if one.may_encode and role(one.name) != "decode"]
    decoders = [one.name for one in found if one.may_decode and role(one.name) != "encode"]
    for one in found:
        if one.gives_by_parameter and role(one.name):
            return BY_PARAMETER.format(one.name)
    others = [one for one in found if one.takes_a_normal and not one.result and role(one.name) == "encode"]
    if others and not encoders:
        return f"{others[0].name} gives a {others[0].kind}, but a code is two or three numbers that are not packed yet"
    if encoders and not decoders:
        return f"{encoders[0]} has no decoder"
    if decoders and not encoders:
        return f"{decoders[0]} has no encoder"
    return "no encoder and decoder found"
