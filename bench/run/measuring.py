"""From options to finished rows: which steps are requested, which are already stored, and which are measured now."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from typing import Any, Protocol

from ...encodings.codecs.files import parsed_json
from ..ground.machine.lost import require_living_device
from ..ground.machine.memory import require_memory
from ..ground.machine.settings import settings
from ..ground.options.option import Reading, fields_of
from ..ground.options.words import words_in
from ..ground.output.errors import UsageError
from ..ground.output.progress import progress
from ..ground.output.writing import is_special, target_of
from ..ground.user_files import UserFile, file_of, names_an_encoder, parts_of
from ..keep.journal import Journal, journal
from ..keep.plain import key_text, plain
from ..tables.table import Measured, Role, Row, Step, Table, Tick
from . import durations

# Beside a file of one of these, files that it refers to are read too.
COMPANIONS = {".gltf": ("*.bin",), ".obj": ("*.mtl",)}


@dataclass(frozen=True)
class Asked:
    """A checked request for steps of a table, before anything is measured.

    Attributes:
        others: other sets of options, whose steps are included in `steps`.
    """

    table: Table
    options: Any
    outputs: Any
    steps: Sequence[Step]
    others: Sequence[Any] = ()


class Kept(Protocol):
    """A store of measured rows, to which new rows are added."""

    def find(self, table: str, step: Step) -> list[Row] | None:
        """Return the stored rows of a step; None if it has not been stored."""
        ...

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:
        """Store the rows of a step, and return them as they are read back. Raises UsageError."""
        ...


class Place(Protocol):
    """A place where steps are measured."""

    def measure(self, ask: Asked, steps: Sequence[Step], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        """Yield each step with its rows, in the order in which steps are completed.

        Args:
            steps: the steps of `ask` to measure.
            tick: called once for each part of a step that is done.
        """
        ...


class Here:
    """Measurement in this process, in the order of the steps."""

    def measure(self, ask: Asked, steps: Sequence[Step], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        """Yield each step with its rows, measured in this process. Raises MissingError if the OpenGL device was lost;
        the rows of that step are discarded."""
        settings_text = ", ".join(f"{name}={value}" for name, value in settings().items())
        for step, rows in zip(steps, ask.table.work.measure(steps, tick), strict=True):
            require_living_device()
            yield step, [_with_settings(ask.table, row, settings_text) for row in rows]


def _with_settings(table: Table, row: Row, settings_text: str) -> Row:
    """Return a row whose device includes the settings from the environment, if there are any. If the device
    identifies the row, it belongs to another machine and is not changed."""
    return (
        row | {"device": f"{row['device']}, {settings_text}"}
        if settings_text and row.get("device") and table.column("device") not in table.of_role(Role.KEY)
        else row
    )


HERE = Here()


class Nothing:
    """A store that keeps no rows: every step is measured again."""

    def find(self, table: str, step: Step) -> list[Row] | None:  # noqa: ARG002 # as of every Kept
        return None

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:  # noqa: ARG002
        return list(rows)


def asked(table: Table, options: Any, outputs: Any = None) -> Asked:
    """Return an `Asked` with the steps that a table's options and outputs require.

    Raises:
        UsageError: an option is invalid.
        MissingError: this machine lacks what the table needs.
    """
    require_memory()
    outputs = table.outputs() if outputs is None else outputs
    steps = table.work.steps(options, outputs)
    if isinstance(options, Reading):
        # It imports JAX, which tables that read normals have imported by now.
        from ..subjects.normals.normal_names import say_count_is_unused

        say_count_is_unused(options)
    # Files are fingerprinted once they were read, which refuses what is too large.
    fingerprints = files_of(options)
    return Asked(table, options, outputs, [_with_files(step, fingerprints) for step in steps])


def asked_together(table: Table, several: Sequence[Any], outputs: Any) -> Asked:
    """Return an `Asked` with the steps that several sets of options require, without duplicates. Raises UsageError
    and MissingError."""
    asks = [asked(table, options, outputs) for options in several]
    steps = {repr(step.key): step for ask in asks for step in ask.steps}
    return replace(asks[0], steps=list(steps.values()), others=[ask.options for ask in asks[1:]])


def _with_files(step: Step, fingerprints: Row) -> Step:
    return replace(step, key=step.key | fingerprints, parts=[_with_files(part, fingerprints) for part in step.parts])


def measured(ask: Asked, kept: Kept, place: Place = HERE) -> Measured:
    """Return the finished rows: stored rows, and rows that are measured now and stored as they arrive."""
    step_rows = _measured_steps(ask, kept, place)
    rows = ask.table.work.finish([row for rows in step_rows for row in rows])
    return Measured(ask.options, ask.outputs, ask.steps, rows, step_rows)


def _measured_steps(ask: Asked, kept: Kept, place: Place) -> list[list[Row]]:
    """Measure and store the steps that are not stored yet, and return the unfinished rows of each step."""
    name = ask.table.name
    rows_by_id = {id(step): kept.find(name, step) for step in ask.steps}
    absent = [step for step in ask.steps if rows_by_id[id(step)] is None]
    rows_by_id |= {id(part): kept.find(name, part) for step in absent for part in step.parts}
    missing = [part for part in _in_parts(absent) if rows_by_id.get(id(part)) is None]
    there = sum(step.ticks for step in ask.steps if rows_by_id[id(step)] is not None)
    ticks, begun = sum(step.ticks for step in missing), time.monotonic()
    with progress(ticks, name, there) as tick:
        for step, rows in place.measure(ask, missing, tick):
            rows_by_id[id(step)] = kept.keep(name, step, rows)
    durations.keep(ask, ticks, time.monotonic() - begun)
    for step in absent:
        if step.parts:
            rows = [row for part in step.parts for row in rows_by_id[id(part)] or []]
            rows_by_id[id(step)] = kept.keep(name, step, ask.table.work.merge(step, rows))
    return [rows_by_id[id(step)] or [] for step in ask.steps]


def _in_parts(steps: Sequence[Step]) -> Iterator[Step]:
    """Yield the steps to measure: steps without parts, then the first part of every other step, then the second
    parts, and so on, because data made for one part may serve several steps."""
    yield from (step for step in steps if not step.parts)
    for several in zip_longest(*(step.parts for step in steps)):
        yield from filter(None, several)


def with_parts(steps: Iterable[Step]) -> Iterator[Step]:
    """Yield each step, and then its parts."""
    for step in steps:
        yield from (step, *step.parts)


def files_of(options: Any) -> Row:
    """Return {"files": [...]} with a fingerprint for each file that options name, which covers the files read with
    it. If options change how captures are read, return {"read": {...}} as well. Return {} if no file is named."""
    words = {part for words in words_of(options).values() for word in words for part in parts_of(word)}
    digests = sorted(filter(None, map(_fingerprint, words)))
    reading = fields_of(Reading).values() if isinstance(options, Reading) else ()
    values = {field: getattr(options, field.name) for field in reading if not field.option.files}
    overrides = {field.name: value for field, value in values.items() if value != field.default}
    return ({"files": digests} | ({"read": overrides} if overrides else {})) if digests else {}


def words_of(options: Any) -> dict[str, list[str]]:
    """Return the words that may name files, by option, for all options that take files."""
    known = fields_of(type(options))
    values = {name: getattr(options, name) or () for name, field in known.items() if field.option.files}
    return {name: [word for word in words_in(value) if isinstance(word, str)] for name, value in values.items()}


def _fingerprint(word: str) -> str:
    """Return a hash of a file, its companions and how it is read, wherever they are; empty if reading fails."""
    path, shader = file_of(word), UserFile(word)
    try:
        if not path.is_file():
            return ""
        # In an order that does not depend on where they lie.
        digests = [file_digest(path), *sorted(map(file_digest, companions(word)))]
        settings = shader.settings
        roots = [name for name, _ in settings.roots]
        how = (shader.functions, settings.defines, settings.language, settings.format, roots)
        return hashlib.sha256(b"".join(digests) + repr(how).encode()).hexdigest()[:16]
    except (OSError, ValueError):
        return ""


def companions(word: str | Path) -> list[Path]:
    """Return, sorted, the files that are read together with the file that a word names: parts of a scene or a frame,
    a layout's files, and an encoder's twin and included files."""
    path = file_of(str(word))
    patterns = COMPANIONS.get(path.suffix.lower(), ())
    beside = {other for pattern in patterns for other in path.parent.glob(pattern)}
    if path.suffix.lower() == ".gltf":
        beside |= set(_parts_of_gltf(path))
    if path.suffix.lower() == ".json":
        beside |= set(_files_of_frame(path))
    if path.suffix.lower() == ".toml":
        beside |= set(_files_of_layout(path))
    if names_an_encoder(str(word)):
        beside |= {other for other in (UserFile(str(word)).twin, *_included(word)) if other.is_file()}
    return sorted(beside)


def _parts_of_gltf(path: Path) -> list[Path]:
    """Return the files of a glTF file's buffers and images; empty if it cannot be read."""
    # It imports NumPy, which start-up does without.
    from ...gbuffer.scenes.files.source import checked_address

    try:
        document = parsed_json(path.read_bytes())
        parts = [part for key in ("buffers", "images") for part in document.get(key, ())]
        named = [checked_address(path, part["uri"], "its parts") for part in parts if "uri" in part]
    except (ValueError, TypeError, AttributeError, KeyError):
        return []
    return [path.parent / os.path.relpath(file, path.parent.resolve()) for file in named if file and file.is_file()]


def _files_of_frame(path: Path) -> list[Path]:
    """Return the images that the description of a captured frame names."""
    # It imports JAX, which start-up does without.
    from ..subjects.scenes.frame_file import files_of_frame

    return files_of_frame(path)


def _files_of_layout(path: Path) -> list[Path]:
    """Return the encoder or the table that a layout names, and the files that are read with it."""
    # It imports JAX, which start-up does without.
    from ..subjects.codecs.layout_names import files_of_layout

    return [source for file in files_of_layout(path) for source in (file, *companions(file))]


def _included(word: str | Path) -> list[Path]:
    """Return the files that a user's encoder includes; empty if it cannot be read."""
    try:
        from ..shaders.languages.source import Source

        return list(Source(UserFile(str(word))).files.values())
    except UsageError:
        return []


def file_digest(path: Path) -> bytes:
    """Return the SHA-256 of a file's content, 32 bytes. Raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").digest()


class Beside:
    """Rows kept in a journal next to an output file."""

    def __init__(self, kept: Journal):
        self.path, self._journal = kept.path, kept
        self._rows = {line["step"]: line["rows"] for line in _checked(kept)}

    def __len__(self) -> int:
        return len(self._rows)

    def find(self, table: str, step: Step) -> list[Row] | None:
        return self._rows.get(key_text(table, step.key))

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:
        text, kept = key_text(table, step.key), plain(rows)
        self._journal.add({"step": text, "rows": kept})
        self._rows[text] = kept
        return kept


def _checked(kept: Journal) -> list[Row]:
    """Return the lines of a journal after the first. Raises UsageError if a line is not a step."""
    if lines := kept.lines[1:]:
        from ..keep.schema import check_kept

        for number, line in enumerate(lines, 2):
            check_kept(line, f"{kept.path}, line {number}")
    return lines


@contextmanager
def beside(output: Path | None, work: Row) -> Iterator[Beside | None]:
    """Yield a store that keeps rows next to an output file, and delete it when the block ends without an error. Yield
    None if the output is not an ordinary file.

    Args:
        work: sources and machine; stored rows must match them.

    Raises:
        UsageError: another process is writing the same output, the rows cannot be written, or stored rows are from
            different work.
    """
    if output is None or is_special(output):
        yield None
        return
    output = target_of(output)
    with journal(output.with_name(f".{output.name}.rows")) as kept:
        header = {"work": plain([work])[0]}
        if not kept.lines:
            kept.add(header)
        elif kept.lines[0] != header:
            raise UsageError(f"{kept.path} has rows from another version or machine; delete it, or name another file")
        yield Beside(kept)
        kept.remove()
