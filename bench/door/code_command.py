"""The `code` command: writes a codec's functions in the languages used by engines, and verifies them."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

from ...encodings.codecs.codec import Codec
from ...encodings.kinds import CURVE, FRAME, MOTION, NORMAL, Kind
from ...gbuffer.gl.shader import ShaderError
from ..ground.choose import choose, unknown_name
from ..ground.machine.memory import require_memory
from ..ground.machine.systems.people import command_line
from ..ground.options.code import CodeOptions
from ..ground.options.source_options import in_names
from ..ground.options.targets import that_fit, what_is_left
from ..ground.options.words import Names
from ..ground.output.errors import UsageError, leave_out, tell
from ..ground.spelling import spelled
from ..shaders.code.emit import LANGUAGES
from ..shaders.code.files import Code, code_of, stem_of, usual_prefix
from ..shaders.code.kinds.table import kind_of
from ..shaders.code.verify import Agreement, agreement
from ..subjects.codecs.kinds.codecs import NAMED, codecs_of_kind, kinds_named
from ..subjects.codecs.names import codecs_named, fitting
from ..subjects.names.storages import roundings_named
from .code_figures import figures, head, rounding_of
from .code_rows import DIFFERS, NOT_RUN, WITNESSES, Row, check_codes, check_place, compared, save, witness
from .gbuffer_command import LAYOUT, check_no_layout, gbuffer_command, is_of_layouts

SHIPPED = ("rgba8", "rg8", "rgb10a2", "rgb8_12_12", "rg16", "rg16f")
LONGEST = 60
# Codes whose numbers may be cut off.
ROUNDED = (NORMAL, MOTION, CURVE, FRAME)
ROUNDED_WORDS = "normals, motion, curves and tangent frames"
# What the head of code says that was not run.
NOT_COMPARED = "not in this run; the command below runs the code and compares it with the catalogue"


def code_command(options: CodeOptions, format: str, output: Path | None) -> int:
    """Write the code or, with `check`, a table of verification results. Return the exit status: 1 if code differs.

    Raises:
        UsageError: a name is unknown, nothing fits, or a file cannot be written.
    """
    require_memory()
    _check_prefix(options.prefix)
    values = {field.name: getattr(options, field.name) for field in fields(options)}
    options = replace(options, **in_names(values | {"of": _of_named(options.of)}))
    languages = choose("language", options.to, {name: name for name in LANGUAGES})
    if is_of_layouts(options):
        return gbuffer_command(options, languages, format, output)
    check_no_layout(options)
    codecs = _codecs(options)
    if options.prefix and len(codecs) > 1 and not options.check:
        raise UsageError(f"--prefix {options.prefix}: names of {len(codecs)} codecs would collide; name one codec")
    if options.check:
        codes = _all_made(codecs, languages, options.prefix)
        return check_codes(codes, verified, ("encoding", "storage", "rounding"), format, output)
    check_place(output, len(codecs) * len(languages))
    return _write(codecs, languages, options, output)


def _of_named(word: str) -> str:
    """Return the kind given with `--of`, or LAYOUT; empty without `--of`, if the names decide. Raises UsageError."""
    known = (*NAMED, LAYOUT)
    if not word:
        return ""
    kind = spelled("kind", word, known)
    if not kind:
        raise unknown_name("kind", [word], known)
    return kind


def _check_prefix(prefix: str) -> None:
    """Raise UsageError if names cannot begin with the prefix in every language."""
    is_name = re.fullmatch(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", prefix) and not prefix.lower().startswith("gl_")
    if prefix and not (is_name and len(prefix) <= LONGEST):
        raise UsageError(
            f"--prefix {prefix[:LONGEST]!r}: use at most {LONGEST} letters, digits and single underscores between "
            "them, beginning with a letter but not with gl_, such as engine_normal"
        )


def _codecs(options: CodeOptions) -> list[Any]:
    """Return the named codecs of every kind; a kind that does not accept the options is reported on standard error.

    Raises:
        UsageError: no kind accepts the options, or a name is unknown.
    """
    codecs: list[Any] = []
    complaints: list[str] = []
    for kind, names in kinds_named(options.codec, options.of).items():
        if kind is NORMAL:
            codecs += _normals(names, options)
            continue
        try:
            codecs += _of_kind(kind, names, options)
        except UsageError as error:
            complaints.append(str(error))
    return what_is_left(codecs, complaints)


def _of_kind(kind: Kind, names: Names, options: CodeOptions) -> list[Any]:
    rounded = roundings_named(options.rounding)
    if rounded != ["nearest"] and kind not in ROUNDED:
        raise UsageError(f"--rounding applies only to {ROUNDED_WORDS}; encodings of {kind.word} round to nearest")
    return that_fit(codecs_of_kind(kind, names, options.storage, rounded, slice(1)))


def _normals(names: Names, options: CodeOptions) -> list[Codec]:
    storages = options.storage or (SHIPPED if options.check else ("rgba8",))
    codecs, left_out = fitting(codecs_named(names, storages, options.rounding))
    if not options.check or options.storage:
        for line in left_out:
            leave_out(line)
    return codecs


def _write(codecs: Sequence[Any], languages: Sequence[str], options: CodeOptions, output: Path | None) -> int:
    written = (_write_codec(codec, languages, _prefix(codec, codecs, options), output) for codec in codecs)
    return max(written, default=0)


def _prefix(codec: Any, codecs: Sequence[Any], options: CodeOptions) -> str:
    """Return the prefix of a codec's names; empty for the usual prefix. Codecs of one kind are written to the same
    folder and may be used together, so each codec has its own names."""
    is_alone = sum(usual_prefix(other) == usual_prefix(codec) for other in codecs) == 1
    return options.prefix or ("" if is_alone else stem_of(codec))


def _write_codec(codec: Any, languages: Sequence[str], prefix: str, output: Path | None) -> int:
    """Write a codec's code in each language, or report why it is not written; see `_why_not`. Return the exit status:
    1 if any code is not written."""
    status = 0
    for proof in proven(codec, languages, prefix):
        language = proof.code.language
        if proof.why_not:
            status = 1
            tell(f"{codec.name} in {language}: {proof.why_not}; not written")
            continue
        if proof.row["verdict"] == NOT_RUN:
            tell(f"{codec.name} in {language}: {proof.row['says']}")
        save(proof.code, proof.head(), output)
    return status


@dataclass(frozen=True)
class Proven:
    """A codec's code in one language, and how its results compare with the catalogue's.

    Attributes:
        code, row: the code, and its row from `verified`.
        why_not: the reason why the code is not written; empty if it is written.
        head: a function that returns the paragraphs above the code.
    """

    code: Code
    row: Row
    why_not: str
    head: Callable[[], list[str]]


def proven(codec: Any, languages: Sequence[str], prefix: str = "") -> Iterator[Proven]:
    """Yield a codec's code in each language, run and compared with the catalogue. Raises UsageError if the codec
    cannot be written in any language."""
    # Measured once, and only where something is written.
    cached_figures = cache(partial(figures, codec) if isinstance(codec, Codec) else list)
    own = replace(codec, encoding=getattr(codec.encoding, "own", None) or codec.encoding)
    pairs = [(code, verified(code)) for code in _all_made([own], languages, prefix)]
    for code, row in pairs:
        yield Proven(
            code, row, _why_not(code, row, pairs), partial(_proven_head, code, codec, prefix, row, cached_figures)
        )


def _proven_head(code: Code, codec: Any, prefix: str, row: Row, figure_lines: Callable[[], list[str]]) -> list[str]:
    return head(code, codec, _command(codec, code.language, prefix), row["says"], figure_lines())


def unproven_head(code: Code) -> list[str]:
    """Return the header paragraphs for catalogue code that was not run; they name the command that runs it."""
    return head(code, code.codec, _command(code.codec, code.language, ""), NOT_COMPARED, ())


def _why_not(code: Code, row: Row, pairs: Sequence[tuple[Code, Row]]) -> str:
    """Return the reason why the code in one language is not written; empty if it is written.

    All languages are written from one tree. If the code in one language differs, the tree is assumed to be wrong for
    all. Code that cannot be run here, such as Metal, is written unless the code in another language differs.
    """
    if row["verdict"] == DIFFERS:
        return row["says"]
    others = [pair for pair in pairs if pair[0] is not code]
    if row["verdict"] == NOT_RUN:
        others = others or witness((code_of(code.codec, name, code.prefix) for name in WITNESSES), verified)
    wrong = [other.language for other, other_row in others if other_row["verdict"] == DIFFERS]
    return f"its translation to {wrong[0]} is wrong" if wrong else ""


def _all_made(codecs: Sequence[Any], languages: Sequence[str], prefix: str) -> list[Code]:
    """Return the code of each codec in each language; report on standard error which code cannot be written.

    Raises:
        UsageError: no code can be written.
    """
    codes, complaints = [], []
    for codec in codecs:
        for language in languages:
            try:
                codes.append(code_of(codec, language, prefix))
            except (UsageError, ShaderError) as error:
                complaints.append(str(error))
    return what_is_left(codes, complaints)


def _command(codec: Any, language: str, prefix: str) -> str:
    kind = kind_of(codec)
    name = kind.named(codec) if kind.is_ours(codec) else codec.encoding.citation
    words = ["normalbench", "code", name, *([] if kind.kind is NORMAL else ["--of", kind.kind.word])]
    words += ["--storage", codec.storage.name, "--to", language]
    words += ["--rounding", rounding_of(codec)] if rounding_of(codec) != "nearest" else []
    return command_line([*words, *(["--prefix", prefix] if prefix else [])])


def verified(code: Code) -> Row:
    """Run a codec's code in one language and return a row: the codec, the language, and how the results compare with
    the catalogue's (see `compared`)."""
    codec = code.codec
    row: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": rounding_of(codec)}

    def agrees() -> Agreement:
        with tempfile.TemporaryDirectory() as folder:
            for name, data in code.files([]).items():
                (Path(folder) / name).write_bytes(data)
            return agreement(codec, code.language, Path(folder) / code.name, code.interface)

    return row | {"language": code.language} | compared(agrees, code.language, ("texels",))
