"""Reading mesh files, and reporting remarks on them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from ....gbuffer.scenes.files.mesh_file import MeshFile
from ....gbuffer.scenes.files.read import read_mesh_file
from ....gbuffer.scenes.files.source import MissingPackageError, SceneFileError
from ...ground.output.errors import MissingError, UsageError, tell

T = TypeVar("T")


def mesh_file(path: Path) -> MeshFile:
    """Read a mesh file. Raises UsageError, or MissingError if a package to unpack the file is not installed."""
    return read_or_refused(lambda: read_mesh_file(path))


def read_or_refused(read: Callable[[], T]) -> T:
    """Return the result of `read`, which reads a mesh file. Raises the same exceptions as `mesh_file`."""
    try:
        return read()
    except MissingPackageError as error:
        raise MissingError(str(error)) from error
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def say_notes(notes: Mapping[Path, Sequence[str]]) -> None:
    """Report the remarks on files on standard error, one line per file. Call this after all files are read, because
    an error must be the only line."""
    for path, lines in notes.items():
        if lines:
            tell(f"{path}: {'; '.join(lines)}")
