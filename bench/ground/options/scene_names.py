"""Specular powers and mesh files as they are named, and what is said of files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from ....gbuffer.scenes.files.mesh_file import MeshFile
from ....gbuffer.scenes.files.read import read_mesh_file
from ....gbuffer.scenes.files.source import MissingPackageError, SceneFileError
from ..output.errors import MissingError, UsageError, tell

T = TypeVar("T")
MAX_POWER = 2048


def powers_named(numbers: str) -> list[float]:
    """The specular powers of comma-separated numbers. Raises UsageError for what is not one of 1 to 2048."""
    made = []
    for word in map(str.strip, numbers.split(",")):
        try:
            power = float(word)
        except ValueError:
            power = 0.0
        if not 1 <= power <= MAX_POWER:
            raise UsageError(f"--power {word}: a specular power is 1 to {MAX_POWER}, such as 47,1024")
        made.append(power)
    return list(dict.fromkeys(made))


def mesh_file(path: Path) -> MeshFile:
    """A mesh file. Raises UsageError, and MissingError where a package that would unpack it is not installed."""
    return read_or_refused(lambda: read_mesh_file(path))


def read_or_refused(read: Callable[[], T]) -> T:
    """What is read of a mesh file. Raises as `mesh_file` does."""
    try:
        return read()
    except MissingPackageError as error:
        raise MissingError(str(error)) from error
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def say_notes(notes: Mapping[Path, Sequence[str]]) -> None:
    """What is to be said of files, a line each, on standard error; once all are read, as an error is one line alone."""
    for path, said in notes.items():
        if said:
            tell(f"{path}: {'; '.join(said)}")
