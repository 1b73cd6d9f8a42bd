"""Users' own encodings: a .glsl file, and a Python twin beside it if there is one, measured like any other."""

from __future__ import annotations

import importlib.util
import json
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path
from traceback import extract_tb
from types import MappingProxyType
from typing import Any, NamedTuple

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from ...encodings.codecs.files import called
from ...encodings.vec import Vec2, Vec3
from ...gbuffer.gl.shader import ShaderError, read_shader
from ...reports.page.verdict import MADE_FOR
from ..machine import children
from ..machine.cores import on_all_cores
from ..options.words import given_in
from ..output.errors import MissingError, UsageError, check_comma, leave_out, names_a_file, pick, tell
from ..output.spelling import spelled
from . import tuned_names
from .signatures import FROM_HLSL, encode_of

ENDING = ".glsl"
# Endings of other languages: what they are called, and how a shader becomes GLSL.
LANGUAGES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        **dict.fromkeys((".hlsl", ".hlsli", ".fx"), ("HLSL", f"{FROM_HLSL}, and save it as .glsl")),
        ".slang": ("Slang", "slangc -target glsl translates it"),
        ".wgsl": ("WGSL", "naga FILE.wgsl FILE.frag translates it, or write it as GLSL"),
        ".metal": ("Metal", "write it as GLSL"),
    }
)
# A first look takes a second or two of processor time, which is limited too; one that sleeps takes for ever.
TIME_LIMIT = 60.0
TAKEN = "there is an encoding named {} already; rename its two functions"


class NoTwinError(Exception):
    """An encoding that is there in GLSL only."""


def encodings_named(names: str) -> list[Encoding]:
    """The encodings that comma-separated names stand for: the catalogue's, tuned ones, or files that end in .glsl.

    A file's encoding is looked at first, in a process of its own: what does not compile, does not end or is not finite
    is named on standard error and left out.

    Raises:
        UsageError: an unknown name, or nothing left.
    """
    check_comma(names)
    words = dict.fromkeys(word.strip() for word in names.split(","))
    own = given_in(names)
    for word in (word for word in words if word not in own):
        _check_word(word)
    files, complaints, notes = _read_all([word for word in words if word.endswith(ENDING)])
    rest = [word for word in words if word in files or not word.endswith(ENDING)]
    if complaints and not rest:
        raise UsageError(complaints[0])
    for line in complaints:
        leave_out(line)
    tuned = {word: tuned_names.tuned(word) for word in rest if tuned_names.MARK in word and word not in files}
    picked = pick("encoding", ",".join(rest), {**ENCODINGS, **files, **tuned, **own})
    # At last: an error is one line alone.
    for line in notes:
        tell(line)
    return picked


def _check_word(word: str) -> None:
    """Raises UsageError for a shader of another language, and for one without its ending."""
    file = f"{word}{ENDING}"
    if names_a_file(file) and spelled("encoding", word, ENCODINGS) is None:
        raise UsageError(f"unknown encoding {word!r}; did you mean the file {file}?")
    if (ending := Path(word).suffix.lower()) in LANGUAGES:
        language, how = LANGUAGES[ending]
        raise UsageError(f"{word}: {language} is not read; {how}. docs/bring-your-own.md shows how two functions look")


def _read_all(words: list[str]) -> tuple[dict[str, Encoding], list[str], list[str]]:
    """The encodings of files, why others are left out, and what is to be said of those that are not: lines."""
    found: dict[str, Encoding] = {}
    complaints: list[str] = []
    notes: list[str] = []
    for word, (looked, said) in zip(words, on_all_cores(_looked_at, map(Path, words)), strict=True):
        try:
            found[word] = _with_a_name(looked, Path(word), [encoding.name for encoding in found.values()])
            notes += said
        except UsageError as error:
            complaints.append(str(error))
    return found, complaints, notes


def _looked_at(path: Path) -> tuple[Encoding | UsageError, list[str]]:
    """A file's encoding after the first look, or why there is none; and what is to be said of it."""
    try:
        found = _look(path)
        _check(path, found.glsl)
        said = [f"{path}: {line}" for line in (*found.wrong, *found.notes)]
        said += [f"{path.with_suffix('.py')}: {found.twin['apart']}"] if "apart" in found.twin else []
        return replace(read_encoding(path, found.fault), domain=found.domain), said
    except UsageError as error:
        return error, []


class Examined(NamedTuple):
    """A file's encoding, what is likely wrong with it, what else there is to say, and whether it can be measured."""

    encoding: Encoding
    wrong: list[str]
    notes: list[str]
    is_measurable: bool


def examined(path: Path) -> Examined:
    """What there is to say of a file.

    Raises:
        UsageError: it is not an encoding, or does not compile.
        MissingError: there is no GL device to look at it with.
    """
    _check_word(str(path))
    known = spelled("encoding", str(path), ENCODINGS)
    if known and not path.exists():
        command = f"normalbench quality --encoding {known}"
        raise UsageError(f"{path} is in the catalogue; doctor examines a GLSL file. `{command}` measures it")
    found = _look(path)
    if "missing" in found.glsl:
        raise MissingError(found.glsl["missing"])
    if "error" in found.glsl:
        raise UsageError(found.glsl["error"])
    broken = [found.glsl["broken"]] if "broken" in found.glsl else []
    of_twin = [f"its Python twin: {found.twin['apart']}"] if "apart" in found.twin else []
    of_twin += [found.fault] if found.fault else []
    encoding = replace(read_encoding(path, found.fault), domain=found.domain)
    notes = [*found.notes, *([TAKEN.format(encoding.name)] if encoding.name in ENCODINGS else [])]
    return Examined(encoding, [*broken, *found.wrong, *of_twin], notes, not broken)


def _with_a_name(encoding: Encoding | UsageError, path: Path, taken: list[str]) -> Encoding:
    """The encoding. Raises UsageError where there is none, or rows could not tell its name from another's."""
    if isinstance(encoding, UsageError):
        raise encoding
    if encoding.name in ENCODINGS:
        raise UsageError(f"{path}: {TAKEN.format(encoding.name)}")
    if encoding.name in taken:
        raise UsageError(f"{path}: another file has an encoding named {encoding.name}; rename its two functions")
    return encoding


def read_encoding(path: Path, fault: str = "") -> Encoding:
    """An encoding from its GLSL file, and from the Python file of the same name where there is one.

    Args:
        path: of the GLSL file.
        fault: why the Python file is not to be used; what it would measure says so.

    Raises:
        UsageError: it cannot be read, or does not define its two functions.
    """
    try:
        text = read_shader(path)
    except ShaderError as error:
        raise UsageError(str(error)) from error
    name, components = encode_of(path, text)
    encode, decode = _lacking(fault) if fault else _twin(path.with_suffix(".py"))
    return Encoding(
        name=name,
        title=called(str(path)),
        encode=encode,
        decode=decode,
        components=components,
        domain="sphere",
        citation=called(str(path)),
        # Not resolved: the twin lies next to the path that was given.
        glsl=path.absolute(),
        ulps=(0, 0),
        ulps_reason="a user's own",
    )


def _lacking(reason: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """An encode and a decode that raise NoTwinError."""

    def lacking(*_: Any) -> Any:
        raise NoTwinError(reason)

    return lacking, lacking


def _twin(path: Path) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The encode and decode of a Python file; of a missing one, functions that raise NoTwinError."""
    if not path.exists():
        return _lacking(f"{path} is not there: this encoding is in GLSL only")
    try:
        spec = importlib.util.spec_from_file_location(path.stem, path)
        assert spec and spec.loader
        module = importlib.util.module_from_spec(spec)
        # What it prints is no part of a table.
        with redirect_stdout(sys.stderr):
            spec.loader.exec_module(module)
        return _guarded(path, module.encode, (Vec2, Vec3)), _guarded(path, module.decode, (Vec3,))
    except (Exception, SystemExit) as error:  # whatever a user's own file raises
        raise UsageError(f"{path}: {type(error).__name__}: {error}") from error


def _guarded(path: Path, function: Callable[..., Any], kinds: tuple[type, ...]) -> Callable[..., Any]:
    """A user's function that raises NoTwinError where it fails or gives something else."""
    wanted = " or ".join(f"a {kind.__name__}" for kind in kinds)

    def guarded(*given: Any) -> Any:
        try:
            made = function(*given)
        except Exception as error:
            lines = [
                frame.lineno for frame in extract_tb(error.__traceback__) if Path(frame.filename).name == path.name
            ]
            where = f" in line {lines[-1]}" if lines else ""
            raise NoTwinError(f"{path}: {type(error).__name__}{where}: {error}") from error
        if not isinstance(made, kinds):
            kind = "an array" if hasattr(made, "shape") else type(made).__name__
            raise NoTwinError(f"{path}: {function.__name__} returns {kind}, not {wanted}")
        return made

    return guarded


@dataclass(frozen=True)
class Looks:
    """What a first look found, see first_look.py.

    Attributes:
        glsl: of the shader.
        twin: of the Python twin; empty where there is none, or the shader is of no use.
        fault: why the twin cannot be measured; empty where it can be.
    """

    glsl: dict[str, Any]
    twin: dict[str, Any]
    fault: str

    @property
    def domain(self) -> str:
        """What the shader is made for, as far as what comes back of it says."""
        return self.glsl.get("domain") or "sphere"

    @property
    def wrong(self) -> list[str]:
        """What is likely wrong with a shader that can be measured."""
        return self.glsl.get("wrong", [])

    @property
    def notes(self) -> list[str]:
        """What was guessed of it."""
        held = MADE_FOR.get(self.domain)
        return [f"taken to be made for {held} alone: no others come back"] if held else []


def _look(path: Path) -> Looks:
    """A first look in a process of its own. Raises UsageError where its shader does not let it end well."""
    try:
        done = children.finished(children.python("normalbench.bench.codecs.first_look", str(path)), TIME_LIMIT)
        said, ended = done.stdout, _how_it_ended(done)
    except subprocess.TimeoutExpired as error:
        said, ended = str(error.output), f"did not end within {TIME_LIMIT:g} s"
    lines = list(_answers(said))
    if not lines:
        raise UsageError(f"{path}: its shader {ended}")
    has_twin = twin_is_looked_at(path, lines[0])
    if has_twin and len(lines) < 2:
        return Looks(lines[0], {}, f"{path}: its Python twin {ended}")
    twin = lines[1] if has_twin else {}
    return Looks(lines[0], twin, twin.get("error", ""))


def twin_is_looked_at(path: Path, found: dict[str, Any]) -> bool:
    """Whether a shader of which this was found has a twin, and is of use."""
    return not {"error", "broken"} & set(found) and path.with_suffix(".py").exists()


def _answers(said: str) -> Iterator[dict[str, Any]]:
    for line in said.splitlines():
        try:
            yield json.loads(line)
        except ValueError:
            return


def _how_it_ended(done: subprocess.CompletedProcess[str]) -> str:
    limits = f"it may use {children.MEMORY >> 20} MiB of memory and {children.SECONDS} s of processor time"
    if done.returncode < 0:
        return f"killed the process ({signal.Signals(-done.returncode).name}); {limits}"
    last = [line.strip() for line in done.stderr.splitlines() if line.strip()][-1:]
    return f"ended the process with status {done.returncode}" + (f": {last[0][:200]}" if last else "")


def _check(path: Path, found: dict[str, Any]) -> None:
    """Raises UsageError where a shader does not compile, or is not finite."""
    if "error" in found:
        raise UsageError(found["error"])
    if "broken" in found:
        raise UsageError(f"{path}: {found['broken']}")
