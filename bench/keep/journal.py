"""JSON Lines files that are written to disk line by line, so that a stopped command can continue."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import FileIO
from pathlib import Path
from typing import Any

from ...encodings.codecs.files import file_bytes
from ..ground.machine.systems.locks import lock, put_in_place, remove
from ..ground.output.errors import UsageError
from ..ground.output.writing import clear_away, partial_of

Line = dict[str, Any]
# Of a journal, in bytes; the largest runs have some megabytes.
MOST = 1 << 30


class Journal:
    """A JSON Lines file that is locked for this process; created by `journal`.

    Attributes:
        path: the file.
        lines: all complete lines of the file, parsed.
    """

    def __init__(self, path: Path, file: FileIO):
        self.path, self._file = path, file
        file.seek(0)
        content = file.read()
        # A line that was cut off in the middle would swallow the next one.
        file.truncate(content.rfind(b"\n") + 1)
        self.lines = _whole_lines(path, content)

    def add(self, line: Line) -> None:
        """Write a line to disk immediately, so that a crash can only cut off its end.

        Raises:
            UsageError: the line cannot be written; earlier lines are kept.
        """
        start, rest = self._file.seek(0, os.SEEK_END), json.dumps(line).encode() + b"\n"
        try:
            if not os.fstat(self._file.fileno()).st_nlink:
                raise OSError(errno.ENOENT, "the file was deleted meanwhile")
            while rest:
                rest = rest[self._file.write(rest) :]
            os.fsync(self._file.fileno())
        except OSError as error:
            os.truncate(self._file.fileno(), start)
            kept = f"{len(self.lines)} finished steps are kept"
            raise UsageError(f"cannot write {self.path}: {error.strerror or error}; {kept}") from error
        self.lines.append(line)

    def replace(self, lines: Sequence[Line]) -> None:
        """Replace all lines with the given lines, or none if writing fails. Raises UsageError."""
        data = data_of(lines)
        partial, file = partial_of(self.path), None
        try:
            clear_away(self.path)
            file = partial.open("w+b", buffering=0)
            # Another process must not take the new file for one that nobody writes.
            lock(file)
            while data:
                data = data[file.write(data) :]
            os.fsync(file.fileno())
            self._file = put_in_place(self.path, self._file, partial, file)
        except OSError as error:
            if file:
                file.close()
            raise UsageError(f"cannot write {self.path}: {error.strerror or error}") from error
        finally:
            partial.unlink(missing_ok=True)
        self.lines = list(lines)

    def remove(self) -> None:
        """Delete the file. Raises OSError."""
        remove(self.path, self._file)

    def close(self) -> None:
        """Close the file, so that other processes may write to it."""
        self._file.close()


def data_of(lines: Sequence[Line]) -> bytes:
    """Return lines as the bytes of a journal: JSON, each on a line of its own."""
    return b"".join(json.dumps(line).encode() + b"\n" for line in lines)


@contextmanager
def journal(path: Path) -> Iterator[Journal]:
    """Yield the journal in a file, which is created if it is missing.

    Raises:
        UsageError: another process is writing to the file, or the file cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("a+b", buffering=0)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from error
    with file:
        try:
            lock(file)
        except OSError as error:
            raise UsageError(f"another process is writing {path}; wait for it, or name another place") from error
        kept = Journal(path, file)
        try:
            yield kept
        finally:
            kept.close()


def read_lines(path: Path, known: dict[bytes, Line] | None = None) -> list[Line]:
    """Return the complete lines of a journal, without writing to it; a missing file has no lines. Raises UsageError.

    Args:
        known: lines that were parsed before, by their bytes. They are returned as the same objects; new lines are
            added to the dictionary.
    """
    try:
        content = file_bytes(path, MOST) if path.exists() else b""
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error}") from error
    return _whole_lines(path, content, known)


def _whole_lines(path: Path, content: bytes, known: dict[bytes, Line] | None = None) -> list[Line]:
    """Return the complete lines of a journal's content, parsed. The last line is left out if it was cut off because a
    process was killed."""
    whole = content[: content.rfind(b"\n") + 1].split(b"\n")[:-1]
    # An editor may leave an empty line.
    numbered = [(f"{path}, line {number}", line) for number, line in enumerate(whole, 1) if line.strip()]
    if known is None:
        return [_parsed_line(place, line) for place, line in numbered]
    return [known.get(line) or known.setdefault(line, _parsed_line(place, line)) for place, line in numbered]


def _parsed_line(place: str, line: bytes) -> Line:
    try:
        record = json.loads(line)
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict):
        raise UsageError(f"{place} is damaged: not a JSON object; delete this line to measure it again")
    return record
