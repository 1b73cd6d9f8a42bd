"""A first look at a user's code, in a process that may hang or crash.

    python -m normalbench.bench.subjects.codecs.first_look FILE [DOMAIN]

DOMAIN asks for a close look: it is the domain that the author made the encoding for, or "any".

Prints a line of JSON about the GLSL and, if there is a Python twin, a line about the twin. About the GLSL: `error`,
the compiler's message; `broken`, why it is not finite or does not end; `missing`, the missing OpenGL device or
compiler; otherwise `domain`, the directions that round-trip; `half`, the axis and the side of a hemisphere other than
z >= 0; `wrong`, a list of likely mistakes; `hole`, where it is not finite outside the domain; and `is_unit`, if its
codes fill [0, 1]. A close look adds `like`, the encodings in the catalogue that both functions match; `bad`,
directions that decode to other directions; `spared`, lines about ranges that may be unused; and `lattice`, the bits
that the encoder itself rounds to, and whether in [0, 1]. Integer codes add `packed_bits`, the number of bits used. A
translation adds `by`, the language whose compiler reads it correctly; `pair`, the only one of several pairs that
round-trips; `language`, its language if the extension is another language's; and `notes`, lines to report. About the
twin: `error`, the exception it raised; `apart`, where it contradicts the GLSL.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import astuple
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
from ...ground.output.errors import MissingError, SeveralEncodersError, UsageError
from ...ground.user_files import UserFile
from ...shaders.code.twin import NoTwinError
from ...shaders.languages.language import GLSL_NAME
from ...shaders.languages.pairs import NO_PAIR, role, stem
from ...shaders.languages.translated import AloneError, Translated
from ...shaders.languages.wiring import Wiring, wiring_of
from .doctor.diagnoses import bad, diagnosed
from .doctor.domains import SPHERE, Domain, guessed
from .doctor.exact import OF_A_HALF, SAME_DEG, bits_used, is_unit, spared
from .doctor.likeness import likeness, names_alone
from .doctor.nearly import lattice_of
from .doctor.probe import VIEW, Probe, Trip, probe_of, trip_of
from .names import check_twin
from .second_look import second_look
from .signatures import NO_FUNCTION, OWN_MAIN, OWN_VERSION, of_hlsl
from .user_encodings import ANY, encoding_alone, file_with, read_encoding, twin_is_looked_at

# What one function of a pair is called.
SIDES = ("encode", "decode")
# Of directions that a picture is marked with.
MOST_BAD = 4000
TWO_NAMES = re.compile(r"((?:\w+::)*\w+):((?:\w+::)*\w+)")
# How many pairs of a file are tried, and how near directions come back from one, in degrees.
MOST_PAIRS, MOST_WIRINGS, OF_A_PAIR_DEG, OF_A_WIRING_DEG = 12, 12, 5.0, 0.1
# Of pairs that a line gives a reason for.
MOST_REASONS = 4
NOT_ASKED = "the twin is looked at by itself"
# Letters of a compiler's message; what follows the first errors follows from them.
LONGEST = 1000
# Twins whose numbers are farther apart, for more than this share of directions, are two encodings.
APART, APART_SHARE = 1e-3, 0.01


def first_look(file: UserFile, domain: str = "") -> dict[str, Any]:
    """Return the findings on the GLSL of a file as a dictionary; the module describes its keys.

    Args:
        domain: the domain that the author made the encoding for, or ANY, for a close look; empty for a quick look.
    """
    look = _first_look(file, domain, "")
    if "error" not in look or file.is_translated:
        return look
    if _is_hlsl(file):
        again = _first_look(file.with_language("hlsl"), domain, "")
        return look if {"error", "missing"} & again.keys() else again | {"language": "hlsl"}
    # What the device does not compile as it lies may have more in it than the two functions.
    again = _first_look(file, domain, GLSL_NAME)
    # Those that the device refuses for their form alone are read here.
    is_of_form = look["error"].endswith((OWN_MAIN, OWN_VERSION))
    is_nearer = (is_of_form or NO_FUNCTION in look["error"]) and NO_PAIR not in again.get("error", "")
    return again if is_nearer or not {"error", "missing"} & again.keys() else look


def _is_hlsl(file: UserFile) -> bool:
    try:
        return bool(of_hlsl(read_shader(file.path)))
    except ShaderError:
        return True


def _first_look(file: UserFile, domain: str, by: str) -> dict[str, Any]:
    try:
        return _look_at_one(file, domain, by)
    except SeveralEncodersError as error:
        try:
            kept, failing = _that_undo_themselves(file, error.pairs, by)
        except NoDeviceError as missing:
            named = ", ".join(dict.fromkeys(str(file.with_pair(pair)) for pair in error.pairs[:MOST_PAIRS]))
            return {"error": f"{file}: name one of its pairs; they cannot be tried here ({missing}): {named}"}
        if len(kept) == 1:
            look = _look_at_one(file.with_pair(kept[0]), domain, by)
            return look | {"pair": kept[0], "failing": _alike(failing)}
        if not kept and error.alone:
            of_one = _of_one(file, error.alone)
            return of_one | {"error": f"{file}: {of_one['error']}"}
        if not kept:
            return {"error": f"{file}: {_why_none(failing)}"}
        named = ", ".join(str(file.with_pair(pair)) for pair in kept)
        how = f"{len(kept)} of its pairs round-trip; name one: {named}"
        return {"error": f"{file}: {how}{_untried(failing)}", "pairs": kept, "failing": _alike(failing)}


def _alike(failing: Mapping[str, str]) -> dict[str, str]:
    """Return the failing pairs whose names are those of an encoder and its decoder, each with the reason why it does
    not round-trip. Pairs without a reason were not tried and are left out."""
    return {pair: why for pair, why in failing.items() if why and _is_pair(pair)}


def _is_pair(pair: str) -> bool:
    """Whether two function names, ENCODE:DECODE, differ only in the words for encoding and decoding."""
    match = TWO_NAMES.fullmatch(pair)
    return bool(match) and [*map(role, match.groups())] == ["encode", "decode"] and stem(match[1]) == stem(match[2])


def _why_none(failing: Mapping[str, str]) -> str:
    """Return a message that none of a file's pairs can be measured, with the first few reasons.

    Args:
        failing: the reason for each pair; empty for a pair that was not tried."""
    named = [f"{pair}: {why}" for pair, why in failing.items() if why][:MOST_REASONS]
    if len(failing) == 1:
        return named[0]
    return f"none of its {len(failing)} pairs round-trips; {'; '.join(named)}{_untried(failing)}"


def _untried(failing: Mapping[str, str]) -> str:
    untried = [pair for pair, why in failing.items() if not why]
    return f"; not tried: {', '.join(untried)}" if untried else ""


def _wirings_of(file: UserFile) -> list[Wiring]:
    """Return the wirings of the two functions that a file's word names; empty if the word names no functions."""
    return [wiring_of(text) for text in file.functions or ()]


def _functions_of(file: UserFile) -> tuple[str, ...]:
    """Return the names of the two functions in a file's word; empty if the word names no functions."""
    return tuple(wiring.function for wiring in _wirings_of(file))


def _that_undo_themselves(file: UserFile, pairs: Sequence[str], by: str) -> tuple[list[str], dict[str, str]]:
    """Return the pairs that round-trip, each in its best wiring: the first for the whole sphere, else the first that
    works. Also return why the other pairs fail, by function names; empty for pairs that were not tried."""
    kept: dict[tuple[str, ...], tuple[bool, str]] = {}
    failing: dict[tuple[str, ...], str] = {}
    tries = Counter()
    for pair in pairs:
        word = file.with_pair(pair)
        functions = _functions_of(word)
        is_whole, _ = kept.get(functions, (False, ""))
        tries[functions] += 1
        if len(tries) > MOST_PAIRS or tries[functions] > MOST_WIRINGS:
            failing.setdefault(functions, "")
        elif not is_whole:
            domain, why = _undone(word, by)
            failing.setdefault(functions, why)
            if domain == SPHERE.name or (domain and functions not in kept):
                kept[functions] = (domain == SPHERE.name, pair)
    others = {":".join(functions): why for functions, why in failing.items() if functions not in kept}
    return [pair for _, pair in kept.values()], others


def _undone(file: UserFile, by: str) -> tuple[str, str]:
    """Return the name of the domain on which a pair round-trips, with an empty reason; if the pair does not
    round-trip, return an empty name with the reason."""
    try:
        encoding, gl = read_encoding(file, NOT_ASKED, by=by), device()
        with np.errstate(invalid="ignore"):
            # What lacks a part of its code comes back nearly.
            within = OF_A_WIRING_DEG if any(wiring.made for wiring in _wirings_of(file)) else OF_A_PAIR_DEG
            trip = trip_of(probe_of(gl, encoding), directions())
            if domain := guessed(trip, within).name:
                return domain, ""
            return "", trip.hole or f"decoded normals are {np.median(trip.angles()):.2g} degrees off (median)"
    except (UsageError, ShaderError) as error:
        return "", " ".join(str(error).split())[:LONGEST]


def _look_at_one(file: UserFile, domain: str, by: str) -> dict[str, Any]:
    """Return the findings on a file with a single pair, or whose word names a pair. Raises SeveralEncodersError."""
    try:
        encoding, gl = read_encoding(file, NOT_ASKED, by=by), device()
        broken = _endless(gl, encoding)
        other = {"by": by} if by else {}
        if not broken and (by or file.is_translated):
            other |= _second_look(file, gl, encoding)
        if "error" in other:
            return other
        may_be_unit = not broken and not encoding.is_packed
        unit = {"is_unit": True} if may_be_unit and _is_unit(probe_of(gl, encoding)) else {}
        if unit:
            encoding = read_encoding(file, NOT_ASKED, is_unit=True, by=by)
        return (broken or _judged(probe_of(gl, encoding), gl, domain)) | unit | other
    except (NoDeviceError, MissingError) as error:
        return {"missing": str(error)} | ({"by": by} if by else {})
    except SeveralEncodersError:
        raise
    except AloneError as error:
        of_one = _of_one(file, error.made)
        return of_one | {"error": f"{error}; {of_one['error']}"}
    except UsageError as error:
        return {"error": str(error)}
    except ShaderError as error:
        return {"error": _of_compiler(file, str(error))}


def _of_one(file: UserFile, translation: Translated) -> dict[str, Any]:
    """Describe an encoder or a decoder without a partner. The key `alone` gives its side, its name, and the encodings
    in the catalogue that it matches."""
    side, (name, _) = next(
        (side, function) for side, function in zip(SIDES, translation.functions, strict=True) if function[0]
    )
    try:
        gl = device()
        like = names_alone(gl, probe_of(gl, encoding_alone(file, translation)), side == SIDES[0])
    except (NoDeviceError, ShaderError) as error:
        like, sentence = [], f"not compared with the catalogue: {' '.join(str(error).split())[:300]}"
    else:
        sentence = f"{name} matches the {side}r of {like[0] if like else 'no encoding in the catalogue'}"
    return {"error": sentence, "alone": [side, name, *like]}


def _is_unit(probe: Probe) -> bool:
    """Whether the codes of all directions, or else of the directions that round-trip, fill [0, 1]."""
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


def _second_look(file: UserFile, gl: Device, encoding: Encoding) -> dict[str, Any]:
    return second_look(file, gl, encoding, directions(), lambda by: read_encoding(file, NOT_ASKED, by=by))


def _of_compiler(file: UserFile, message: str) -> str:
    """Return a compiler's message as one line of limited length that names the user's file; add a hint if the GLSL
    uses HLSL types."""
    line = " ".join(message.partition("=\n")[2].split()) or " ".join(message.split())
    if file.is_translated:
        message = re.sub(r"\S+\.glsl:(\d+)", r"line \1", line)[:LONGEST]
        return f"{file}: its translation to GLSL does not compile on this device: {message}"
    named = line if file.path.name in line else f"{file}: {line}"
    hint = of_hlsl(read_shader(file.path))
    return (named if len(named) <= LONGEST else f"{named[:LONGEST]} ...") + (f" ({hint})" if hint else "")


def _endless(gl: Device, encoding: Encoding) -> dict[str, Any]:
    n = _widened(directions())
    view = np.tile(np.array([*VIEW, 0.0], np.float32), (len(n), 1))
    for what, flags in zip(("encode", "decode"), loops_ended(gl, encoding, n, view), strict=True):
        if flags.any():
            reason = (
                f"this device silently ends a shader's loops after {loop_limit(gl) or 'too many'} iterations in total"
            )
            return {"broken": f"the loops of {what} for {n[np.argmax(flags), :3].tolist()} do not end here: {reason}"}
    return {}


def _judged(probe: Probe, gl: Device, domain: str) -> dict[str, Any]:
    diagnosis = diagnosed(probe, gl, domain.replace(ANY, ""))
    if diagnosis.broken:
        return {"broken": diagnosis.broken, "wrong": diagnosis.wrong}
    hole = {"hole": diagnosis.hole} if diagnosis.hole else {}
    packed = {"packed_bits": bits_used(_finite_trip(probe).codes)} if probe.is_packed else {}
    half = {"half": [diagnosis.domain.axis, diagnosis.domain.side]} if diagnosis.domain.is_turned else {}
    closely = _closely(probe, gl, diagnosis.domain) if domain else {}
    return {"domain": diagnosis.domain.name, "wrong": diagnosis.wrong} | packed | half | hole | closely


def _finite_trip(probe: Probe) -> Trip:
    trip = trip_of(probe, directions())
    return trip.of(trip.is_finite)


def _closely(probe: Probe, gl: Device, domain: Domain) -> dict[str, Any]:
    trip = _finite_trip(probe)
    lattice = lattice_of(trip.codes)
    return {
        "like": likeness(gl, probe, domain).shared(domain.name),
        "bad": bad(probe, domain)[:MOST_BAD].tolist(),
        "spared": list(spared(trip, probe)),
        **({"lattice": list(astuple(lattice))} if lattice else {}),
    }


def twin_look(file: UserFile, findings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the findings on a file's Python twin: `error` or `apart`; empty if the twin agrees with the GLSL, or if
    there is no device to run the GLSL.

    Args:
        findings: the first look's findings on the shader, whose functions the twin must match.
    """
    n = directions()
    view = np.tile(np.array([*VIEW, 0.0], np.float32), (len(n), 1))
    try:
        encoding = read_encoding(file_with(file, findings), by=findings.get("by", ""))
        check_twin(encoding)
        codes = _by_twin(encoding.encode, n, view)
        decoded = _by_twin(encoding.decode, codes, view)
    except NoDeviceError:
        return {}
    except BaseException as error:  # whatever a user's own file raises
        where = file.twin
        message = (
            str(error) if isinstance(error, UsageError | NoTwinError) else f"{where}: {type(error).__name__}: {error}"
        )
        return {"error": " ".join(message.split())[:300]}
    return _apart(encoding, n, view, codes, decoded)


def _by_twin(function: Callable[..., Any], given: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Return a twin function's results, of shape (count, components), for inputs of shape (count, 2 or 3). The
    function is called in the same way as in a measurement."""
    kind = {2: Vec2, 3: Vec3}[given.shape[1]]
    components = jax.jit(function)(kind(*map(jnp.asarray, given.T)), Vec3(*map(jnp.asarray, view.T[:3])))
    return np.stack(
        [np.broadcast_to(np.asarray(component, np.float32), len(given)) for component in components], axis=1
    )


def _apart(
    encoding: Encoding, n: np.ndarray, view: np.ndarray, codes: np.ndarray, decoded: np.ndarray
) -> dict[str, Any]:
    try:
        gl = device()
    except NoDeviceError:
        return {}
    by_gl, by_gl_decoded = exact_values(gl, encoding, _widened(n), view, _widened(codes))
    for what, given, by_twin, other in (("encode", n, codes, by_gl), ("decode", codes, decoded, by_gl_decoded)):
        far = ~(np.abs(by_twin - other[:, : by_twin.shape[1]]) <= APART).all(axis=1)
        if far.mean() > APART_SHARE:
            index = int(np.argmax(far))
            values = [row[index, : by_twin.shape[1]].round(4).tolist() for row in (by_twin, other)]
            share = f"{100 * far.mean():.0f}% of inputs, such as {given[index].round(4).tolist()}"
            return {"apart": f"{what} differs from the GLSL for {share}: {values[0]} in Python, {values[1]} in GLSL"}
    return {}


def _widened(array: np.ndarray) -> np.ndarray:
    return np.concatenate([array, np.zeros((len(array), 4 - array.shape[1]), np.float32)], axis=1)


def _alone() -> int:
    """Return a new file descriptor of standard output, for the answer only; redirect users' own output to stderr."""
    descriptor = os.dup(1)
    os.dup2(2, 1)
    return descriptor


def _looks(file: UserFile, domain: str = "") -> Iterator[dict[str, Any]]:
    look = first_look(file, domain)
    yield look
    if twin_is_looked_at(file, look):
        yield twin_look(file, look)


def main(words: Sequence[str]) -> None:
    """Print the findings on a file as lines of JSON; `words` are the file and, optionally, the domain."""
    children.limit_this_process()
    answer = _alone()
    for look in _looks(UserFile(words[0]), *words[1:]):
        os.write(answer, json.dumps(look).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
