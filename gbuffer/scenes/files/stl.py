"""STL files by trimesh, in one grey material seen from both sides.

Its loader of this format is called by itself: `trimesh.load` merges and reorders vertices. It passes over words that
are not numbers and what is missing at the end of a text, so that what it gives is counted against what the file says.
"""

from __future__ import annotations

import io
import re
import struct
import warnings
from pathlib import Path

import numpy as np

from .mesh_file import MeshFile, mesh_of, of_one_mesh
from .source import MAX_TEXT_BYTES, SceneFileError, checked_size, file_bytes


def read_stl(path: Path) -> MeshFile:
    """The mesh of an STL file; its corners have the normals of their facets.

    Raises:
        SceneFileError: it is damaged, too large, or has no faces.
    """
    data = file_bytes(path)
    try:
        triangles = _binary_facets(data)
        if not triangles:
            text, triangles = _one_solid(file_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace"))
            data = text.encode()
        checked_size(path, 3 * triangles, triangles, "the file")
        found = _loaded(data)
        positions, faces = (np.asarray(found[key]).reshape(-1, 3) for key in ("vertices", "faces"))
        normals = np.asarray(found["face_normals"]).reshape(-1, 3)
        if (len(positions), len(faces), len(normals)) != (3 * triangles, triangles, triangles):
            raise ValueError("what was read is not all of it")
    except SceneFileError:
        raise
    except Exception as error:  # of a dozen kinds, by what is damaged
        raise SceneFileError(f"{path}: no STL file, cut off or damaged; export it again") from error
    mesh, notes = mesh_of(path, "the mesh", positions, faces, np.repeat(normals, 3, axis=0))
    return of_one_mesh(path, mesh, notes)


def _loaded(data: bytes) -> dict:
    # Here, because it takes more than a second.
    from trimesh.exchange.stl import load_stl

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return load_stl(io.BytesIO(data))


def _binary_facets(data: bytes) -> int:
    """How many facets a binary STL file has; 0 where it is none."""
    (count,) = struct.unpack_from("<I", data, 80) if len(data) >= 84 else (0,)
    return count if len(data) == 84 + 50 * count else 0


def _one_solid(text: str) -> tuple[str, int]:
    """A text STL's facets as one solid without a name, and how many there are."""
    if not re.match(r"\s*solid", text, re.IGNORECASE) or not re.search(r"(?i)\bendsolid[^\n]*\s*\Z", text):
        raise ValueError("no solid")
    facets = re.sub(r"(?im)^[^\S\n]*(end)?solid\b.*$", "", text)
    return f"solid\n{facets}\nendsolid\n", len(re.findall(r"(?i)vertex", facets)) // 3
