"""Whether a translated encoder, by OpenGL, gives what its second way gives: see `languages/second.py`."""

from __future__ import annotations

import itertools
import re
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ....encodings.codecs.encoding import Encoding
from ....gbuffer.codecs.codec_passes import exact_values
from ....gbuffer.gl.device import Device
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError, UsageError
from ...shaders.languages import tools
from ...shaders.languages.language import also_read_by, language_of
from ...shaders.languages.second import NoSecondWayError, UndefinedError, Way, second_way
from ...shaders.languages.source import Source
from ...shaders.languages.translated import own, translated
from ...shaders.languages.words import TRANSLATED, file_of

RANDOM = 2**16
VIEW = (0.1, -0.2, -1.0)
# How far two results may be apart, of a number and below 1 of 1: drivers' sines and powers are polynomials.
EXACT, BY_POLYNOMIALS = 2.0**-16, 1e-3
POLYNOMIALS = re.compile(r"\b(?:a?(?:sin|cos|tan)h?|atan2|sincos|pow|exp2?|log(?:2|10)?)\b")
# Normals beside a seam are rounded to one of its sides: within so much of a normal lies the other side. The rest of
# what differs may be a thousandth: what is next to where a function has no limit.
BESIDE, MOST = 2.0**-22, 1e-3
# As many differ only where a function is another one; and so many are looked at closely.
MANY, LOOKED_AT = 0.05, 2048
# In HLSL: of negative numbers.
MISREAD = re.compile(r"\bfmod\s*\(|%")
# What the two ways of each language are called.
WAYS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {"HLSL": ("glslang", "slangc"), "Slang": ("slangc's GLSL", "its C++"), "WGSL": ("this program", "naga")}
)
# Values of shape (count, 3) to what a function makes of them.
Function = Callable[[np.ndarray], np.ndarray]


def second_look(
    path: Path, gl: Device, encoding: Encoding, hard: np.ndarray, read: Callable[[str], Encoding]
) -> dict[str, Any]:
    """What the second way of a file says of its first; kept in the cache by the file and both ways.

    Args:
        path: what names it.
        encoding: it, by its first way.
        hard: normals of shape (count, 3), beside random ones.
        read: makes the encoding of a language whose compiler reads the file as well.

    Returns:
        Nothing where they agree. `error`: where they do not; `by`: the language whose compiler has read it right;
        `notes`: lines that are to be said.
    """
    source = Source(file_of(path))
    stamps = [_stamp(tool) for tool in (tools.SLANG, *language_of(file_of(path)).tools)]
    key = kept.key_of("second", source.text, str(path), *stamps, own(), gl.renderer, gl.version)
    if (found := kept.read(key)) is None:
        try:
            found = _looked(path, source.text, gl, encoding, hard, read)
        except UndefinedError as error:
            found = {"error": f"{path}: {error}; its language does not define that"}
        except NoSecondWayError as error:
            found = _unchecked(path, source, str(error))
            if not error.is_of_the_file:
                return found
        kept.write(key, found)
    return found


def _unchecked(path: Path, source: Source, why: str) -> dict[str, Any]:
    """What is said of a file that one compiler alone has read; it is refused where that one is known to be wrong."""
    used = MISREAD.search(source.text) if TRANSLATED[file_of(path).suffix.lower()] == "HLSL" else None
    if used:
        what = f"it uses {used[0].strip('( ')}, which glslang reads otherwise than HLSL defines it"
        return {"error": f"{path}: {what}, and no second compiler reads the file: {why}"}
    return {"notes": [f"no second compiler has checked its translation: {why}"]}


def _stamp(tool: str) -> str:
    try:
        return tools.stamp(tool)
    except MissingError:
        return ""


def _looked(
    path: Path, text: str, gl: Device, encoding: Encoding, hard: np.ndarray, read: Callable[[str], Encoding]
) -> dict[str, Any]:
    random = np.random.default_rng(0).normal(size=(RANDOM, 3))
    n = np.concatenate([hard, random / np.linalg.norm(random, axis=1, keepdims=True)]).astype(np.float32)
    tolerance = BY_POLYNOMIALS if POLYNOMIALS.search(text) else EXACT
    with tempfile.TemporaryDirectory() as folder:
        way = second_way(path, translated(path), Path(folder))
        said = _difference(path, gl, encoding, way, n, tolerance)
        if not said:
            return {}
        by = also_read_by(file_of(path))
        try:
            if by and not _difference(path, gl, read(by), way, n, tolerance):
                return {"by": by, "notes": [f"{said}; the latter is measured, as the language defines it"]}
        except (MissingError, UsageError):
            pass
    advice = "write it without what is read in two ways, such as % of negative whole numbers"
    return {"error": f"{path}: two compilers disagree: {said}; {advice}"}


def _difference(path: Path, gl: Device, encoding: Encoding, way: Way, n: np.ndarray, tolerance: float) -> str:
    """Where the two ways differ, in words; empty where they do not."""
    size = encoding.components

    def encode(given: np.ndarray) -> np.ndarray:
        return exact_values(gl, encoding, _four(given), _views(given), _four(given))[0][:, :size]

    def decode(given: np.ndarray) -> np.ndarray:
        return exact_values(gl, encoding, _four(given), _views(given), _four(given))[1][:, :3]

    codes = encode(n)
    given = np.pad(codes, ((0, 0), (0, 3 - size)))
    second_codes, second_normals = way(n, given, np.array(VIEW, np.float32))
    names, ways = [name for name, _ in translated(path).functions], WAYS[TRANSLATED[file_of(path).suffix.lower()]]
    for name, function, values, mine, theirs, count in (
        (names[0], encode, n, codes, second_codes[:, :size], 3),
        (names[1], decode, given, decode(given), second_normals, size),
    ):
        at = _first_apart(function, values, mine, theirs, tolerance)
        if at is not None:
            shown = [np.asarray(row[at], np.float64).round(5).tolist() for row in (values[:, :count], mine, theirs)]
            return f"{name} of {shown[0]} is {shown[1]} by {ways[0]} and {shown[2]} by {ways[1]}"
    return ""


def _first_apart(
    function: Function, given: np.ndarray, mine: np.ndarray, theirs: np.ndarray, tolerance: float
) -> int | None:
    """The first value of which two results differ that no rounding explains; None where there is none, or few."""
    with np.errstate(all="ignore"):
        bound = tolerance * np.maximum(1, np.abs(theirs))
        is_near = (np.abs(mine - theirs) <= bound) | (mine == theirs) | (np.isnan(mine) & np.isnan(theirs))
    at = np.flatnonzero(~is_near.all(axis=1))
    if len(at) > MANY * len(given):
        return int(at[-1])
    at = at[:LOOKED_AT]
    left = at[~_is_beside(function, given[at], theirs[at], bound[at])] if len(at) else at
    return int(left[-1]) if len(left) > MOST * len(given) else None


def _is_beside(function: Function, given: np.ndarray, theirs: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Whether results lie among those that a function gives next to the values."""
    steps = np.array(list(itertools.product((-1, 0, 1), repeat=3)), np.float32) * np.float32(BESIDE)
    found = function((given[:, None, :] + steps).reshape(-1, 3)).reshape(len(given), len(steps), -1)
    with np.errstate(all="ignore"):
        least = np.nanmin(np.where(np.isnan(found), np.inf, found), axis=1) - bound
        most = np.nanmax(np.where(np.isnan(found), -np.inf, found), axis=1) + bound
        inside = (theirs >= least) & (theirs <= most) | np.isnan(theirs) & np.isnan(found).any(axis=1)
    return inside.all(axis=1)


def _four(given: np.ndarray) -> np.ndarray:
    return np.pad(given, ((0, 0), (0, 4 - given.shape[1]))).astype(np.float32)


def _views(given: np.ndarray) -> np.ndarray:
    return np.tile(np.array([*VIEW, 0.0], np.float32), (len(given), 1))
