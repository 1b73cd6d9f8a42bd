"""A first look at a user's code, in a process that may hang or die.

    python -m normalbench.bench.subjects.codecs.first_look FILE [DOMAIN]

With DOMAIN it is looked at closely: what its author says that it is made for, or "any".

Prints a line of JSON of the GLSL, and another of the Python twin where there is one. Of the GLSL: `error`, what the
compiler says; `broken`, where it is not finite or does not end; `missing`, that there is no GL device; else `domain`,
what comes back, `half`, the axis and the side of a hemisphere that is not z >= 0, `wrong`, a list of what is likely
wrong, `hole`, a direction outside of the domain where it is not finite, and `is_unit`, where its codes fill [0, 1].
Closely also `like`, the encodings of the catalogue that both its functions are, `bad`, directions that come back
elsewhere, `spared`, lines on ranges that may be unused, and `lattice`, to which bits it rounds by itself and whether in
[0, 1]. Of a translation also `by`, the language whose compiler reads it right, and `notes`, lines. Of the twin:
`error`, what it raises; `apart`, where it contradicts the GLSL.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.encoding import Encoding
from ....encodings.vec import Vec2, Vec3
from ....gbuffer.codecs.codec_passes import exact_values
from ....gbuffer.codecs.loops import loop_limit, loops_ended
from ....gbuffer.gl.device import Device, NoDeviceError, device
from ....gbuffer.gl.shader import ShaderError, read_shader
from ...ground.directions import directions
from ...ground.machine import children
from ...ground.output.errors import MissingError, UsageError
from ...shaders.code.twin import NoTwinError
from ...shaders.languages.words import is_translated, twin_of
from .doctor.diagnoses import bad, diagnosed
from .doctor.domains import Domain, guessed
from .doctor.exact import OF_A_HALF, SAME_DEG, is_unit, spared
from .doctor.likeness import likeness
from .doctor.nearly import lattice_of
from .doctor.probe import VIEW, Probe, Trip, probe_of, trip_of
from .names import check_twin
from .second_look import second_look
from .signatures import of_hlsl
from .user_encodings import ANY, read_encoding, twin_is_looked_at

# Of directions that a picture is marked with.
MOST_BAD = 4000
NOT_ASKED = "the twin is looked at by itself"
# Letters of a compiler's message; what follows the first errors follows from them.
LONGEST = 1000
# Twins whose numbers are farther apart, for more than this share of directions, are two encodings.
APART, APART_SHARE = 1e-3, 0.01


def first_look(path: Path, domain: str = "") -> dict[str, Any]:
    """What there is to say of a file; see above.

    Args:
        domain: what its author says that it is made for, or ANY, to look closely.
    """
    try:
        encoding, gl = read_encoding(path, NOT_ASKED), device()
        broken = _endless(gl, encoding)
        other = {} if broken or not is_translated(path) else _second_look(path, gl, encoding)
        if "error" in other:
            return other
        by = other.get("by", "")
        encoding = read_encoding(path, NOT_ASKED, by=by) if by else encoding
        unit = {"is_unit": True} if not broken and _is_unit(probe_of(gl, encoding)) else {}
        if unit:
            encoding = read_encoding(path, NOT_ASKED, is_unit=True, by=by)
        return (broken or _judged(probe_of(gl, encoding), gl, domain)) | unit | other
    except (NoDeviceError, MissingError) as error:
        return {"missing": str(error)}
    except UsageError as error:
        return {"error": str(error)}
    except ShaderError as error:
        return {"error": _of_compiler(path, str(error))}


def _is_unit(probe: Probe) -> bool:
    """Whether the codes of all directions fill [0, 1], or those of the directions that come back."""
    n = directions()
    codes = probe.encode(n)
    kept = np.isfinite(codes).all(axis=1)
    n, codes = n[kept], codes[kept]
    if not len(n) or is_unit(codes):
        return bool(len(n))
    # As an unsigned storage clips them.
    back = probe.decode(np.clip(codes, 0, 1))
    trip = Trip(n, np.broadcast_to(np.array(VIEW, np.float32), n.shape), codes, back)
    with np.errstate(invalid="ignore"):
        domain = guessed(trip, SAME_DEG)
    return bool(domain.name) and is_unit(domain.held(trip).codes, OF_A_HALF)


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


def _endless(gl: Device, encoding: Encoding) -> dict[str, Any]:
    n = _widened(directions())
    view = np.tile(np.array([*VIEW, 0.0], np.float32), (len(n), 1))
    for what, flags in zip(("encode", "decode"), loops_ended(gl, encoding, n, view), strict=True):
        if flags.any():
            said = f"after {loop_limit(gl) or 'too many'} turns in all this device ends a shader's loops without a word"
            return {"broken": f"the loops of {what} for {n[np.argmax(flags), :3].tolist()} do not end here: {said}"}
    return {}


def _judged(probe: Probe, gl: Device, domain: str) -> dict[str, Any]:
    found = diagnosed(probe, gl, domain.replace(ANY, ""))
    if found.broken:
        return {"broken": found.broken, "wrong": found.wrong}
    hole = {"hole": found.hole} if found.hole else {}
    half = {"half": [found.domain.axis, found.domain.side]} if found.domain.is_turned else {}
    closely = _closely(probe, gl, found.domain) if domain else {}
    return {"domain": found.domain.name, "wrong": found.wrong} | half | hole | closely


def _closely(probe: Probe, gl: Device, domain: Domain) -> dict[str, Any]:
    found = trip_of(probe, directions())
    found = found.of(found.is_finite)
    lattice = lattice_of(found.codes)
    return {
        "like": likeness(gl, probe, domain).shared(domain.name),
        "bad": bad(probe, domain)[:MOST_BAD].tolist(),
        "spared": list(spared(found, probe)),
        **({"lattice": list(astuple(lattice))} if lattice else {}),
    }


def twin_look(path: Path) -> dict[str, Any]:
    """What there is to say of a file's Python twin; see above."""
    n = directions()
    view = np.tile(np.array([*VIEW, 0.0], np.float32), (len(n), 1))
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


def _looks(path: Path, domain: str = "") -> Iterator[dict[str, Any]]:
    found = first_look(path, domain)
    yield found
    if twin_is_looked_at(path, found):
        yield twin_look(path)


def main(words: Sequence[str]) -> None:
    """What the command does; see above."""
    children.limit_this_process()
    answer = _alone()
    for look in _looks(Path(words[0]), *words[1:]):
        os.write(answer, json.dumps(look).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
