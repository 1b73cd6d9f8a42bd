"""Reading of mesh files, and remarks on them."""

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
    """Read a mesh file. Raises UsageError, and MissingError if a package that would unpack it is not installed."""
    return read_or_refused(lambda: read_mesh_file(path))


def read_or_refused(read: Callable[[], T]) -> T:
    """Return the result of `read` for a mesh file. Raises as `mesh_file` does."""
    try:
        return read()
    except MissingPackageError as error:
        raise MissingError(str(error)) from error
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def say_notes(notes: Mapping[Path, Sequence[str]]) -> None:
    """Report remarks on files, a line each, on standard error, once all are read: an error must be the only line."""
    for path, lines in notes.items():
        if lines:
            tell(f"{path}: {'; '.join(lines)}")
