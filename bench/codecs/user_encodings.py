"""Users' own encodings: a .glsl file, and a Python twin beside it if there is one, measured like any other."""

from __future__ import annotations

import importlib.util
import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from ...gbuffer.gl.shader import ShaderError, read_shader
from ..options.words import given_in
from ..output.errors import UsageError, pick
from . import tuned_names

# vec2 mine_encode(vec3 n, vec3 view)
ENCODE = re.compile(r"\bvec([23])\s+(\w+)_encode\s*\(\s*vec3\s+\w+\s*,\s*vec3\s+\w+\s*\)")
ENDING = ".glsl"
# A first look takes a second or two; a shader that does not end takes for ever.
TIME_LIMIT = 60.0
# Farther off than that on average it is hardly the decoder of this encoder.
STRANGE_DEG = 15.0


class NoTwinError(Exception):
    """An encoding that is there in GLSL only."""


def encodings_named(names: str) -> list[Encoding]:
    """The encodings that comma-separated names stand for: the catalogue's, tuned ones, or files that end in .glsl.

    A file's encoding is looked at first, in a process of its own: what does not compile, does not end or is not finite
    is named on standard error and left out.

    Raises:
        UsageError: an unknown name, or nothing left.
    """
    words = dict.fromkeys(word.strip() for word in names.split(","))
    files, complaints = _read_all([word for word in words if word.endswith(ENDING)])
    rest = [word for word in words if word in files or not word.endswith(ENDING)]
    if complaints and not rest:
        raise UsageError(complaints[0])
    for line in complaints:
        print(f"normalbench: left out: {' '.join(line.split())}", file=sys.stderr)
    tuned = {word: tuned_names.tuned(word) for word in rest if tuned_names.MARK in word and word not in files}
    return pick("encoding", ",".join(rest), {**ENCODINGS, **files, **tuned, **given_in(names)})


def _read_all(words: list[str]) -> tuple[dict[str, Encoding], list[str]]:
    """The encodings of files, and why others are left out: a line for each."""
    found: dict[str, Encoding] = {}
    complaints: list[str] = []
    for word in words:
        try:
            found[word] = _looked_at(Path(word), [encoding.name for encoding in found.values()])
        except UsageError as error:
            complaints.append(str(error))
    return found, complaints


def _looked_at(path: Path, taken: list[str]) -> Encoding:
    """A file's encoding after the first look. Raises UsageError where rows could not tell its name from another's."""
    encoding = replace(read_encoding(path), domain=_domain(path, _look(path)))
    if encoding.name in ENCODINGS:
        raise UsageError(f"{path}: there is an encoding named {encoding.name} already; rename its two functions")
    if encoding.name in taken:
        raise UsageError(f"{path}: another file has an encoding named {encoding.name}; rename its two functions")
    return encoding


def read_encoding(path: Path) -> Encoding:
    """An encoding from its GLSL file, and from the Python file of the same name where there is one.

    Raises:
        UsageError: it cannot be read, or does not define its two functions.
    """
    try:
        text = read_shader(path.resolve())
    except ShaderError as error:
        raise UsageError(str(error)) from error
    match = ENCODE.search(re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S))
    if not match:
        raise UsageError(f"{path}: no function vec2 (or vec3) NAME_encode(vec3 n, vec3 view)")
    encode, decode = _twin(path.with_suffix(".py"))
    return Encoding(
        name=match[2],
        title=str(path),
        encode=encode,
        decode=decode,
        components=int(match[1]),
        domain="sphere",
        citation=str(path),
        # Not resolved: the twin lies next to the path that was given.
        glsl=path.absolute(),
        ulps=(0, 0),
        ulps_reason="a user's own",
    )


def _twin(path: Path) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The encode and decode of a Python file; of a missing one, functions that raise NoTwinError."""
    if not path.exists():

        def missing(*_: Any) -> Any:
            raise NoTwinError(f"{path} is not there: this encoding is in GLSL only")

        return missing, missing
    try:
        spec = importlib.util.spec_from_file_location(path.stem, path)
        assert spec and spec.loader
        module = importlib.util.module_from_spec(spec)
        # What it prints is no part of a table.
        with redirect_stdout(sys.stderr):
            spec.loader.exec_module(module)
        return module.encode, module.decode
    except (Exception, SystemExit) as error:  # whatever a user's own file raises
        raise UsageError(f"{path}: {type(error).__name__}: {error}") from error


def _look(path: Path) -> dict[str, Any]:
    """A first look in a process of its own, see first_look.py. Raises UsageError where it does not end well."""
    command = [sys.executable, "-m", "normalbench.bench.codecs.first_look", str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired as error:
        raise UsageError(f"{path}: its shader did not end within {TIME_LIMIT:g} s") from error
    if done.returncode < 0:
        raise UsageError(f"{path}: its shader killed the process ({signal.Signals(-done.returncode).name})")
    try:
        return json.loads(done.stdout)
    except ValueError as error:
        last = done.stderr.strip().splitlines()[-1:] or [f"status {done.returncode}"]
        raise UsageError(f"{path}: the first look failed: {last[0]}") from error


def _domain(path: Path, found: dict[str, Any]) -> str:
    """Where the decoder undoes the encoder; that it does nowhere is said on standard error.

    Raises:
        UsageError: it does not compile, or is not finite.
    """
    if "error" in found:
        raise UsageError(found["error"])
    if "broken" in found:
        raise UsageError(f"{path}: {found['broken']}")
    for domain, mean in found.get("mean_deg", {}).items():
        if mean <= STRANGE_DEG:
            return domain
    if "mean_deg" in found:
        print(
            f"normalbench: {path}: decode(encode(n)) is {found['mean_deg']['sphere']:.0f} degrees off on average, "
            f"without any storage; {found['worst']} comes back as {found['becomes']}",
            file=sys.stderr,
        )
    return "sphere"
