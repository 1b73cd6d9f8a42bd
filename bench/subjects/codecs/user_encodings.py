"""Users' own encodings, measured like any other: shader files, each with an optional Python twin next to it."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path
from traceback import extract_tb
from typing import Any, NamedTuple

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.files import called
from ....encodings.storages.storage import BITS_32
from ....encodings.vec import Vec2, Vec3
from ....gbuffer.codecs.harness import takes_view
from ....gbuffer.gl.shader import ShaderError, read_shader
from ....gbuffer.gl.shader import Source as Shader
from ...ground.compilers.lines import bare
from ...ground.machine import children
from ...ground.machine.systems import forks
from ...ground.output.errors import NO_TWIN, MissingError, SeveralEncodersError, UsageError
from ...ground.spelling import spelled
from ...ground.user_files import ENDINGS, UserFile, check_word, names_an_encoder
from ...shaders.code.twin import NoTwinError, lacking_twin
from ...shaders.languages.pairs import NORMAL, Function
from ...shaders.languages.programs import has_halves, pair
from ...shaders.languages.source import Source
from ...shaders.languages.translated import Translated, glsl_file, translated
from .doctor.domains import SPHERE, Domain
from .doctor.nearly import Lattice
from .looked_at import TAKEN, Looked
from .signatures import check_given, encode_of

# A first look takes a second or two of processor time, which is limited too; one that sleeps takes for ever.
TIME_LIMIT = 60.0
# In place of a domain, to look closely at a file whose author does not say what it is made for.
ANY = "any"
FIRST_LOOK = "normalbench.bench.subjects.codecs.first_look"
DECLARES_HALF = (
    "it declares 16-bit numbers: quality and cost also have rows in half arithmetic, and pick uses them; all "
    "other tables compute in 32 bits"
)
IN_32_BITS = "it declares 16-bit numbers, but its code is an integer: it is computed in 32 bits"
UNIT = "{} are in [0, 1]; every storage holds them unchanged, signed and float included"


def looked_at(file: UserFile) -> Looked[Encoding]:
    """Return a file's encoding after a first look, and lines to report about the file.

    Raises:
        UsageError, MissingError: the file has no encoding that can be measured here.
        SeveralEncodersError: several pairs in the file round-trip.
    """
    looks = _look(file)
    if pairs := looks.glsl.get("pairs"):
        raise SeveralEncodersError(looks.glsl["error"], pairs)
    _check(file, looks.glsl)
    encoding = looks.encoding()
    # That codes are in [0, 1] is said by doctor, and in rows by a column.
    of = file.plain
    remarks = [f"{of}: {line}" for line in (*looks.wrong, *looks.notes) if line != looks.unit_note]
    remarks += [f"{of}: {DECLARES_HALF if encoding.is_also_half else IN_32_BITS}"] if encoding.declares_half else []
    return encoding, remarks + ([f"{file.twin}: {looks.twin['apart']}"] if "apart" in looks.twin else [])


class OneFunctionError(UsageError):
    """The error for a file that has an encoder or a decoder without a partner.

    Attributes:
        side: "encode" or "decode".
        function: the function's name.
        like: the encodings in the catalogue that the function matches.
    """

    def __init__(self, message: str, side: str, function: str, *like: str):
        super().__init__(message)
        self.side, self.function, self.like = side, function, like


class Examined(NamedTuple):
    """The findings of a close look at a file.

    Attributes:
        encoding: the file's encoding.
        domain: the directions that the encoding is made for.
        wrong: likely mistakes, as lines.
        notes: other remarks, as lines.
        is_measurable: whether the encoding can be measured.
        like: the name of the encoding in the catalogue that it matches, in any axes; empty if it matches no encoding.
        bad: directions that decode to other directions, in the file's own axes.
        lattice: the steps that the encoder itself rounds codes to; None if it does not round.
        functions: the names of the encoder and the decoder, as ENCODE:DECODE.
        failing: the reason why each other pair in the file does not round-trip, by ENCODE:DECODE.
    """

    encoding: Encoding
    domain: Domain
    wrong: list[str]
    notes: list[str]
    is_measurable: bool
    like: str
    bad: list[list[float]]
    lattice: Lattice | None
    functions: str
    failing: Mapping[str, str]


def examined(file: UserFile, domain: str = ANY) -> Examined:
    """Return a file's encoding with the likely mistakes and the notes from a close look.

    Args:
        domain: the domain that the author made the encoding for; ANY to find out.

    Raises:
        UsageError: the file is not an encoding, or does not compile.
        SeveralEncodersError, OneFunctionError: the file has several pairs, or only one function.
        MissingError: no compiler or OpenGL device can run the file here.
    """
    check_word(str(file), ENCODINGS)
    known = spelled("encoding", str(file), ENCODINGS)
    if known and not file.path.exists():
        command = f"normalbench quality --encoding {known}"
        raise UsageError(f"{file} is in the catalogue; doctor examines your files. Measure it with `{command}`")
    if file.path.is_file() and not names_an_encoder(str(file)):
        raise UsageError(f"{file}: its name does not end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    looks = _look(file, domain)
    if "missing" in looks.glsl:
        raise MissingError(looks.glsl["missing"])
    if pairs := looks.glsl.get("pairs"):
        raise SeveralEncodersError(looks.glsl["error"], pairs, failing=[*looks.glsl["failing"]])
    if alone := looks.glsl.get("alone"):
        raise OneFunctionError(looks.glsl["error"], *alone)
    if "error" in looks.glsl:
        raise UsageError(looks.glsl["error"])
    broken = [looks.glsl["broken"]] if "broken" in looks.glsl else []
    of_twin = [f"its Python twin: {looks.twin['apart']}"] if "apart" in looks.twin else []
    of_twin += [looks.fault] if looks.fault else []
    encoding = looks.encoding()
    taken = [TAKEN.format(encoding.name, what_names(encoding))] if encoding.name in ENCODINGS else []
    notes = [*looks.notes, *looks.glsl.get("spared", []), *taken]
    wrong = [*broken, *looks.wrong, *of_twin]
    lattice = Lattice(*looks.glsl["lattice"]) if "lattice" in looks.glsl else None
    functions = _functions_in(looks.file, looks.glsl.get("by", ""))
    close = looks.glsl.get("like", ""), looks.glsl.get("bad", []), lattice, functions, looks.glsl.get("failing", {})
    return Examined(encoding, looks.domain, wrong, notes, not broken, *close)


def _functions_in(file: UserFile, by: str) -> str:
    """Return the names of the two functions that are examined; for GLSL, `NAME_encode:NAME_decode`."""
    if by or file.is_translated:
        return translated(file).named
    name, *_ = encode_of(file, read_shader(file.path))
    return f"{name}_encode:{name}_decode"


def what_names(encoding: Encoding) -> str:
    """Return in words where an encoding's name comes from: its file, or its two functions."""
    return "the file" if encoding.source and encoding.name.startswith(encoding.source.name) else "its two functions"


def read_encoding(file: UserFile, fault: str = "", is_unit: bool = False, by: str = "") -> Encoding:
    """Return the encoding in a file, with Python functions from the Python file of the same name if it exists.

    Without a usable Python file, the Python functions of the encoding raise NoTwinError.

    Args:
        file: the shader file, with the names of its functions if they are needed.
        fault: why the Python file must not be used, for the message of NoTwinError; empty to use it.
        is_unit: whether the codes are in [0, 1].
        by: the language whose compiler reads the file, if not the file's own language.

    Raises:
        UsageError: the file cannot be read, or does not define the two functions.
        MissingError: the compiler of the language is missing.
    """
    text = _text(file, is_unit, by)
    encode, decode = _lacking_functions(fault) if fault else _twin_functions(file.twin)
    twin = _of_unit(encode, decode) if is_unit else (encode, decode)
    encoding = _encoding(file, text, *twin)
    source = file.path.absolute() if is_unit or by or file.is_translated else None
    return replace(encoding, source=source, is_unit=is_unit and not text.is_packed)


def encoding_alone(file: UserFile, translation: Translated) -> Encoding:
    """Return the encoding of a file with only an encoder or only a decoder; the missing function returns 0."""
    text = _Text(translation.name, translation.components, translation.glsl(False), translation.prefix)
    return _encoding(file, text, *_lacking_functions(NO_TWIN))


def _encoding(file: UserFile, text: _Text, encode: Callable[..., Any], decode: Callable[..., Any]) -> Encoding:
    return Encoding(
        name=text.name,
        title=called(str(file)),
        encode=encode,
        decode=decode,
        components=text.components,
        domain="sphere",
        citation=called(str(file)),
        glsl=text.glsl,
        ulps=(0, 0),
        ulps_reason="a user's own",
        functions=text.functions,
        declares_half=text.declares_half,
        packed_bits=sum(BITS_32.bits) if text.is_packed else 0,
    )


def _of_unit(encode: Callable[..., Any], decode: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Convert an encode and a decode with codes in [0, 1] to functions with codes in [-1, 1]."""
    return lambda n, view: encode(n, view) * 2.0 - 1.0, lambda e, view: decode(e * 0.5 + 0.5, view)


class _Text(NamedTuple):
    """An encoding's name, component count, GLSL file and function prefix; whether it is packed or declares halves."""

    name: str
    components: int
    glsl: Path
    functions: str = ""
    is_packed: bool = False
    declares_half: bool = False


def _text(file: UserFile, is_unit: bool, by: str) -> _Text:
    if by or file.is_translated:
        shader = translated(file, by)
        # Rows of the catalogue's have that name; two functions of another language need not be renamed for it.
        name = called(file.path.name) if shader.name in ENCODINGS else shader.name
        declares_half = has_halves(shader.text)
        return _Text(name, shader.components, shader.glsl(is_unit), shader.prefix, bool(shader.packed), declares_half)
    try:
        name, components, _ = encode_of(file, read_shader(file.path))
    except ShaderError as error:
        raise UsageError(str(error)) from error
    whole = _with_includes(file)
    check_given(file, whole)
    # Not resolved: the twin lies next to the file that was given.
    place = file.path.absolute()
    shader = _of_unit_text(place, name, components) if is_unit else _Text(name, components, place)
    return shader._replace(declares_half=has_halves(whole))


def _of_unit_text(file: Path, name: str, components: int) -> _Text:
    """Write a GLSL file that includes a file with codes in [0, 1] and converts its functions to codes in [-1, 1];
    return its _Text. Raises UsageError if the path of the included file has quotes or control characters."""
    sizes = {"encode": (components, NORMAL), "decode": (NORMAL, components)}
    encoder, decoder = (
        Function(f"{name}_{side}", output_size, (given, NORMAL) if takes_view(file, f"{name}_{side}") else (given,))
        for side, (output_size, given) in sizes.items()
    )
    # Into a text of this program goes no name that could end the line or the quotes.
    if '"' in str(file) or not str(file).isprintable():
        raise UsageError(f"{file}: its name has quotes or control characters; rename it")
    prefix = f"unit_{name}"
    text = f'#include "{file}"\n' + pair(prefix, components, encoder, decoder, is_unit=True)
    return _Text(name, components, glsl_file(prefix, text), prefix)


def _with_includes(file: UserFile) -> str:
    """Return the text of a file and its includes as the compiler receives it, without comments. Raises UsageError if
    the file cannot be read, or includes a file from a folder that it may not read."""
    try:
        return bare(Shader(file.path, may_read=Source(file).may_read).text)
    except ShaderError as error:
        raise UsageError(str(error)) from error


def _lacking_functions(reason: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return an encode and a decode that raise NoTwinError with this reason."""
    return lacking_twin(reason), lacking_twin(reason)


def _twin_functions(path: Path) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the encode and decode of a Python file; if the file is missing, functions that raise NoTwinError. Raises
    UsageError if the file fails to run or lacks a function."""
    if not path.exists():
        return _lacking_functions(f"{path.stem} {NO_TWIN}; add {path.name} next to it for rows computed by JAX")
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
    """Wrap a user's function to raise NoTwinError if the call fails or the result's type is not one of `kinds`."""
    wanted = " or ".join(f"a {kind.__name__}" for kind in kinds)

    def guarded(*given: Any) -> Any:
        try:
            output = function(*given)
        except Exception as error:
            lines = [
                frame.lineno for frame in extract_tb(error.__traceback__) if Path(frame.filename).name == path.name
            ]
            where = f" in line {lines[-1]}" if lines else ""
            raise NoTwinError(f"{path}: {type(error).__name__}{where}: {error}") from error
        if not isinstance(output, kinds):
            kind = "an array" if hasattr(output, "shape") else type(output).__name__
            raise NoTwinError(f"{path}: {function.__name__} returns {kind}, not {wanted}")
        return output

    return guarded


@dataclass(frozen=True)
class Looks:
    """The findings of a first look (see first_look.py).

    Attributes:
        file: the user's file, with the names of its functions if they are needed.
        glsl: findings on the shader.
        said: remarks from the translation.
        twin: findings on the Python twin; empty without a twin, or if the shader is unusable.
        fault: why the twin cannot be measured; empty if it can be measured.
        is_asked: whether the user states what the encoding is made for.
    """

    file: UserFile
    glsl: dict[str, Any]
    twin: dict[str, Any]
    fault: str
    said: tuple[str, ...] = ()
    is_asked: bool = False

    def encoding(self) -> Encoding:
        """Read the file again and return its encoding with the domain and packed bits that were found."""
        read = read_encoding(self.file, self.fault, self.is_unit, self.glsl.get("by", ""))
        read = replace(read, packed_bits=self.glsl.get("packed_bits", read.packed_bits))
        return self.domain.measured(read)

    @property
    def is_unit(self) -> bool:
        """Whether the encoding's codes are in [0, 1]."""
        return self.glsl.get("is_unit", False)

    @property
    def domain(self) -> Domain:
        """The domain that the shader is made for, judged by the directions that round-trip."""
        return Domain(self.glsl.get("domain") or SPHERE.name, *self.glsl.get("half", ()))

    @property
    def wrong(self) -> list[str]:
        """The likely mistakes in a shader that can be measured."""
        return self.glsl.get("wrong", [])

    @property
    def notes(self) -> list[str]:
        """Remarks on the file and what was assumed about it, in sentences."""
        notes = [*self.said, *self.glsl.get("notes", []), *([self.unit_note] if self.is_unit else [])]
        return [*notes, *self._of_domain()]

    @property
    def unit_note(self) -> str:
        """The note that codes are in [0, 1], and for which normals."""
        made_for = self.domain.made_for
        return UNIT.format(f"the codes of {made_for}" if made_for else "its codes")

    def _of_domain(self) -> Iterator[str]:
        """Yield at most one sentence: the normals that the file is assumed to be made for or, if the user gave a
        domain, where a function is not finite outside that domain."""
        domain, hole = self.domain, self.glsl.get("hole")
        if self.is_asked and hole:
            yield f"it is meant for {domain.made_for}; elsewhere {hole}"
        elif domain.made_for and not self.is_asked:
            turned = "; tables rotate it so that this half is z >= 0" if domain.is_turned else ""
            yield f"assumed to be made only for {domain.made_for}: {hole or 'other normals do not round-trip'}{turned}"


def _look(file: UserFile, domain: str = "") -> Looks:
    """Return the findings of a first look in a separate process; see `first_look`.

    Raises:
        UsageError: the file cannot be translated, or its shader crashes the process or does not end.
        MissingError: the compiler of its language is not installed.
    """
    try:
        done = forks.finished(FIRST_LOOK, [str(file), *([domain] if domain else [])], TIME_LIMIT)
        output, ended = done.stdout, children.how_it_ended(done)
    except subprocess.TimeoutExpired as error:
        output, ended = str(error.output), f"did not end within {TIME_LIMIT:g} s"
    lines = list(_answers(output))
    if not lines:
        raise UsageError(f"{file}: its shader {ended}")
    file = file_with(file, lines[0])
    said_of_it, is_asked = (
        () if "error" in lines[0] else _said_of(file, lines[0].get("by", "")),
        domain not in ("", ANY),
    )
    has_twin = twin_is_looked_at(file, lines[0])
    if has_twin and len(lines) < 2:
        return Looks(file, lines[0], {}, f"{file}: its Python twin {ended}", said_of_it, is_asked)
    twin = lines[1] if has_twin else {}
    return Looks(file, lines[0], twin, twin.get("error", ""), said_of_it, is_asked)


def file_with(file: UserFile, findings: Mapping[str, Any]) -> UserFile:
    """Return a file with what a first look found: its language, if its extension is another language's, and the only
    pair of several that round-trips. Without these findings the file is unchanged."""
    if "language" in findings:
        file = file.with_language(findings["language"])
    return file.with_pair(findings["pair"]) if "pair" in findings else file


def _said_of(file: UserFile, by: str) -> tuple[str, ...]:
    """Return the notes from a file's translation; for GLSL, a remark on each encoding that is not measured."""
    if by or file.is_translated:
        return tuple(translated(file).notes)
    name, _, others = encode_of(file, read_shader(file.path))
    return tuple(f"only {name} is measured; move {other} into a separate file" for other in others)


def twin_is_looked_at(file: UserFile, findings: dict[str, Any]) -> bool:
    """Whether a file has a Python twin, and a shader that is usable according to the findings."""
    return not {"error", "broken"} & set(findings) and file.twin.exists()


def _answers(output: str) -> Iterator[dict[str, Any]]:
    for line in output.splitlines():
        try:
            yield json.loads(line)
        except ValueError:
            return


def _check(file: UserFile, findings: dict[str, Any]) -> None:
    """Raise UsageError if the findings on a shader include an error or say that it cannot be measured."""
    if "error" in findings:
        raise UsageError(findings["error"])
    if "broken" in findings:
        raise UsageError(f"{file}: {findings['broken']}")
