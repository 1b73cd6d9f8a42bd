"""The `doctor FOLDER` command: reads each shader file below a folder once, and tabulates the errors of the pairs."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...encodings.codecs.codec import Codec
from ...encodings.codecs.variants import HALF_NAME
from ...encodings.kinds import kind_spoken_of, words_in
from ...encodings.storages.storage import BITS_32, STORAGES, Storage
from ...reports import tables
from ..ground.compilers.lines import without_comments
from ..ground.machine.cores import on_all_cores
from ..ground.machine.systems import forks
from ..ground.machine.systems.people import command_line
from ..ground.options.words import Given
from ..ground.output.errors import MissingError, SeveralEncodersError, UsageError, tell
from ..ground.output.writing import check_page, check_writable, whole_file, write_text
from ..ground.user_files import ENDINGS, OTHER_LANGUAGES, UserFile
from ..keep.row_files import check_rows, write
from ..shaders.languages.pairs import IF_NAMED, IS_OF, NO_PAIR, OF_COLOURS, name_speaks_of_normals, role, stem
from ..subjects.codecs.kinds.named import examined_code
from ..subjects.codecs.kinds.own import OwnKind
from ..subjects.codecs.kinds.table import OWN
from ..subjects.codecs.looked_at import MOST_PAIRS
from ..subjects.codecs.user_encodings import ANY, Examined, OneFunctionError, examined
from ..tables.pick import measure as pick
from ..tables.pick.answer import BEST, answered, largest, mean, places_of
from ..tables.pick.prices import Costs
from ..tables.pick.table import PickOptions
from ..tables.pick.work import questions
from ..tables.quality.packed import best_columns
from ..tables.table import Row
from .examine import COUNT, FOR_PEOPLE, bulleted, no_numbers, row_of, word_of

# Folders that hold no sources of the engine's own.
SKIPPED = frozenset(("node_modules", "build", "bin", "obj", "Intermediate", "Library"))
MOST_FILES = 20_000
# A function where it is defined.
_DEFINED = re.compile(r"(?:\bfn\s+|\b\w[\w<>]*\s+)(\w+)\s*\([^;{}]*\)\s*(?:->\s*[\w<>]+\s*|:\s*\w+\s*)?\{")
# Codes are as good as the best one up to this share of its mean error. Of those that pack themselves the best one is
# found by its error alone.
AS_GOOD, AS_GOOD_PACKED = 1.06, 1.26
FAMILY = "navi21"
BY_DOMAIN: Mapping[str, str | None] = MappingProxyType({"sphere": None, "hemisphere": "tangent", "view": "view"})
# A decoder whose texels a sampler has mixed, and a format of normals that converts colours.
_FILTERED = r"\b{}\s*\(\s*\w+\.Sample(?:Level|Grad|Bias)?\s*\(\s*(\w*(?:linear|aniso)\w*)"
_SRGB = re.compile(r"\b\w*(?:normal|gbuffer)\w*\b[^;\n]*\b(\w*srgb\w*)", re.I)
COLUMNS = (
    "file",
    "functions",
    "domain",
    "storage",
    "mean_deg",
    "largest_deg",
    "slots",
    "best",
    "best_mean_deg",
    "best_slots",
)
# How a patch begins, so that another one may take its place.
PATCH = "Codes of normals by normalbench doctor"


@dataclass
class Pair:
    """An encoder–decoder pair.

    Attributes:
        file: the path relative to the folder; two paths if the functions are in two files.
        word: the pair, as it is named on the command line.
        looked: the result of examining the pair.
        storage: the storage of the pair's codes.
        row: the pair's figures.
        findings: lines on what is likely wrong.
    """

    file: str
    word: str
    looked: Examined
    storage: Storage
    row: Row = field(default_factory=dict)
    findings: list[str] = field(default_factory=list)

    @property
    def functions(self) -> str:
        """Names of the pair's functions, ENCODE:DECODE."""
        return self.looked.functions


@dataclass
class Other:
    """A file with functions that are not measured in the table.

    Attributes:
        file: the path relative to the folder.
        why: the reason why the functions are not measured.
        functions: ENCODE:DECODE, or the name of a function without a partner; None if the file has no pair.
        lone: the encoder or the decoder, if the other function is missing.
        findings: lines on what is likely wrong.
    """

    file: str
    why: str
    functions: str | None = None
    lone: OneFunctionError | None = None
    findings: list[str] = field(default_factory=list)


def examine_folder(
    folder: Path,
    format: str,
    output: Path | None,
    storage: Storage | None = None,
    diff: Path | None = None,
    report: Path | None = None,
    sources: Mapping[str, Any] = MappingProxyType({}),
) -> int:
    """Write the table of a folder's pairs, followed by likely problems.

    Args:
        storage: the storage of every pair; None for the storage that each pair implies.
        diff: a file for a patch that replaces worse encodings with the catalogue's best; None for no patch.
        report: the path of a page to write; None for no page.
        sources: options for reading files; see `Sources`.

    Returns:
        the exit status: 1 if a problem is found.

    Raises:
        UsageError: the folder has no pair, or something cannot be written.
    """
    check_page(report)
    if diff:
        check_writable(diff, mark=PATCH.encode())
    files = list(files_below(folder))
    candidates = [path for path in files if may_hold_a_pair(path)]
    if not candidates:
        raise UsageError(f"{folder}: none of its {len(files)} shader files defines a function that encodes or decodes")
    look = partial(_looked, folder, storage)
    looks = on_all_cores(look, [word_of(path, sources) for path in candidates], forks.stop)
    everything = [each for several in looks for each in several]
    others = [each for each in everything if isinstance(each, Other)]
    pairs = [each for each in everything if isinstance(each, Pair)]
    pairs += _across_files(folder, storage, others, pairs)
    for pair in pairs:
        pair.findings += _of_target(folder / pair.file, pair.functions)
    _measure([pair for pair in pairs if pair.looked.is_measurable])
    others = [each for each in others if each.why or each.findings]
    patch = _patch(folder, pairs) if diff or report else ""
    told = Told(folder, len(files), [*pairs, *others])
    _write(told, format, output)
    if diff:
        _save(diff, patch)
        tell(f"patch: {diff}; not applied" if "@@" in patch else f"{diff} is empty: nothing to change")
    if report:
        from ...reports.page.folder import folder_html

        _save(report, folder_html(str(folder), told.lead, told.measured, told.lines, patch))
        tell(f"page: {report}")
    return int(any(each.findings for each in (*pairs, *others)))


def _patch(folder: Path, pairs: Sequence[Pair]) -> str:
    from .patch import patch_of

    return patch_of(folder, pairs)


def _save(path: Path, text: str) -> None:
    with whole_file(path) as partial_file:
        partial_file.write_text(text, encoding="utf-8", newline="")


def files_below(folder: Path) -> Iterator[Path]:
    """Yield the shader files below a folder in order, leaving out hidden folders, build folders and third-party
    packages.

    Raises:
        UsageError: there are too many files.
    """
    count, seen = 0, set[Path]()
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        is_left_out = any(part in SKIPPED or part.startswith(".") for part in parts)
        is_shader = path.suffix.lower() in (*ENDINGS, *OTHER_LANGUAGES) and path.is_file()
        if is_shader and not is_left_out and path.resolve() not in seen:
            seen.add(path.resolve())
            count += 1
            if count > MOST_FILES:
                raise UsageError(f"{folder}: more than {MOST_FILES} shader files; name a subfolder")
            yield path


def may_hold_a_pair(path: Path) -> bool:
    """Whether a file defines a function that is named like an encoder or a decoder, or cannot be read as text."""
    return any(map(role, _DEFINED.findall(_text(path)))) or not _is_text(path)


def _is_text(path: Path) -> bool:
    try:
        return b"\0" not in path.read_bytes().decode("utf-8").encode()
    except (OSError, ValueError):
        return False


def _text(path: Path) -> str:
    try:
        return without_comments(path.read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return ""


def _looked(folder: Path, storage: Storage | None, word: str) -> list[Pair | Other]:
    """Return a file's entries: its pairs for normals, and pairs of other kinds, which are recognised by function
    names."""
    shader = UserFile(word)
    file = shader.path.relative_to(folder).as_posix()
    others = [_of_kind(file, shader, kind) for kind in _kinds_by_names(shader.path)]
    normals = _of_normals(folder, storage, word)
    # That a file is of another kind is said by these.
    is_of_other = len(normals) == 1 and isinstance(normals[0], Other) and IS_OF in normals[0].why
    return [*([] if others and is_of_other else normals), *others]


def _of_normals(folder: Path, storage: Storage | None, word: str) -> list[Pair | Other]:
    """Return the pairs for normals in a file, or an `Other` with the reason if the file has no pair; empty if the
    file only seemed to have a pair."""
    path = UserFile(word).path
    file = path.relative_to(folder).as_posix()
    try:
        pair = _pair(file, word, storage)
        broken = _of_pairs(folder, storage, word, [*pair.looked.failing])
        return [pair, *broken, *(Other(file, note) for note in pair.looked.notes if note.endswith(IF_NAMED))]
    except SeveralEncodersError as error:
        return _of_pairs(folder, storage, word, [*error.pairs, *error.failing])
    except OneFunctionError as error:
        is_of_colours = OF_COLOURS & words_in(error.function) and not name_speaks_of_normals(error.function)
        return [] if is_of_colours else [Other(file, _without(path, error), error.function, error)]
    except (UsageError, MissingError) as error:
        return [] if NO_PAIR in str(error) and not _names_a_pair(path) else [Other(file, _without(path, error))]


def _names_a_pair(path: Path) -> bool:
    """Whether a file has two functions whose names identify them as an encoder of normals and its decoder."""
    names = [name for name in _DEFINED.findall(_text(path)) if role(name) and name_speaks_of_normals(name)]
    roles = {name: role(name) for name in names}
    return any(roles[name] != roles[other] and stem(name) == stem(other) for name in names for other in names)


def _of_pairs(folder: Path, storage: Storage | None, word: str, pairs: Sequence[str]) -> list[Pair | Other]:
    """Return the entries for pairs in a file, each given as ENCODE:DECODE; pairs after the first MOST_PAIRS are not
    measured."""
    words = [UserFile(word).with_pair(pair).word for pair in pairs]
    measured = (each for pair in words[:MOST_PAIRS] for each in _of_normals(folder, storage, pair))
    file = UserFile(word).path.relative_to(folder).as_posix()
    return [*measured, *(Other(file, IF_NAMED, pair) for pair in pairs[MOST_PAIRS:])]


def _without(path: Path, error: Exception) -> str:
    return str(error).removeprefix(f"{path}: ")


def _kinds_by_names(path: Path) -> Iterator[OwnKind]:
    """Yield the kinds, other than normals, for which a file has an encoder and a decoder, judging by their names."""
    names = [name for name in _DEFINED.findall(_text(path)) if role(name)]
    for kind, own in OWN.items():
        if len({role(name) for name in names if kind_spoken_of(name) is kind and not name_speaks_of_normals(name)}) > 1:
            yield own


def _of_kind(file: str, shader: UserFile, kind: OwnKind) -> Other:
    """Return the entry for an encoding of something other than normals, with the command that measures it."""
    try:
        own = examined_code(kind, shader)
    except (UsageError, MissingError) as error:
        return Other(file, _without(shader.path, error))
    why = f"encodes {kind.kind.plural}; to measure it, run `{kind.kind.command.format(command_line([shader.plain]))}`"
    return Other(file, why, own.made.named, findings=own.found.get("wrong", []))


def _pair(file: str, word: str, storage: Storage | None) -> Pair:
    looked = examined(UserFile(word), ANY)
    # Two files may have codes of one name.
    named = replace(looked.encoding, name=f"{file}:{looked.functions}", functions=looked.encoding.prefix)
    looked = looked._replace(encoding=named)
    return Pair(file, word, looked, storage or implied_storage(looked), findings=list(looked.wrong))


def implied_storage(looked: Examined) -> Storage:
    """Return the storage that an encoding implies: 32 bits if the encoding is packed, else the storage with the steps
    that the encoder rounds to, else 8 bits per number."""
    encoding, lattice = looked.encoding, looked.lattice
    if encoding.is_packed:
        return BITS_32
    size = encoding.components
    fitting = [each for each in STORAGES.values() if lattice and each.channels >= size and lattice.is_of(each, size)]
    if fitting:
        return min(fitting, key=lambda each: each.channels)
    sign = "" if encoding.is_unit or lattice else "_snorm"
    return STORAGES[("rg8" if size == 2 else "rgba8") + sign]


def _across_files(
    folder: Path, storage: Storage | None, others: Sequence[Other], pairs: Sequence[Pair]
) -> Iterator[Pair]:
    """Yield pairs with the encoder in one file and the decoder in another, matched by name. Add a finding to a
    decoder that does not undo its encoder, or that reads a different encoding from the one that its namesake
    writes."""
    lone = [(each, each.lone) for each in others if each.lone]
    for other, reader in ((other, candidate) for other, candidate in lone if candidate.side == "decode"):
        writers = [
            each for each in lone if each[1].side == "encode" and stem(each[1].function) == stem(reader.function)
        ]
        if not writers:
            other.findings += _disagreements(reader, pairs)
            continue
        # Of several the one whose folder is nearest, and no other if one lies in the same folder.
        writer, wrote = max(writers, key=lambda each: _shared_folders(each[0].file, other.file))
        word = f"{folder / writer.file}:{wrote.function},{folder / other.file}:{reader.function}"
        try:
            yield _pair(f"{writer.file}, {other.file}", word, storage)
            writer.why = other.why = ""
        except (UsageError, MissingError) as error:
            other.findings.append(f"{reader.function} does not invert {wrote.function} in {writer.file}: {error}")


def _shared_folders(file: str, other: str) -> int:
    """Return the number of folders that two files have in common."""
    return len(Path(os.path.commonpath([f"/{file}", f"/{other}"])).parts)


def _disagreements(reader: OneFunctionError, pairs: Sequence[Pair]) -> Iterator[str]:
    for pair in pairs:
        writes, wrote = pair.functions.partition(":")[0], pair.looked.like
        if stem(writes) == stem(reader.function) and wrote and reader.like and wrote not in reader.like:
            yield f"{reader.function} decodes {reader.like[0]}, but {writes} in {pair.file} encodes {wrote}"


def _of_target(path: Path, functions: str) -> Iterator[str]:
    """Yield likely problems with how a file itself reads and stores its texels: filtering and sRGB formats."""
    text, decode = _text(path), functions.rpartition(":")[2].partition("(")[0]
    if match := re.search(_FILTERED.format(re.escape(decode)), text, re.I):
        line = text.count("\n", 0, match.start()) + 1
        yield f"line {line}: {match[1]} filters codes before {decode}, giving wrong normals at seams; load texels"
    if match := _SRGB.search(text):
        line = text.count("\n", 0, match.start()) + 1
        yield f"line {line}: {match[1]} is used for normals; sRGB formats change codes when they are written and read"


def _measure(pairs: Sequence[Pair]) -> None:
    """Fill in each pair's row: its errors, its cost and the catalogue's best encoding in the same storage. Add
    findings to pairs that do not fit their storage or decode to NaN."""
    by_question: dict[tuple[str, str], list[Pair]] = {}
    for pair in pairs:
        codec = Codec(pair.looked.encoding, pair.storage)
        if codec.misfit:
            pair.findings.append(f"does not fit {pair.storage.name}: {codec.misfit}")
        elif codec.encoding.is_packed:
            pair.row = _packed_figures(codec)
        else:
            by_question.setdefault((pair.storage.name, codec.encoding.domain), []).append(pair)
    for (storage, domain), asked in by_question.items():
        rows = _picked(storage, BY_DOMAIN[domain], asked)
        best = next((row for row in rows if BEST in places_of(row)), None)
        by_name = {row["encoding"].removesuffix(HALF_NAME): row for row in rows if row["storage"] == storage}
        for pair in asked:
            row = by_name[pair.looked.encoding.name]
            pair.row = _figures(row, best)
            pair.findings += no_numbers(pair.storage, row)


def _picked(storage: str, domain: str | None, pairs: Sequence[Pair]) -> list[Row]:
    """Return the rows of `pick` for a storage, ranked by angle only, with the catalogue's encodings and `pairs`."""
    encodings = (pair.looked.encoding for pair in pairs)
    against = tuple(Given(encoding.name, encoding) for encoding in encodings)
    (cases,) = questions(PickOptions(storage=(storage,), against=against, domain=domain, count=COUNT))
    (rows,) = pick.rows([cases], None, None, lambda _: None)
    return answered(rows)


def _packed_figures(codec: Codec) -> Row:
    row, slots = row_of(codec) | best_columns(codec), Costs([codec], (FAMILY,)).of(codec).get("slots_once")
    figures = {"mean_deg": row["angle_mean_deg"], "largest_deg": row["angle_max_deg"], "slots": slots}
    if row["best_codec"] is None or row["angle_mean_deg"] <= AS_GOOD_PACKED * row["best_mean_deg"]:
        return figures | {"best": "as good"}
    return figures | {"best": row["best_codec"], "best_mean_deg": row["best_mean_deg"]}


def _figures(row: Row, best: Row | None) -> Row:
    error, least = mean(row), mean(best) if best else None
    figures = {"mean_deg": error, "largest_deg": largest(row), "slots": row["slots_once"]}
    if best is None or error is None or least is None:
        return figures
    if best["encoding"] == row["encoding"] or error <= AS_GOOD * least:
        return figures | {"best": "as good"}
    name = best["encoding"] if best["storage"] == row["storage"] else f"{best['encoding']} in {best['storage']}"
    return figures | {"best": name, "best_mean_deg": least, "best_slots": best["slots_once"]}


class Told:
    """The report on a folder's pairs.

    Attributes:
        rows: one row for each pair, and one for each file that seems to have a pair but does not.
        measured: the rows of the measured pairs, with the columns that people read.
        lines: likely problems, and the reasons why other pairs were not measured.
        lead: the counts, in a sentence.
    """

    def __init__(self, folder: Path, files: int, all_told: Sequence[Pair | Other]):
        self.rows = [_row(each) for each in all_told]
        shown = [row for row in self.rows if row["mean_deg"] is not None]
        self.measured = [{name: row[name] for name in (*COLUMNS, "findings")} for row in shown]
        named = ((f"{row['file']} {row['functions'] or ''}".rstrip(), row["says"]) for row in self.rows)
        self.lines = [f"{name}: {says}" for name, says in named if says]
        wrong = sum(bool(each.findings) for each in all_told)
        better = sum(row["best_mean_deg"] is not None for row in shown)
        count = f"{len(shown)} pair{'s' * (len(shown) != 1)} in {files} shader file{'s' * (files != 1)}"
        self.lead = f"{count} of {folder.resolve().name or folder}: {wrong or 'none'} with findings, "
        self.lead += f"{better or 'none'} with a better encoding of the same bit count."


def _row(told: Pair | Other) -> Row:
    of_pair = {} if isinstance(told, Other) else {"domain": told.looked.domain.name, "storage": told.storage.name}
    figures, whys = ({}, [told.why]) if isinstance(told, Other) else (told.row | of_pair, [])
    row = {"file": told.file, "functions": told.functions}
    row |= {name: figures.get(name) for name in COLUMNS[2:]}
    return row | {"findings": len(told.findings), "says": "; ".join([*told.findings, *whys]) or None}


def _write(told: Told, format: str, output: Path | None) -> None:
    if format not in FOR_PEOPLE:
        write(told.rows, format, output)
        return
    check_rows(output)

    def text() -> str:
        width = shutil.get_terminal_size((120, 40)).columns
        table = [tables.written(told.measured, format, width, total=" ").rstrip()] if told.measured else []
        return "\n\n".join([told.lead, *table, *([bulleted(told.lines, format)] if told.lines else [])]) + "\n"

    write_text(text, output, is_checked=True)
