"""STL and OFF files by trimesh, in one grey material seen from both sides.

Its loaders of these formats are called by themselves: `trimesh.load` merges and reorders vertices, and opens what a
file names. They pass over words that are no numbers and what is missing at the end of a text, so that what they give is
counted against what the file says.
"""

from __future__ import annotations

import io
import re
import struct
import warnings
from pathlib import Path

import numpy as np

from ..scene import Material
from .mesh_file import MeshFile, Piece, mesh_of
from .source import MAX_TEXT_BYTES, SceneFileError, checked_size, file_bytes


def read_by_trimesh(path: Path) -> MeshFile:
    """The mesh of an STL or OFF file; an STL's corners have the normals of their facets.

    Raises:
        SceneFileError: it is damaged, too large, or has no faces.
    """
    kind = path.suffix[1:].lower()
    data = file_bytes(path)
    try:
        if kind == "off" or not _binary_facets(data):
            data = file_bytes(path, MAX_TEXT_BYTES)
            text, vertices, triangles = (_off if kind == "off" else _stl)(data.decode("utf-8", "replace"))
            data = text.encode()
        else:
            vertices, triangles = 3 * _binary_facets(data), _binary_facets(data)
        checked_size(path, vertices, triangles, "the file")
        found = _loaded(kind, data)
        positions, faces = (np.asarray(found[key]).reshape(-1, 3) for key in ("vertices", "faces"))
        if (len(positions), len(faces)) != (vertices, triangles):
            raise ValueError("what was read is not all of it")
    except SceneFileError:
        raise
    except Exception as error:  # of a dozen kinds, by what is damaged
        raise SceneFileError(f"{path}: no {kind.upper()} file, cut off or damaged; export it again") from error
    normals = found.get("face_normals")
    mesh, notes = mesh_of(
        path, "the mesh", positions, faces, None if normals is None else np.repeat(normals, 3, axis=0)
    )
    return MeshFile(path, (Piece(mesh, np.eye(4), 0),), (Material(),), (True,), None, tuple(notes))


def _loaded(kind: str, data: bytes) -> dict:
    # Here, because it takes more than a second.
    from trimesh.exchange import off, stl

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return {"stl": stl.load_stl, "off": off.load_off}[kind](io.BytesIO(data))


def _binary_facets(data: bytes) -> int:
    """How many facets a binary STL file has; 0 where it is none."""
    (count,) = struct.unpack_from("<I", data, 80) if len(data) >= 84 else (0,)
    return count if len(data) == 84 + 50 * count else 0


def _stl(text: str) -> tuple[str, int, int]:
    """A text STL's facets as one solid without a name, and how many vertices and triangles there are."""
    if not re.match(r"\s*solid", text, re.IGNORECASE) or not re.search(r"(?i)\bendsolid[^\n]*\s*\Z", text):
        raise ValueError("no solid")
    facets = re.sub(r"(?im)^[^\S\n]*(end)?solid\b.*$", "", text)
    count = len(re.findall(r"(?i)vertex", facets))
    return f"solid\n{facets}\nendsolid\n", count, count // 3


def _off(text: str) -> tuple[str, int, int]:
    """An OFF file of triangles alone, and how many vertices and triangles it has.

    trimesh 5.2 fails on faces of several sizes with NumPy 2.4, and on comments.
    """
    head = re.match(r"C?OFF\s+(\d+)\s+(\d+).*\n", text := re.sub(r"#.*", "", text).strip())
    if not head:
        raise ValueError("no header")
    vertices, faces = map(int, head.groups())
    lines = [line.split() for line in text[head.end() :].split("\n") if line.strip()]
    corners = [(int(line[0]), line[1:]) for line in lines[vertices : vertices + faces]]
    if len(corners) < faces or any(not 3 <= count <= len(found) for count, found in corners):
        raise ValueError("a face is missing")
    fans = [(found[0], *found[i : i + 2]) for count, found in corners for i in range(1, count - 1)]
    made = [" ".join(line[:3]) for line in lines[:vertices]] + [f"3 {a} {b} {c}" for a, b, c in fans]
    return "\n".join([f"OFF\n{vertices} {len(fans)} 0", *made, ""]), vertices, len(fans)
