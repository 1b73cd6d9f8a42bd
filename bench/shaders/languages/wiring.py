"""Wirings: functions with more inputs and outputs than a normal and its code, called as an encoder and its decoder.

    Pack(s.normalWS=n; s.roughness=0.5)->o1.xyz
    Unpack(o1.xyz=e)->s.normalWS

Each line binds a function's inputs, and names the place of the code or the normal in its output: `n` is the normal,
`e` the code, `view` the view-space position. `->(n.xy; face)` is a code in two places. Unbound inputs have the values
in `FREE`.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from .pairs import (
    NORMAL,
    NORMALS,
    PACKED,
    Function,
    NoPairError,
    Pair,
    Place,
    has_side_of_colours,
    role,
    speaks_of_others,
    stem,
    too_many,
)

# A function's name with what it is given and gives.
TEXT = re.compile(r"(?P<name>(?:\w+::)*\w+)(?:\((?P<bound>[^()]*)\))?(?:->(?P<made>[\w.]+|\([^()]*\)))?")
_PLACE = re.compile(r"[A-Za-z_][\w.]*")
_VALUE = re.compile(r"(?:n|e|view)(?:\.[xyzw]{1,4})?|true|false|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
# What is not bound: numbers of a material are in the middle of what they may be.
FREE: Mapping[str, str] = MappingProxyType({"float": "0.5", "uint": "0", "int": "0", "bool": "false"})
N, CODE, VIEW = "n", "e", "view"
# Names, in lower case, of the view-space position or the way to it.
OF_VIEW = ("view", "pos", "eye", "camera")
RESULT = "normalbench_result"
# Where a code may be in four numbers.
SWIZZLES = ("xy", "xyz", "xyw", "zw", "yzw")


@dataclass(frozen=True)
class Wiring:
    """The inputs and outputs of a function call.

    Attributes:
        function: the function's name.
        bound: the places of inputs with their values: n, view, e, a part such as e.xy, or a number.
        made: the places in the output that hold the code or the normal; empty for the whole result.
    """

    function: str
    bound: tuple[tuple[str, str], ...] = ()
    made: tuple[str, ...] = ()

    def __str__(self) -> str:
        bound = f"({'; '.join(f'{place}={value}' for place, value in self.bound)})" if self.bound else ""
        output = "".join(self.made) if len(self.made) == 1 else f"({'; '.join(self.made)})"
        return f"{self.function}{bound}{f'->{output}' if self.made else ''}"

    @property
    def is_plain(self) -> bool:
        """Whether only the function's name is given, without inputs and outputs."""
        return not (self.bound or self.made)


def wiring_of(text: str) -> Wiring:
    """Return the wiring in a text such as `Pack(s.normal=n; s.roughness=0.5)->o1.xyz`. Raises NoPairError."""
    match = TEXT.fullmatch(text)
    parts = [part.partition("=") for part in re.split(r"[;,]", match["bound"] or "") if part.strip()] if match else []
    if not match or not all(
        _PLACE.fullmatch(place.strip()) and _VALUE.fullmatch(value.strip()) for place, _, value in parts
    ):
        raise NoPairError(f"{text} is not in the form Pack(s.normal=n; s.roughness=0.5)->o1.xyz")
    outputs = re.split(r"[;,]", (match["made"] or "").strip("()"))
    if wrong := [place.strip() for place in outputs if place.strip() and not _PLACE.fullmatch(place.strip())]:
        raise NoPairError(f"{text}: {wrong[0]!r} is not an output of a function; write for example o1.xyz")
    return Wiring(
        match["name"],
        tuple((place.strip(), value.strip()) for place, _, value in parts),
        tuple(place.strip() for place in outputs if place.strip()),
    )


def wired(pair: Sequence[Wiring], functions: Sequence[Function]) -> tuple[str, Pair]:
    """Return the HLSL text of two functions that call two other functions according to their wirings, and the new
    functions as a pair.

    Raises:
        NoPairError: a wired place does not exist, or does not hold a normal or a code.
    """
    encode, decode = (_function_of(side, functions) for side in pair)
    for wiring, not_given, given in zip(pair, (CODE, N), (N, CODE), strict=True):
        if any(value.partition(".")[0] == not_given for _, value in wiring.bound):
            raise NoPairError(f"{wiring}: {not_given} is not available here; use {given}")
    size, kind = _made(encode, pair[0])
    size_back, kind_back = _made(decode, pair[1])
    if size_back != NORMAL or kind_back != "float":
        raise NoPairError(f"{pair[1]} does not return a normal; name the output, as in {pair[1].function}(...)->n")
    if not (size in (2, 3) and kind == "float") and not (size == 1 and kind in PACKED):
        raise NoPairError(f"{pair[0]} returns a code of {size} numbers; choose two or three, as in ->o1.xy")
    code = kind if size == 1 else f"float{size}"
    text = _caller(encode, pair[0], "float3", N, code) + _caller(decode, pair[1], code, CODE, "float3")
    sizes = ((size if size > 1 else 0), NORMAL), (NORMAL, size if size > 1 else 0)
    (made_e, given_e), (made_d, given_d) = sizes
    takes = code if size == 1 else ""
    views = [(NORMAL,) if _uses_view(side) else () for side in pair]
    return text, Pair(
        Function(_name(encode), made_e, (given_e, *views[0]), code),
        Function(_name(decode), made_d, (given_d, *views[1]), "float3", takes),
    )


def _function_of(wiring: Wiring, functions: Sequence[Function]) -> Function:
    several = [function for function in functions if function.name == wiring.function]
    if not several:
        known = ", ".join(dict.fromkeys(function.name for function in functions)) or "none"
        raise NoPairError(f"unknown function {wiring.function}; known: {known}")
    places = {place for place, _ in wiring.bound}
    return next((function for function in several if places <= set(_all_paths(function))), several[0])


def _all_paths(function: Function) -> Iterator[str]:
    for place in (place for parameter in function.parameters for place in parameter.places):
        yield place.path
        yield from (f"{place.path}.{swizzle}" for swizzle in _swizzles(place.size))


def _swizzles(size: int) -> Iterator[str]:
    return ("".join(letters) for count in range(1, 5) for letters in itertools.permutations("xyzw"[:size], count))


def outputs_of(function: Function) -> list[Place]:
    """Return the numbers and vectors that a function outputs: those of its result, then those of its output
    parameters."""
    outputs = [place for parameter in function.parameters if parameter.is_made for place in parameter.places]
    return [*function.results, *outputs]


def _output(function: Function, path: str) -> Place:
    """Return the place at a path in a function's output, which may be a part such as o1.xy. Raises NoPairError."""
    for place in outputs_of(function):
        if path == place.path:
            return place
        # Of a result that is a vector, xyz is a part.
        whole, _, letters = path.rpartition(".")
        if whole == place.path and letters in set(_swizzles(place.size)):
            return Place(path, place.kind, len(letters))
    known = ", ".join(place.path or "its result" for place in outputs_of(function)) or "nothing"
    raise NoPairError(f"{function.name} does not return {path}; it returns {known}")


def _made(function: Function, wiring: Wiring) -> tuple[int, str]:
    """Return how many numbers a wired function outputs in total, and their type; "float" for several places."""
    places = [_output(function, path) for path in wiring.made] or outputs_of(function)
    kinds = {place.kind for place in places}
    return sum(place.size for place in places), kinds.pop() if len(places) == 1 else "float"


def _name(function: Function) -> str:
    return f"{function.name.replace('::', '_')}_wired"


def _uses_view(wiring: Wiring) -> bool:
    return any(value.partition(".")[0] == VIEW for _, value in wiring.bound)


def _caller(function: Function, wiring: Wiring, given: str, called: str, returned: str) -> str:
    """Return the HLSL text of a function that calls another function according to its wiring. Raises NoPairError.

    Args:
        given, called: the type and the name of the new function's input.
        returned: the type of its result.
    """
    known = set(_all_paths(function))
    if unknown := next((place for place, _ in wiring.bound if place not in known), ""):
        raise NoPairError(
            f"{function.name} has no input {unknown}; its inputs are {', '.join(p.path for p in inputs_of(function))}"
        )
    bound = {path: _value(function, path, value) for path, value in wiring.bound}
    view = f", float3 {_local(VIEW)}_given" if _uses_view(wiring) else ""
    head = f"{returned} {_name(function)}({given} {_local(called)}_given{view})"
    result = ", ".join(_local(path) if path else RESULT for path in _made_paths(function, wiring))
    return _body(function, head, bound, f"{returned}({result})")


def _body(function: Function, head: str, bound: Mapping[str, str], expression: str) -> str:
    """Return the HLSL text of a function with this head that calls another function and returns `expression`, which
    uses the results of the call.

    Args:
        bound: the values of the called function's inputs, by place.
    """
    asked = {place.partition(".")[0] for place in bound}
    parameters = list(itertools.takewhile(lambda p: not p.has_default or p.name in asked, function.parameters))
    lines = [f"{parameter.kind} {_local(parameter.name)} = ({parameter.kind})0;" for parameter in parameters]
    lines += [
        f"{_local(place.path)} = {FREE[place.kind]};"
        for parameter in parameters
        if parameter.is_given
        for place in parameter.places
    ]
    lines += [f"{_local(place)} = {value};" for place, value in bound.items()]
    call = f"{function.name}({', '.join(_local(parameter.name) for parameter in parameters)})"
    lines.append(f"{function.kind} {RESULT} = {call};" if function.results else f"{call};")
    body = "\n    ".join([*lines, f"return {expression};"])
    return f"{head} {{\n    {body}\n}}\n"


def adapter(function: Function, name: str, given: Mapping[str, str], places: Sequence[Place | None]) -> str:
    """Return the HLSL text of an adapter, which takes four numbers, n, and three, view, calls another function and
    returns four numbers.

    Args:
        given: the values of the other function's inputs, as GLSL expressions of n and view, by the input's path.
        places: the places of the other function's outputs, in order; None stands for 0.
    """
    words = {"n": f"{_local(N)}_given", "view": f"{_local(VIEW)}_given", "vec4": "float4"}
    bound = {path: with_words(value, words) for path, value in given.items()}
    of_result = {place.path for place in function.results}
    paths = [place and _of_result(place.path, of_result) for place in places]
    parts = [("0.0" if path is None else _local(path) if path else RESULT) for path in paths]
    parts += ["0.0"] * (4 - sum(place.size if place else 1 for place in places))
    return _body(
        function, f"float4 {name}(float4 {words['n']}, float3 {words['view']})", bound, f"float4({', '.join(parts)})"
    )


def with_words(text: str, words: Mapping[str, str]) -> str:
    """Return a text with each word that is a key replaced by its value; swizzles do not change."""
    return re.sub(rf"(?<![.\w])(?:{'|'.join(words)})\b", lambda match: words[match[0]], text)


def _made_paths(function: Function, wiring: Wiring) -> list[str]:
    of_result = {place.path for place in function.results}
    return [_of_result(path, of_result) for path in wiring.made or [place.path for place in outputs_of(function)]]


def _of_result(path: str, of_result: set[str]) -> str:
    """Return a path in the form that programs use: with a leading dot if it is in the function's result, else
    unchanged.

    Args:
        of_result: the paths of the result's places."""
    whole = path.rpartition(".")[0]
    return f".{path}" if path and {path, whole} & of_result else path


def _local(path: str) -> str:
    """Return the name of the variable for a parameter, for a part of a parameter, or for a part of the result."""
    return f"{RESULT}{path}" if path.startswith(".") else f"wired_{path}"


def inputs_of(function: Function) -> list[Place]:
    return [place for parameter in function.parameters if parameter.is_given for place in parameter.places]


def _value(function: Function, path: str, value: str) -> str:
    """Return the HLSL text of a wiring's value for the input at `path`: a number unchanged; n, e and view as the
    caller's parameter, whose parts are rounded for integer inputs."""
    name, _, letters = value.partition(".")
    if name not in (N, CODE, VIEW):
        return value
    given = f"{_local(name)}_given{f'.{letters}' if letters else ''}"
    kind = next(
        (place.kind for parameter in function.parameters for place in parameter.places if place.path == path), "float"
    )
    # A whole number may come back from a storage a little less.
    return f"({kind})({given} + 0.5)" if kind in ("uint", "int") and letters else given


# A code's places in what an encoder gives, and by its place what of the code a decoder is given.
_Ways = Iterator[tuple[tuple[str, ...], tuple[tuple[str, str], ...]]]


def candidates(functions: Sequence[Function]) -> list[tuple[Wiring, Wiring]]:
    """Return the wirings with which functions, by their names, may be an encoder and its decoder; likeliest first."""
    encoders = [function for function in functions if role(function.name) == "encode" and function.parameters]
    decoders = [function for function in functions if role(function.name) == "decode" and function.parameters]
    alike = [(encoder, other) for encoder in encoders for other in decoders if stem(encoder.name) == stem(other.name)]
    both = _of_normals(alike)
    if not both and not too_many(encoders, decoders):
        both = _of_normals([(encoder, other) for encoder in encoders for other in decoders])
    return [wirings for encoder, other in both for wirings in sorted(_wirings(encoder, other), key=_is_of_other_names)]


def _of_normals(pairs: Sequence[tuple[Function, Function]]) -> list[tuple[Function, Function]]:
    """Return the pairs whose names do not show an encoding of something other than normals."""
    return [pair for pair in pairs if not speaks_of_others(Pair(*pair)) and not has_side_of_colours(Pair(*pair))]


def _is_of_other_names(wirings: tuple[Wiring, Wiring]) -> bool:
    """Whether the code's places have different names in the two functions; upper and lower case are equal."""
    encode, decode = wirings
    outputs = {place.partition(".")[0].lower() for place in encode.made}
    given = {place.partition(".")[0].lower() for place, value in decode.bound if value.partition(".")[0] == CODE}
    return outputs != given


def _wirings(encode: Function, decode: Function) -> Iterator[tuple[Wiring, Wiring]]:
    normal, back = _normal_of(inputs_of(encode)), _normal_of(outputs_of(decode))
    if not normal or not back:
        return
    made_back = _named(decode, back.path if back.size == NORMAL else f"{back.path}.xyz".strip("."), NORMAL)
    bound = ((normal.path, N), *_free(encode, [normal.path]))
    for outputs, given in _codes(encode, decode, normal):
        rest = _free(decode, [place for place, _ in given])
        yield (
            Wiring(encode.name, bound, outputs),
            Wiring(decode.name, (*given, *rest), made_back),
        )


def _named(function: Function, path: str, size: int) -> tuple[str, ...]:
    """Return a wiring's path for an output, as a tuple; empty for a result that is the only output."""
    return (path,) if path else ("xyz"[:size],) if len(outputs_of(function)) > 1 else ()


def _free(function: Function, taken: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield (path, value) for the inputs of a function that are not in `taken`: `view` for a position, which is
    recognised by its name, and middle values for the rest. Inputs with a default are skipped."""
    for parameter in function.parameters:
        for place in parameter.places if parameter.is_given and not parameter.has_default else ():
            is_view = place.size == NORMAL and any(word in place.path.lower() for word in OF_VIEW)
            if not any(path == place.path or path.startswith(f"{place.path}.") for path in taken):
                yield place.path, VIEW if is_view else FREE[place.kind]


def _normal_of(places: Sequence[Place]) -> Place | None:
    """Return the normal among vectors: the only vector of three numbers, the only such vector that is named as a
    normal, or a vector of four numbers if it is the only place; else None."""
    vectors = [place for place in places if place.kind == "float" and place.size == NORMAL]
    named = [place for place in vectors if _is_called_normal(place)]
    wide = [place for place in places if place.kind == "float" and place.size > NORMAL and len(places) == 1]
    return next((some[0] for some in (vectors, named, wide) if len(some) == 1), None)


def _is_called_normal(place: Place) -> bool:
    last = place.path.rpartition(".")[2].lower()
    return last == N or any(word in last for word in NORMALS)


def _codes(encode: Function, decode: Function, normal: Place) -> _Ways:
    outputs = [place for place in outputs_of(encode) if place.path != normal.path]
    if len(outputs) < len(outputs_of(encode)):
        # The normal becomes its code: two of its numbers or three, and what else there is.
        for letters in SWIZZLES[:2]:
            for some in _parts(outputs):
                yield from _given([Place(f"{normal.path}.{letters}", "float", len(letters)), *some], encode, decode)
    elif outputs:
        for some in _parts(outputs):
            yield from _given(some, encode, decode)


def _parts(outputs: Sequence[Place]) -> Iterator[list[Place]]:
    """Yield lists of outputs, or of parts of an output, that may be a code or a part of a code."""
    if sum(place.size for place in outputs) <= NORMAL:
        yield list(outputs)
    for place in outputs:
        if place.size > NORMAL and place.kind == "float":
            parts = ((f"{place.path}.{letters}".strip("."), len(letters)) for letters in SWIZZLES)
            yield from ([Place(path, place.kind, size)] for path, size in parts)
        elif len(outputs) > 1 and place.kind == "float" and place.size > 1 and _is_called_normal(place):
            yield [place]


def _given(parts: Sequence[Place], encode: Function, decode: Function) -> _Ways:
    """Yield the ways in which the parts can be the code, if the decoder takes them in the same order: the paths of
    the outputs, and the path and value of each of the decoder's inputs. Yield nothing for more than three numbers."""
    inputs, size = inputs_of(decode), sum(part.size for part in parts)
    outputs = tuple(path for part in parts for path in _named(encode, part.path, part.size))
    if size > NORMAL:
        return
    if len(parts) == 1:
        last = parts[0].path.rpartition(".")[2]
        letters = last if last in SWIZZLES else "xyz"[:size]
        for place in inputs:
            # Four numbers may hold something else as well; three are a code or a normal.
            if place.size == size or (place.size > NORMAL and size > 1):
                yield outputs, ((place.path if place.size == size else f"{place.path}.{letters}", CODE),)
    elif len(inputs) == len(parts):
        ends = [0, *itertools.accumulate(part.size for part in parts)]
        letters = ["xyz"[start:end] for start, end in itertools.pairwise(ends)]
        paths = [
            place.path if place.size == part.size else f"{place.path}.{'xyz'[: part.size]}"
            for place, part in zip(inputs, parts, strict=True)
        ]
        yield outputs, tuple((path, f"{CODE}.{some}") for path, some in zip(paths, letters, strict=True))
