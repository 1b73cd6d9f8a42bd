"""A first look at a user's code, in a process that may hang or die.

    python -m normalbench.bench.codecs.first_look FILE

Prints a line of JSON of the GLSL, and another of the Python twin where there is one. Of the GLSL: `error`, what the
compiler says; `broken`, where it is not finite or does not end; `missing`, that there is no GL device; else `domain`,
what comes back, `wrong`, a list of what is likely wrong, and `is_unit`, where its codes fill [0, 1]. Of a translation
also `by`, the language whose compiler reads it right, and `notes`, lines. Of the twin: `error`, what it raises;
`apart`, where it contradicts the GLSL.
"""

from __future__ import annotations

import itertools
import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ...encodings.codecs.encoding import Encoding
from ...encodings.vec import Vec2, Vec3
from ...gbuffer.codecs.codec_passes import exact_values
from ...gbuffer.codecs.loops import loop_limit, loops_ended
from ...gbuffer.gl.device import Device, NoDeviceError, device
from ...gbuffer.gl.shader import ShaderError, read_shader
from ..languages.words import is_translated, twin_of
from ..machine import children
from ..output.errors import MissingError, UsageError
from .diagnoses import Trip, diagnoses, guessed, is_unit
from .names import check_twin
from .second_look import second_look
from .signatures import of_hlsl
from .user_encodings import NoTwinError, read_encoding, twin_is_looked_at

RANDOM = 4096
NOT_ASKED = "the twin is looked at by itself"
# Letters of a compiler's message; what follows the first errors follows from them.
LONGEST = 1000
# Twins whose numbers are farther apart, for more than this share of directions, are two encodings.
APART, APART_SHARE = 1e-3, 0.01


def directions() -> np.ndarray:
    """Axes with both zeros and what lies beside them, diagonals, and random directions: float32 of shape (count, 3)."""
    near = (0.0, -0.0, 1e-7, -1e-7, 1e-3, -1e-3)
    sides = itertools.product(range(3), (1.0, -1.0), near, near)
    axes = [np.insert(np.array([a, b]), axis, side) for axis, side, a, b in sides]
    diagonals = [d for d in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(d)]
    random = np.random.default_rng(0).normal(size=(RANDOM, 3))
    found = np.concatenate([axes, diagonals, random])
    return (found / np.linalg.norm(found, axis=1, keepdims=True)).astype(np.float32)


def first_look(path: Path) -> dict[str, Any]:
    """What there is to say of a file; see above."""
    n = directions()
    view = np.tile(np.array([0.1, -0.2, -1.0, 0.0], np.float32), (len(n), 1))
    given = np.concatenate([n, np.zeros((len(n), 1), np.float32)], axis=1)
    try:
        encoding, gl = read_encoding(path, NOT_ASKED), device()
        broken = _ended(gl, encoding, given, view)
        other = {} if broken or not is_translated(path) else _second_look(path, gl, encoding)
        if "error" in other:
            return other
        by = other.get("by", "")
        encoding = read_encoding(path, NOT_ASKED, by=by) if by else encoding
        codes, _ = exact_values(gl, encoding, given, view, given)
        unit = {"is_unit": True} if is_unit(codes[:, : encoding.components]) else {}
        if unit:
            encoding = read_encoding(path, NOT_ASKED, is_unit=True, by=by)
            codes, _ = exact_values(gl, encoding, given, view, given)
        # As a storage clips them.
        _, decoded = exact_values(gl, encoding, given, view, np.clip(codes, -1, 1))
    except (NoDeviceError, MissingError) as error:
        return {"missing": str(error)}
    except UsageError as error:
        return {"error": str(error)}
    except ShaderError as error:
        return {"error": _of_compiler(path, str(error))}
    judged = broken or _judged(Trip(n, view[:, :3], codes[:, : encoding.components], decoded[:, :3]))
    return judged | unit | other


def _second_look(path: Path, gl: Device, encoding: Encoding) -> dict[str, Any]:
    return second_look(path, gl, encoding, directions(), lambda by: read_encoding(path, NOT_ASKED, by=by))


def _of_compiler(path: Path, said: str) -> str:
    """A compiler's message with the user's file at its begin."""
    line = " ".join(said.partition("=\n")[2].split()) or " ".join(said.split())
    if is_translated(path):
        said = re.sub(r"\S+\.glsl:(\d+)", r"line \1", line)[:LONGEST]
        return f"{path}: the GLSL that was made of it does not compile on this device: {said}"
    named = line if path.name in line else f"{path}: {line}"
    hint = of_hlsl(read_shader(path))
    return (named if len(named) <= LONGEST else f"{named[:LONGEST]} ...") + (f" ({hint})" if hint else "")


def _ended(gl: Device, encoding: Encoding, n: np.ndarray, view: np.ndarray) -> dict[str, Any]:
    for what, flags in zip(("encode", "decode"), loops_ended(gl, encoding, n, view), strict=True):
        if flags.any():
            said = f"after {loop_limit(gl) or 'too many'} turns in all this device ends a shader's loops without a word"
            return {"broken": f"the loops of {what} for {n[np.argmax(flags), :3].tolist()} do not end here: {said}"}
    return {}


def _judged(trip: Trip) -> dict[str, Any]:
    for what, found in (("encode", trip.codes), ("decode", trip.decoded)):
        bad = ~np.isfinite(found).all(axis=1)
        if bad.any():
            return {"broken": f"{what} of {trip.n[bad][0].tolist()} is {found[bad][0].tolist()}, no number"}
    domain = guessed(trip)
    return {"domain": domain, "wrong": diagnoses(trip, domain)}


def twin_look(path: Path) -> dict[str, Any]:
    """What there is to say of a file's Python twin; see above."""
    n = directions()
    view = np.tile(np.array([0.1, -0.2, -1.0, 0.0], np.float32), (len(n), 1))
    try:
        encoding = read_encoding(path)
        check_twin(encoding)
        codes = _by_twin(encoding.encode, n, view)
        decoded = _by_twin(encoding.decode, codes, view)
    except NoDeviceError:
        return {}
    except BaseException as error:  # whatever a user's own file raises
        where = twin_of(path)
        said = (
            str(error) if isinstance(error, UsageError | NoTwinError) else f"{where}: {type(error).__name__}: {error}"
        )
        return {"error": " ".join(said.split())[:300]}
    return _apart(encoding, n, view, codes, decoded)


def _by_twin(function: Callable[..., Any], given: np.ndarray, view: np.ndarray) -> np.ndarray:
    """What a twin's function makes of arrays of shape (count, 2 or 3), which it sees as it does when it is measured."""
    kind = {2: Vec2, 3: Vec3}[given.shape[1]]
    made = jax.jit(function)(kind(*map(jnp.asarray, given.T)), Vec3(*map(jnp.asarray, view.T[:3])))
    return np.stack([np.broadcast_to(np.asarray(one, np.float32), len(given)) for one in made], axis=1)


def _apart(
    encoding: Encoding, n: np.ndarray, view: np.ndarray, codes: np.ndarray, decoded: np.ndarray
) -> dict[str, Any]:
    try:
        gl = device()
    except NoDeviceError:
        return {}
    by_gl, by_gl_decoded = exact_values(gl, encoding, _widened(n), view, _widened(codes))
    for what, given, one, other in (("encode", n, codes, by_gl), ("decode", codes, decoded, by_gl_decoded)):
        far = ~(np.abs(one - other[:, : one.shape[1]]) <= APART).all(axis=1)
        if far.mean() > APART_SHARE:
            at = int(np.argmax(far))
            values = [row[at, : one.shape[1]].round(4).tolist() for row in (one, other)]
            share = f"{100 * far.mean():.0f} % of directions, of {given[at].round(4).tolist()}"
            return {"apart": f"{what} is another than the GLSL's for {share}: {values[0]}, by GLSL {values[1]}"}
    return {}


def _widened(array: np.ndarray) -> np.ndarray:
    return np.concatenate([array, np.zeros((len(array), 4 - array.shape[1]), np.float32)], axis=1)


def _alone() -> int:
    """A file for what is to be said; whatever users' code prints goes to stderr."""
    said = os.dup(1)
    os.dup2(2, 1)
    return said


def _looks(path: Path) -> Iterator[dict[str, Any]]:
    found = first_look(path)
    yield found
    if twin_is_looked_at(path, found):
        yield twin_look(path)


def main(words: Sequence[str]) -> None:
    """What the command does; see above."""
    children.limit_this_process()
    answer = _alone()
    for look in _looks(Path(words[0])):
        os.write(answer, json.dumps(look).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
