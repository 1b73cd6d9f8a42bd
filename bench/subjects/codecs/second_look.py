"""A comparison of a translated encoding, run by OpenGL, with a second way to run it (see `languages/second.py`)."""

from __future__ import annotations

import itertools
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.encoding import Encoding
from ....gbuffer.codecs.codec_passes import exact_values
from ....gbuffer.gl.device import Device
from ...ground.compilers import tools
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError, UsageError
from ...ground.user_files import UserFile
from ...shaders.languages.language import GLSLANG, language_of, name_of
from ...shaders.languages.second import NoSecondWayError, UndefinedError, Way, second_way
from ...shaders.languages.source import Source
from ...shaders.languages.translated import own, translated

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
# What glslang reads otherwise than HLSL defines it: remainders of negative numbers, and products of matrices.
MISREAD = re.compile(r"\bfmod\s*\(|%|\b(?:float|half|min16float|real)[234]x[234]\b|\bmatrix\b")
# What the two ways of a language are called.
SLANG_S, OF_WGSL = ("Slang's GLSL", "its SPIR-V"), ("this program", "naga")
# Values of shape (count, 3) to what a function makes of them.
Function = Callable[[np.ndarray], np.ndarray]


def second_look(
    file: UserFile, gl: Device, encoding: Encoding, hard: np.ndarray, read: Callable[[str], Encoding]
) -> dict[str, Any]:
    """Compare a file's encoding, as OpenGL runs it, with its second way. The result is cached.

    Args:
        file: the user's file.
        encoding: the encoding as translated to GLSL.
        hard: normals of shape (count, 3), in addition to random normals.
        read: a function that returns the encoding as read by a compiler named in `BY_NAME`.

    Returns:
        A dictionary: empty if the results agree; else `error`, why the file is refused, or `notes`, lines.
    """
    source, language = Source(file), language_of(file)
    stamps = [tools.stamp_or_empty(tool) for tool in (tools.SLANG, *language.tools, *language.others)]
    key = kept.key_of("second", source.text, file.word, *stamps, own(), gl.renderer, gl.version)
    if (finding := kept.read(key)) is None:
        try:
            finding = _disagreement(file, source.text, gl, encoding, hard, read)
        except UndefinedError as error:
            finding = {"error": f"{file}: {error}, which its language does not define"}
        except NoSecondWayError as error:
            finding = _unchecked_finding(file, str(error))
            if not error.is_of_the_file:
                return finding
        kept.write(key, finding)
    return finding


def _unchecked_finding(file: UserFile, why: str) -> dict[str, Any]:
    """Return the findings on a file that only one compiler has read: `notes`. If that compiler is glslang, return
    `error` if it is known to misread such a file, and nothing otherwise."""
    encoder = translated(file)
    if encoder.read_by == GLSLANG:
        if not (used := MISREAD.search(encoder.text)):
            return {}
        what = f"it uses {used[0].strip('( ')}, which glslang interprets differently from HLSL"
        return {"error": f"{file}: {what}, and no second compiler can read the file: {why}"}
    return {"notes": [f"no second compiler has checked its translation: {why}"]}


def _disagreement(
    file: UserFile, text: str, gl: Device, encoding: Encoding, hard: np.ndarray, read: Callable[[str], Encoding]
) -> dict[str, Any]:
    random = np.random.default_rng(0).normal(size=(RANDOM, 3))
    n = np.concatenate([hard, random / np.linalg.norm(random, axis=1, keepdims=True)]).astype(np.float32)
    tolerance = BY_POLYNOMIALS if POLYNOMIALS.search(text) else EXACT

    def difference(way: Way, names: tuple[str, str]) -> str:
        return _difference(file, gl, encoding, way, n, tolerance, names)

    try:
        disagreement, why = _by_second_way(file, difference), None
    except NoSecondWayError as error:
        disagreement, why = "", error
    by_glslang = _by_glslang(file, gl, read, difference)
    if why and by_glslang is None:
        raise why
    if disagreement or (why and by_glslang):
        advice = "rewrite ambiguous expressions such as % of negative integers"
        return {"error": f"{file}: two compilers disagree: {disagreement or by_glslang}; {advice}"}
    return {"notes": [f"{by_glslang}; the first is measured, because it follows the language"]} if by_glslang else {}


def _by_second_way(file: UserFile, difference: Callable[[Way, tuple[str, str]], str]) -> str:
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        is_wgsl = name_of(file) == "WGSL"
        return difference(second_way(file, translated(file), Path(folder)), OF_WGSL if is_wgsl else SLANG_S)


def _by_glslang(
    file: UserFile, gl: Device, read: Callable[[str], Encoding], difference: Callable[[Way, tuple[str, str]], str]
) -> str | None:
    """Return a description of a difference from glslang's results; empty if they agree. Return None if the file is
    not HLSL, if glslang cannot read it, or if the encoding itself was read by glslang."""
    if name_of(file) != "HLSL" or translated(file).read_by:
        return None
    try:
        encoding = read(GLSLANG)
    except (MissingError, UsageError):
        return None

    def way(n: np.ndarray, codes: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        views = np.tile(np.array([*view, 0.0], np.float32), (len(n), 1))
        by_gl, by_gl_decoded = exact_values(gl, encoding, _four_columns(n), views, _four_columns(codes))
        return by_gl[:, :3], by_gl_decoded[:, :3]

    return difference(way, ("Slang", GLSLANG))


def _difference(
    file: UserFile, gl: Device, encoding: Encoding, way: Way, n: np.ndarray, tolerance: float, ways: tuple[str, str]
) -> str:
    """Describe an input for which two ways, named by `ways`, give different results; empty if they agree."""
    size = encoding.components

    def encode(given: np.ndarray) -> np.ndarray:
        return exact_values(gl, encoding, _four_columns(given), _tiled_views(given), _four_columns(given))[0][:, :size]

    def decode(given: np.ndarray) -> np.ndarray:
        return exact_values(gl, encoding, _four_columns(given), _tiled_views(given), _four_columns(given))[1][:, :3]

    codes = encode(n)
    given = np.pad(codes, ((0, 0), (0, 3 - size)))
    second_codes, second_normals = way(n, given, np.array(VIEW, np.float32))
    names = [name for name, _ in translated(file).functions]
    for name, function, values, mine, theirs, count in (
        (names[0], encode, n, codes, second_codes[:, :size], 3),
        (names[1], decode, given, decode(given), second_normals, size),
    ):
        index = _first_apart(function, values, mine, theirs, tolerance)
        if index is not None:
            shown = [np.asarray(row[index], np.float64).round(5).tolist() for row in (values[:, :count], mine, theirs)]
            return f"{name} of {shown[0]} is {shown[1]} with {ways[0]} and {shown[2]} with {ways[1]}"
    return ""


def _first_apart(
    function: Function, given: np.ndarray, mine: np.ndarray, theirs: np.ndarray, tolerance: float
) -> int | None:
    """Return the index of an input whose two results differ by more than rounding. Return None if the results agree,
    apart from a few and from inputs next to a jump of the function."""
    with np.errstate(all="ignore"):
        bound = tolerance * np.maximum(1, np.abs(theirs))
        is_near = (np.abs(mine - theirs) <= bound) | (mine == theirs) | (np.isnan(mine) & np.isnan(theirs))
    indices = np.flatnonzero(~is_near.all(axis=1))
    if len(indices) > MANY * len(given):
        return int(indices[-1])
    indices = indices[:LOOKED_AT]
    left = indices[~_is_beside(function, given[indices], theirs[indices], bound[indices])] if len(indices) else indices
    return int(left[-1]) if len(left) > MOST * len(given) else None


def _is_beside(function: Function, given: np.ndarray, theirs: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Return for each result whether it is in the range of the function's results at neighbouring inputs, to within
    `bound`; bool of shape (count,)."""
    steps = np.array(list(itertools.product((-1, 0, 1), repeat=3)), np.float32) * np.float32(BESIDE)
    neighbours = function((given[:, None, :] + steps).reshape(-1, 3)).reshape(len(given), len(steps), -1)
    with np.errstate(all="ignore"):
        least = np.nanmin(np.where(np.isnan(neighbours), np.inf, neighbours), axis=1) - bound
        most = np.nanmax(np.where(np.isnan(neighbours), -np.inf, neighbours), axis=1) + bound
        inside = (theirs >= least) & (theirs <= most) | np.isnan(theirs) & np.isnan(neighbours).any(axis=1)
    return inside.all(axis=1)


def _four_columns(given: np.ndarray) -> np.ndarray:
    return np.pad(given, ((0, 0), (0, 4 - given.shape[1]))).astype(np.float32)


def _tiled_views(given: np.ndarray) -> np.ndarray:
    return np.tile(np.array([*VIEW, 0.0], np.float32), (len(given), 1))
