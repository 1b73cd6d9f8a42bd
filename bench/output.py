"""Writing what was measured: whole or not at all, and one line when it cannot be."""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..reports import tables
from .errors import UsageError


def check_writable(path: Path) -> None:
    """Raises UsageError where a file of this name cannot be written; asked before anything is measured."""
    if path.is_dir():
        raise UsageError(f"{path} is a folder; name a file")
    check_folder(path.parent)


def check_folder(folder: Path) -> None:
    """Raises UsageError where no file can be made in a folder; the folder itself is made, with its parents."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise UsageError(f"cannot write to {folder}: {error.strerror or error}") from error


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A name to write to that becomes `path` when all is well and vanishes otherwise."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        yield partial
        partial.replace(path)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """A folder to fill that becomes `folder` when all is well and vanishes otherwise.

    Raises:
        UsageError: `folder` exists already, or cannot be written.
    """
    if folder.exists():
        raise UsageError(f"{folder} exists already; name a folder that does not")
    check_folder(folder.parent)
    partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", suffix=".partial", dir=folder.parent))
    try:
        yield partial
        partial.chmod(0o755)
        partial.replace(folder)
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror or error}") from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def write(rows: Sequence[dict[str, Any]], format: str, output: Path | None, expendable: Sequence[str] = ()) -> None:
    """Rows to a file, or to standard output; a table that does not fit the terminal spares `expendable` columns."""
    if output is None:
        width = shutil.get_terminal_size((120, 40)).columns
        sys.stdout.write(tables.written(rows, format, width, expendable))
        sys.stdout.flush()
        return
    check_writable(output)
    with whole_file(output) as partial:
        partial.write_text(tables.written(rows, format), encoding="utf-8")
