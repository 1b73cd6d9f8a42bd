"""Scenes as they are named: those there are, and users' mesh files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from ....encodings.codecs.files import called
from ....gbuffer.scenes.catalogue import SCENES, SceneMaker
from ....gbuffer.scenes.files.mesh_file import MeshFile
from ....gbuffer.scenes.files.read import FRAMES, READERS, file_scene, read_mesh_file
from ....gbuffer.scenes.files.source import MissingPackageError, SceneFileError
from ..choose import choose_or_read
from ..output.errors import MissingError, UsageError, tell

T = TypeVar("T")
MAX_POWER = 2048


def scene_makers_named(names: str) -> list[SceneMaker]:
    """The scenes that comma-separated names stand for: those of the catalogue, or mesh files.

    Raises:
        UsageError: an unknown name, or a file that cannot be read.
    """
    notes: dict[Path, Sequence[str]] = {}

    def scene_of(path: Path) -> SceneMaker:
        file = mesh_file(path)
        notes[path] = file.notes
        name = called(path.name)
        make = partial(file_scene, file)
        return SceneMaker(name, f"the meshes of {name}", make, FRAMES, None, file.is_metal_rough)

    made = choose_or_read("scene", names, SCENES, READERS, scene_of)
    say_notes(notes)
    return made


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
