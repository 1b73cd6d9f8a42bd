"""The two functions of a file that encode and decode something other than normals, and adapters that call them.

    float4 Encode_e(float4 n, float3 view)      float4 Decode_d(float4 n, float3 view)

A program calls the adapters, whatever the user's functions take and return: see `shapes.py`.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ....encodings.kinds import LIGHT, NORMAL, Kind, kind_spoken_of, words_in
from .pairs import (
    NORMALS,
    OF_COLOURS,
    OF_OTHERS,
    PACKED,
    Function,
    NoPairError,
    Place,
    SeveralPairsError,
    role,
    stem,
)
from .shapes import SHAPES, CodeArgument, Shape
from .wiring import inputs_of, outputs_of

# What an adapter is given and gives: seven numbers, and four.
GIVEN, MADE = (4, 3), 4
# Makes the text of an adapter in a language: see `wiring.adapter`.
Adapter = Callable[[Function, str, Mapping[str, str], Sequence[Place | None]], str]


@dataclass(frozen=True)
class Fitted:
    """A function that matches a shape.

    Attributes:
        function: the function.
        given: the shape's argument for each input of the function, without structure fields that match no argument.
        made: the output of the function for each argument of the shape.
    """

    function: Function
    given: Mapping[Place, CodeArgument]
    made: Mapping[CodeArgument, Place]

    def size(self, part: str) -> int:
        """Return the number of components of the part with this name; 0 if the function lacks the part."""
        both = [*((part, place) for place, part in self.given.items()), *self.made.items()]
        return next((place.size for argument, place in both if argument.name == part), 0)


@dataclass(frozen=True)
class ShapedPair:
    """An encoder and its decoder, matched to a shape."""

    shape: Shape
    encode: Fitted
    decode: Fitted

    @property
    def named(self) -> str:
        """The name by which the pair is requested: ENCODE:DECODE."""
        return f"{self.encode.function.name}:{self.decode.function.name}"

    @property
    def components(self) -> int:
        """The number of components of the code."""
        return self.encode.size(self.shape.code.name)

    @property
    def settings(self) -> list[str]:
        """The names of the settings that either function takes."""
        return [
            setting.name
            for setting in self.shape.settings
            if any(f.size(setting.name) for f in (self.encode, self.decode))
        ]

    @property
    def parts(self) -> dict[str, list[int]]:
        """By part, the numbers of components that the encoder takes and that the decoder returns; 0 for none."""
        return {part.name: [side.size(part.name) for side in (self.encode, self.decode)] for part in self.shape.parts}

    def sides(self, adapter: Adapter) -> dict[str, tuple[Function, str]]:
        """Return the adapters, each as a function and its text, by the letter in their names; e is the encoder's."""
        by_letter = {"e": _adapted(self.encode, "e", (self.shape.code.name,), adapter)}
        for letter, names in zip(LETTERS, self.shape.results, strict=False):
            by_letter[letter] = _adapted(self.decode, letter, names, adapter)
        return by_letter


# What a program calls the adapters of a decoder by.
LETTERS = "dtb"


def _adapted(fitted: Fitted, letter: str, results: Sequence[str], adapter: Adapter) -> tuple[Function, str]:
    """Return an adapter, which calls a function, takes seven numbers and returns four, together with its text.

    Args:
        letter: the last letter of the adapter's name.
        results: the names of the parts that the adapter returns, in order."""
    name = f"{fitted.function.name.replace('::', '_')}_{letter}"
    given = {place.path: part.sizes[place.size] for place, part in fitted.given.items()}
    places = {part.name: place for part, place in fitted.made.items()}
    text = adapter(fitted.function, name, given, [places.get(result) for result in results])
    return Function(name, MADE, GIVEN, f"float{MADE}"), text


def shaped_pair(
    functions: Sequence[Function],
    kind: Kind,
    asked: tuple[str, str] | None = None,
    file: str = "",
    own: Collection[str] = (),
) -> ShapedPair:
    """Return the pair for a kind of value from a file's functions; the other arguments are as for `pairs.pair_of`.

    Raises:
        NoPairError: no pair fits.
        SeveralPairsError: several pairs fit; the message names them.
    """
    every = list(_all_pairs(functions, kind, asked))
    if asked and not every:
        raise NoPairError(_why_not(functions, kind, asked))
    mine = [pair for pair in every if {pair.encode.function.name, pair.decode.function.name} <= set(own)]
    best = _likeliest(mine, kind) or _likeliest(every, kind)
    named = {pair.named: pair for pair in reversed(best if not asked else every)}
    if len(named) > 1:
        raise SeveralPairsError(file, list(reversed(named)))
    if not named:
        raise NoPairError(_why_none(functions, kind, file))
    return next(iter(named.values()))


def _all_pairs(functions: Sequence[Function], kind: Kind, asked: tuple[str, str] | None) -> Iterator[ShapedPair]:
    for shape in SHAPES[kind]:
        encoders = [function for function in functions if _may_be(function, "encode", asked)]
        decoders = [function for function in functions if _may_be(function, "decode", asked)]
        forward = [fit for function in encoders if (fit := _fitted(function, shape.parts, (shape.code,), shape))]
        back = [fit for function in decoders if (fit := _fitted(function, (shape.code,), shape.parts, shape))]
        code = shape.code.name
        for encoder, other in itertools.product(forward, back):
            if encoder.size(code) == other.size(code):
                yield ShapedPair(shape, encoder, other)


def _may_be(function: Function, side: str, asked: tuple[str, str] | None) -> bool:
    """Whether a function is requested for a side ("encode" or "decode") or, without a request, has that role."""
    return function.name == asked[side == "decode"] if asked else role(function.name) == side


def _fitted(
    function: Function, given: Sequence[CodeArgument], returned: Sequence[CodeArgument], shape: Shape
) -> Fitted | None:
    """Return a function matched to these inputs and outputs; None if it does not match."""
    inputs = _assigned(inputs_of(function), [*given, *shape.settings])
    outputs = _assigned(outputs_of(function), returned)
    if inputs is None or outputs is None:
        return None
    return Fitted(function, inputs, {part: place for place, part in outputs.items()})


def _assigned(places: Sequence[Place], parts: Sequence[CodeArgument]) -> dict[Place, CodeArgument] | None:
    """Match places to parts, by name and then by order, and return the part for each place; None if a required part
    or a place remains unmatched.

    Structure fields may remain unmatched. A place matches a part only if it holds floats and has a size that the part
    allows.
    """
    assigned: dict[Place, CodeArgument] = {}
    likely = sorted(
        ((_likeness(place, part), place, part) for place in places for part in parts if _fits(place, part)),
        key=lambda candidate: -candidate[0],
    )
    for letters, place, part in likely:
        if letters and place not in assigned and part not in assigned.values():
            assigned[place] = part
    for part in sorted(parts, key=lambda part: not part.is_needed):
        left = [place for place in places if place not in assigned and _fits(place, part)]
        if part not in assigned.values() and left and (part.is_needed or "." not in left[0].path):
            assigned[left[0]] = part
    is_whole = all(part in assigned.values() for part in parts if part.is_needed)
    is_used = all(place in assigned or "." in place.path for place in places)
    return {place: assigned[place] for place in places if place in assigned} if is_whole and is_used else None


def _fits(place: Place, part: CodeArgument) -> bool:
    return place.kind == "float" and place.size in part.sizes


def _likeness(place: Place, part: CodeArgument) -> int:
    return part.likeness(place.path.rpartition(".")[2].lower())


def _likeliest(pairs: Sequence[ShapedPair], kind: Kind) -> list[ShapedPair]:
    """Return the pairs whose names refer to the kind or, if there are none, those whose names refer to no kind;
    preferably with the same stem, and all of one shape."""
    same = [pair for pair in pairs if stem(pair.encode.function.name) == stem(pair.decode.function.name)] or pairs
    spoken = [pair for pair in same if kind_spoken_of(pair.named) is kind]
    silent = [pair for pair in same if not kind_spoken_of(pair.named) and not _is_of_colours(pair, kind)]
    best = spoken or silent
    # Of two shapes of a kind the first one that fits.
    return [pair for pair in best if pair.shape == best[0].shape]


def _is_of_colours(pair: ShapedPair, kind: Kind) -> bool:
    return kind is not LIGHT and bool(OF_COLOURS & words_in(pair.named))


def _why_not(functions: Sequence[Function], kind: Kind, asked: tuple[str, str]) -> str:
    """Return a message on why the two requested functions are not a pair."""
    names = {function.name for function in functions}
    if missing := [name for name in asked if name not in names]:
        return f"unknown function {missing[0]}; known: {', '.join(dict.fromkeys(names)) or 'none'}"
    return f"{asked[0]} and {asked[1]} are not a pair for {kind.plural}; the two functions must be {_wanted(kind)}"


def _why_none(functions: Sequence[Function], kind: Kind, file: str) -> str:
    """Return a message on why a file's functions include no pair for a kind."""
    wanted = f"the two functions must be {_wanted(kind)}"
    sides = {side: [function for function in functions if role(function.name) == side] for side in ("encode", "decode")}
    spoken = [function for several in sides.values() for function in several]
    of_kind = [function for function in spoken if not _other_kind(function.name, kind)]
    if spoken and not of_kind:
        other = _other_kind(spoken[0].name, kind) or NORMAL
        return OF_OTHERS.format(spoken[0].name, other.plural, kind.plural, other.command.format(file))
    if packs := next((function for function in of_kind if function.kind in PACKED[:2]), None):
        return f"{packs.name} returns a {packs.kind}, but a code of {kind.plural} must be one or more floats; {wanted}"
    for side, other in (("encode", "decode"), ("decode", "encode")):
        if sides[side] and not sides[other]:
            return f"{sides[side][0].name} has no {other}r; {wanted}"
    if of_kind:
        return f"{of_kind[0].name} and its partner have the wrong types for {kind.plural}; {wanted}"
    return f"no encoder and decoder found; {wanted}"


def _other_kind(name: str, kind: Kind) -> Kind | None:
    """Return the kind to which a function's name refers; None if this is `kind`, or if the name refers to none."""
    spoken = kind_spoken_of(name)
    if spoken is kind:
        return None
    return spoken or (NORMAL if any(word in name.lower() for word in NORMALS) else None)


def _wanted(kind: Kind) -> str:
    return "; or ".join(shape.wanted for shape in SHAPES[kind])
