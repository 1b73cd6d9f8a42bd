"""A first look at a user's own encoding of anything except normals, in a process that may hang or crash.

    python -m normalbench.bench.subjects.codecs.kinds.look KIND FILE

Prints a line of JSON: `error`, what is wrong with the file, with `pairs`, the names of several pairs; `missing`, what
this machine lacks; or `broken`, a value for which the encoding is not finite or does not end. Otherwise `functions`,
the encoder and the decoder; `pair`, the only one of several pairs that round-trips; `error_max`, the largest error
among the tested values; `wrong`, `notes` and `measured`, lists of lines; and the findings for its kind (see
`own.py`).
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .....encodings.kinds import BY_NAME
from .....gbuffer.codecs.loops import loop_limit
from .....gbuffer.codecs.own.own_passes import Tried
from .....gbuffer.gl.device import Device, NoDeviceError, device
from .....gbuffer.gl.shader import ShaderError
from ....ground.machine import children
from ....ground.output.errors import MissingError, SeveralEncodersError, UsageError
from ....ground.user_files import UserFile
from ....shaders.languages.translated import translated
from .own import Own, OwnKind, Values
from .table import OWN

# How many pairs of a file are tried, and how many letters of a compiler's message are shown.
MOST_PAIRS, LONGEST = 12, 1000
NOT_A_PAIR = "encode and decode do not undo each other: {} is off by {:.3g} {}, the largest error of {} values"
BEYOND = "component {} of the code leaves [{}, 1], the range of fixed-point storages: {:.4g} for {}"
UNDONE = "largest error of {} values before any storage: {:.3g} {}"
REACH = "its components range from {}"
NOT_EXACT = "{} is not exact, but off by {:.3g} {} before any storage"


def look(kind: OwnKind, file: UserFile) -> dict[str, Any]:
    """Return the findings on a file's only pair, or on the only pair that round-trips; otherwise `error` and `pairs`.
    The module describes the keys."""
    try:
        return _look_at_one(kind, file)
    except SeveralEncodersError as error:
        kept = [pair for pair in error.pairs[:MOST_PAIRS] if _undoes_itself(kind, file.with_pair(pair))]
        if len(kept) == 1:
            return _look_at_one(kind, file.with_pair(kept[0])) | {"pair": kept[0]}
        named = ", ".join(str(file.with_pair(pair)) for pair in kept or error.pairs)
        verdict = f"{len(kept)} of its pairs round-trip; name one" if kept else "none of its pairs round-trips"
        return {"error": f"{file}: {verdict}: {named}", "pairs": kept}


def _undoes_itself(kind: OwnKind, file: UserFile) -> bool:
    findings = _look_at_one(kind, file)
    return findings.get("error_max", np.inf) <= kind.nearly


def _look_at_one(kind: OwnKind, file: UserFile) -> dict[str, Any]:
    """Return the findings on a file that has a single pair, or whose word names a pair; only `missing`, `error` or
    `broken` if the pair cannot be measured. Raises SeveralEncodersError."""
    try:
        gl, translation = device(), translated(file, kind=kind.kind)
        own = Own(file, translation, {})
        if broken := _endless(kind, own, gl):
            return {"broken": broken}
        facts = kind.facts(own, gl)
        return {"functions": translation.named} | facts | _judged(kind, Own(file, translation, facts), gl)
    except (NoDeviceError, MissingError) as error:
        return {"missing": str(error)}
    except SeveralEncodersError:
        raise
    except UsageError as error:
        return {"error": str(error)}
    except ShaderError as error:
        message = re.sub(r"\S+\.glsl:(\d+)", r"line \1", " ".join(str(error).partition("=\n")[2].split()) or str(error))
        return {"error": f"{file}: its translation to GLSL does not compile on this device: {message[:LONGEST]}"}


def _endless(kind: OwnKind, own: Own, gl: Device) -> str:
    """Describe a loop that the device has cut short; empty if no loop was."""
    values = kind.values(own)
    trial = own.tried(gl, values.given, values.more)
    for what, flags in (("encode", trial.encode_ended), ("decode", trial.decode_ended)):
        if flags.any():
            reason = (
                f"this device silently ends a shader's loops after {loop_limit(gl) or 'too many'} iterations in total"
            )
            return f"the loops of {what} for {_said(kind, values, int(np.argmax(flags)))} do not end here: {reason}"
    return ""


def _said(kind: OwnKind, values: Values, index: int) -> str:
    return kind.said(values.given[index], values.more[index])


def _judged(kind: OwnKind, own: Own, gl: Device) -> dict[str, Any]:
    values = kind.values(own)
    trial = own.tried(gl, values.given, values.more)
    errors = kind.errors(values, trial)
    for what, finite in (("encode", np.isfinite(trial.codes).all(axis=1)), ("decode", np.isfinite(errors))):
        if not finite.all():
            return {"broken": f"{what} returns no number for {_said(kind, values, int(np.argmin(finite)))}"}
    worst = int(np.argmax(errors))
    far = NOT_A_PAIR.format(_said(kind, values, worst), errors[worst], kind.unit, len(errors))
    wrong = [*([far] if errors[worst] > kind.nearly else []), *_beyond(kind, own, values, trial)]
    wrong += own.found.get("wrong", [])
    inexact = _inexact(kind, own, gl)
    notes = [*own.found.get("notes", []), *inexact.values()]
    exact = [f"{name} decodes exactly" for name in kind.exactly(own) if name not in inexact]
    least = [UNDONE.format(len(errors), errors[worst], kind.unit)] if errors[worst] <= kind.nearly else []
    measured = [*least, *exact, REACH.format(", ".join(_reach(trial, own.made.components)))]
    return {"error_max": float(errors[worst]), "wrong": wrong, "notes": notes, "measured": measured}


def _reach(trial: Tried, size: int) -> Iterator[str]:
    for number in range(size):
        codes = trial.codes[:, number]
        yield f"{codes.min():.4g} to {codes.max():.4g}"


def _beyond(kind: OwnKind, own: Own, values: Values, trial: Tried) -> Iterator[str]:
    """Yield a line for each component of a code that exceeds the range of storages, with the worst value."""
    least = 0 if own.is_unit or not own.shape.has_sign else -1
    if own.found.get("is_open"):
        return
    for number in range(own.made.components):
        codes = trial.codes[:, number].astype(np.float64)
        off = np.maximum(codes - 1, least - codes)
        worst = int(np.argmax(off))
        if off[worst] > kind.rounded:
            yield BEYOND.format(number + 1, least, codes[worst], _said(kind, values, worst))


def _inexact(kind: OwnKind, own: Own, gl: Device) -> dict[str, str]:
    """Return a line, by name, for each value that should round-trip exactly but does not."""
    lines: dict[str, str] = {}
    for name, values in kind.exactly(own).items():
        error = float(kind.errors(values, own.tried(gl, values.given, values.more))[0])
        if error != 0:
            lines[name] = NOT_EXACT.format(name, error, kind.unit)
    return lines


def main(words: Sequence[str]) -> None:
    """Write the findings on a file to stdout, as a line of JSON.

    Args:
        words: the name of a kind, and the path of a file."""
    children.limit_this_process()
    # Whatever users' code prints goes to stderr.
    answer = os.dup(1)
    os.dup2(2, 1)
    name, word = words
    os.write(answer, json.dumps(look(OWN[BY_NAME[name]], UserFile(word))).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
