"""STL files, binary or text, in one grey material seen from both sides."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .mesh_file import MeshFile, Stored, mesh_of, of_one_mesh
from .source import MAX_TEXT_BYTES, SceneFileError, checked_size, file_bytes

# Of a binary file: 80 bytes of anything, how many facets there are, and the facets.
COUNT_AT, HEAD = 80, 84
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
THREE = r"((?:\s++\S++){3})"
CORNER = rf"\s++vertex{THREE}"
TEXT_FACET = re.compile(
    rf"\s*+facet\s++normal{THREE}\s++outer\s++loop{CORNER}{CORNER}{CORNER}\s++endloop\s++endfacet\b"
)

# Normals of shape (facets, 3), and the corners of each facet one after the other, of shape (3 facets, 3).
Facets = tuple[np.ndarray, np.ndarray]


def read_stl(path: Path) -> MeshFile:
    """The mesh of an STL file; its corners have the normals of their facets.

    Raises:
        SceneFileError: it is damaged, too large, or has no faces.
    """
    (stored,) = stl_meshes(path)
    mesh, notes = mesh_of(path, stored)
    return of_one_mesh(path, mesh, notes)


def stl_meshes(path: Path) -> list[Stored]:
    """What an STL file says. Raises SceneFileError."""
    data = file_bytes(path)
    count = int.from_bytes(data[COUNT_AT:HEAD], "little")
    is_binary = len(data) == HEAD + FACET.itemsize * count
    normals, corners = _binary_facets(path, data, count) if is_binary else _text_facets(path)
    faces = np.arange(len(corners)).reshape(-1, 3)
    return [Stored("the mesh", corners, faces, np.repeat(normals, 3, axis=0))]


def _binary_facets(path: Path, data: bytes, count: int) -> Facets:
    checked_size(path, 3 * count, count, "the file")
    facets = np.frombuffer(data, FACET, offset=HEAD)
    return facets["normal"], facets["corners"].reshape(-1, 3)


def _text_facets(path: Path) -> Facets:
    """The facets of all solids; what these are called may be anything."""
    text = file_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace").lower().strip()
    if not text.startswith("solid") or not re.search(r"\bendsolid\b", text.rpartition("\n")[2]):
        raise SceneFileError(f"{path}: no STL file, cut off or damaged; export it again")
    facets = re.sub(r"(?m)^[^\S\n]*(end)?solid\b.*$", "", text)
    count = facets.count("endfacet")
    checked_size(path, 3 * count, count, "the file")
    numbers = np.empty((count, 12))
    end = 0
    for at in range(count):
        numbers[at], end = _facet(path, facets, at, end)
    if facets[end:].strip():
        raise _damage_error(path, count)
    return numbers[:, :3], numbers[:, 3:].reshape(-1, 3)


def _facet(path: Path, facets: str, at: int, start: int) -> tuple[list[float], int]:
    """The 12 numbers of a text's facet number `at`, and where it ends."""
    found = TEXT_FACET.match(facets, start)
    if not found:
        raise _damage_error(path, at)
    try:
        return [float(word) for word in " ".join(found.groups()).split()], found.end()
    except ValueError as error:
        raise _damage_error(path, at) from error


def _damage_error(path: Path, at: int) -> SceneFileError:
    return SceneFileError(f"{path}: facet {at} is cut off or damaged; export it again")
