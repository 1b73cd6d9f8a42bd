"""The `doctor FILE` command: reports what is likely wrong with an encoding, and plots its error over the sphere."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.codecs.variants import in_half
from ...encodings.storages.storage import STORAGES, Storage
from ...reports import tables
from ...reports.charts.sphere_chart import sphere_chart
from ..ground.choose import choose_one
from ..ground.machine.systems.people import command_line
from ..ground.options.option import Sources
from ..ground.options.source_options import in_names
from ..ground.output.errors import SeveralEncodersError, UsageError, tell
from ..ground.output.writing import check_plot, save_plot, write_text
from ..ground.user_files import UserFile
from ..keep.row_files import check_rows, write
from ..subjects.codecs.kinds.named import examined_code, kind_of, notes_of
from ..subjects.codecs.kinds.own import OwnKind
from ..subjects.codecs.user_encodings import ANY, Examined, examined
from ..subjects.names.storages import storages_named
from ..subjects.normals.normal_sets import NORMAL_SETS
from ..tables.quality.measure import QualityCase, measure
from ..tables.quality.sphere_maps import sphere_map

STORAGE = "rgba8"
RIGHT = "No problems found."
FOR_PEOPLE = ("table", "markdown")
DOMAINS = ("sphere", "hemisphere", "view")
# Normals that it is compared with the catalogue's on, and by how much it may be worse.
COUNT, WORSE = 1 << 16, 1.05
# What is worse by more is another encoding, of which the findings say why.
ANOTHER = 4.0


def examine_encoding(
    file: Path | None,
    plot: Path | None,
    format: str,
    output: Path | None,
    storage: str | None = None,
    domain: str | None = None,
    diff: Path | None = None,
    report: Path | None = None,
    sources: Mapping[str, Any] = MappingProxyType({}),
) -> int:
    """Write the verdict, findings and notes on a file's encoding, and a plot if one is requested. Examine every file
    of a folder.

    Args:
        storage: the name of the storage to measure in; None for STORAGE.
        domain: the domain that the encoding is meant for, one of DOMAINS; None to detect the domain.
        diff, report: for a folder, the paths of the patch and the page to write; None to write neither.
        sources: options for reading the file; see `Sources`.

    Returns:
        the exit status: 1 if something is likely wrong.

    Raises:
        UsageError: no file is given, the file is not an encoding, a name is unknown, or something cannot be written.
    """
    if file is None:
        raise UsageError("these options of doctor require a file or a folder; name one, such as mine.glsl")
    if file.is_dir():
        if option := next((name for name, value in {"plot": plot, "domain": domain}.items() if value), ""):
            raise UsageError(f"--{option} cannot be used with a folder; name a file in {file}")
        from .folder import examine_folder

        return examine_folder(file, format, output, _storage(storage) if storage else None, diff, report, sources)
    for option, value in {"diff": diff, "report": report}.items():
        if value:
            raise UsageError(f"--{option} requires a folder; name the folder of {file}")
    shader = UserFile(word_of(file, sources))
    check_plot(plot)
    kept = _storage(storage or STORAGE)
    try:
        examination = examined(shader, choose_one("domain", domain, DOMAINS) if domain else ANY)
    except SeveralEncodersError:
        raise
    except UsageError as error:
        # What it is of in place of normals is asked once it is none of these.
        if (kind := kind_of(shader, str(error))) is None:
            raise
        given = {"plot": plot, "storage": storage, "domain": domain}
        if option := next((name for name, value in given.items() if value), ""):
            raise UsageError(f"{shader}: --{option} requires normals; this file encodes {kind.kind.plural}") from None
        return _examine_own(shader, kind, format, output)
    codec = Codec(examination.encoding, kept)
    if storage and codec.misfit:
        raise UsageError(f"{codec.name}: {codec.misfit}")
    is_measured = examination.is_measurable and not codec.misfit
    row = row_of(codec) if is_measured else {}
    worse = _compared(examination, codec, row) if is_measured else []
    rounded = _rounded_for(examination, codec) if worse else ""
    worse = [f"{line}; {rounded}" if rounded else line for line in worse]
    halves = _half_note(codec, row) if is_measured else []
    # What is wasted is meant where the domain is, or where another storage is; it is said all the same.
    is_meant = bool(domain or rounded)
    wrong, notes = (
        ([*examination.wrong], [*worse, *examination.notes])
        if is_meant
        else ([*examination.wrong, *worse], examination.notes)
    )
    failing = [f"{pair} is not a pair: {why}; name it for details" for pair, why in examination.failing.items()]
    wrong, notes = [*wrong, *no_numbers(kept, row), *failing], [*notes, *halves]
    about = {
        "file": shader.path.name,
        "encoding": examination.encoding.name,
        "domain": _domain(examination),
        "functions": examination.functions,
    }
    _write(about, wrong, notes, format, output)
    if plot and examination.is_measurable:
        save_plot(plot, _picture(codec, examination))
        tell(f"plot of the error over the sphere: {plot}")
    return int(bool(wrong))


def _examine_own(file: UserFile, kind: OwnKind, format: str, output: Path | None) -> int:
    """Write the verdict, findings and notes for an encoding of something other than normals. Return the exit status:
    1 if anything is likely wrong."""
    own = examined_code(kind, file)
    command = kind.kind.command.format(command_line([file.plain]))
    about = {"file": file.path.name, "encoding": own.made.name, "domain": kind.kind.plural}
    measures = [] if "broken" in own.found else [f"to measure it, run `{command}`"]
    wrong, notes = own.found.get("wrong", []), [*notes_of(own), *measures]
    _write(about | {"functions": own.made.named}, wrong, notes, format, output)
    return int(bool(wrong))


def _write(about: dict[str, str], wrong: Sequence[str], notes: Sequence[str], format: str, output: Path | None) -> None:
    lines = [*_lines("finding", wrong), *([] if wrong else [(RIGHT, "verdict")]), *_lines("note", notes)]
    if format in FOR_PEOPLE:
        check_rows(output)
        write_text(lambda: _text(about, wrong, notes, format), output, is_checked=True)
    else:
        functions = about.pop("functions")
        rows = [about | {"finding": line, "kind": kind, "functions": functions} for line, kind in lines]
        write(rows, format, output)


def _lines(kind: str, lines: Sequence[str]) -> list[tuple[str, str]]:
    return [(line, kind) for line in lines]


def word_of(file: Path, sources: Mapping[str, Any]) -> str:
    """Return the word for a file on the command line, including the options for reading it; see `Sources`."""
    (word,) = in_names({"encoding": (str(file),), **vars(Sources(**sources))})["encoding"]
    return str(word)


def _text(about: Mapping[str, str], wrong: Sequence[str], notes: Sequence[str], format: str) -> str:
    """Return the report as text: the verdict, a line of facts about the file, the findings and the notes."""
    verdict = f"{len(wrong)} finding{'s' * (len(wrong) > 1)}" if wrong else RIGHT
    parts = [verdict, ", ".join(f"{what} {value}" for what, value in about.items())]
    parts += [bulleted(wrong, format)] if wrong else []
    parts += ["notes:", bulleted(notes, format)] if notes else []
    return "\n\n".join(parts) + "\n"


def bulleted(lines: Sequence[str], format: str) -> str:
    """Return lines as a bulleted list, in Markdown or wrapped to the terminal's width."""
    if format == "markdown":
        return "\n".join(f"- {tables.markdown_sentence(line)}" for line in lines)
    width = shutil.get_terminal_size((120, 40)).columns
    filled = (textwrap.fill(tables.visible(line), width, initial_indent="- ", subsequent_indent="  ") for line in lines)
    return "\n".join(filled)


def _storage(name: str) -> Storage:
    """Return the storage with a name. Raises UsageError if the name does not match exactly one storage."""
    storages = storages_named((name,))
    if len(storages) != 1:
        raise UsageError(f"--storage {name}: doctor measures in one storage; name one")
    return storages[0]


def _domain(examination: Examined) -> str:
    """Return the domain's name for a row, followed by the hemisphere if it is not z >= 0."""
    return examination.domain.name + (f", {examination.domain.text}" if examination.domain.is_turned else "")


def no_numbers(storage: Storage, row: Mapping[str, Any]) -> list[str]:
    """Return a list with one line on the number of rounded codes that decode to NaN or infinity; empty if none do.

    Args:
        row: a row of `quality`."""
    if not row.get("invalid"):
        return []
    share = f"{row['invalid']} of {row['count']} rounded codes ({100 * row['invalid'] / row['count']:.2g}%)"
    remedy = "rounding may move a code out of the range that decode expects; write for example sqrt(max(0.0, ...))"
    return [f"in {storage.name}, {share} decode to NaN or infinity and count as 180° off; {remedy}"]


def _compared(examination: Examined, codec: Codec, row: Mapping[str, Any]) -> list[str]:
    """Return a list with one line on how much worse an encoding is than its version in the catalogue; empty if the
    encoding is as good, has no version there, or is so much worse that it must be a different encoding."""
    if not examination.like:
        return []
    # Codes in [0, 1] fill a storage without a sign, and half of one that has a sign.
    is_half_used = codec.storage.holds_unit
    like = replace(ENCODINGS[examination.like], is_unit=codec.encoding.is_unit and not is_half_used)
    own, its = _means(row), _means(row_of(Codec(like, replace(codec.storage, holds_unit=False))))
    if not WORSE < own[0] / its[0] < ANOTHER:
        return []
    how = f"mean {own[0]:.3g} degrees instead of {its[0]:.3g}, largest {own[1]:.3g} instead of {its[1]:.3g}"
    why = (
        "; codes in [0, 1] use only half of the range; store s = 2 c - 1 and decode (s + 1) / 2" if is_half_used else ""
    )
    percent = 100 * (own[0] / its[0] - 1)
    return [f"in {codec.storage.name} this is {examination.like}, but {percent:.0f}% worse: {how}{why}"]


def _half_note(codec: Codec, row: Mapping[str, Any]) -> list[str]:
    """Return a list with one line on an encoding's errors in half precision, if its file declares half precision;
    otherwise an empty list."""
    if not codec.encoding.is_also_half:
        return []
    half = Codec(in_half(codec.encoding), codec.storage)
    if half.misfit:
        return [f"the file declares 16-bit numbers, but {half.misfit}"]
    in_half_row, own = row_of(half), _means(row)
    if in_half_row["skipped"]:
        return [f"the file declares 16-bit numbers, but is computed in 32 bits: {in_half_row['skipped']}"]
    text = "mean error {:.3g} degrees and largest {:.3g}".format(*_means(in_half_row))
    text += f"; in 32 bits, mean {own[0]:.3g} and largest {own[1]:.3g}"
    return [f"in {codec.storage.name}, with the half precision that the file declares: {text}"]


def _rounded_for(examination: Examined, codec: Codec) -> str:
    """Return text on the steps that the encoder itself rounds to, and on a storage with these steps; empty if the
    encoder does not round, or if the codec's storage already has these steps."""
    lattice, size = examination.lattice, codec.encoding.components
    if lattice is None or lattice.is_of(codec.storage, size):
        return ""
    fitting = [storage for storage in STORAGES.values() if storage.channels >= size and lattice.is_of(storage, size)]
    named = min(fitting, key=lambda candidate: candidate.channels, default=None)
    return f"encode itself rounds to steps of 1/{lattice.steps}" + (f"; try --storage {named.name}" if named else "")


def _means(row: Mapping[str, Any]) -> tuple[float, float]:
    """Return the mean and the largest angle of a row, in degrees."""
    return row["angle_mean_deg"], row["angle_max_deg"]


def row_of(codec: Codec) -> dict[str, Any]:
    """Measure a codec in COUNT directions of its sphere or hemisphere, and return its row of the quality table."""
    chosen = NORMAL_SETS["sphere" if codec.encoding.domain == "sphere" else "hemisphere"](COUNT, 0)
    return measure(QualityCase(codec, chosen, "glsl"))


def _picture(codec: Codec, examination: Examined) -> Any:
    """Return a chart of the mean error over the sphere, with a mark at each direction that does not round-trip;
    without marks for a hemisphere other than z >= 0."""
    name, shown = codec.name, sphere_map(codec).mean_deg
    halves = ("z >= 0, towards the viewer", "z < 0")
    if examination.domain.is_turned:
        return sphere_chart({name: shown}, halves=(examination.domain.text, ""))
    return sphere_chart({name: shown}, {name: np.array(examination.bad).reshape(-1, 3)}, halves)
