"""OFF files, in one grey material seen from both sides.

trimesh 5.2 reads triangles and quadrangles of one size alone, fails on comments, and takes 1 kB a triangle.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .mesh_file import MeshFile, Stored, mesh_of, of_one_mesh
from .source import MAX_TEXT_BYTES, SceneFileError, checked_size, file_bytes


def read_off(path: Path) -> MeshFile:
    """The mesh of an OFF file; faces of more than three corners become fans of triangles.

    Raises:
        SceneFileError: it is damaged, too large, or has no faces.
    """
    text = file_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace")
    head = re.match(r"C?OFF\s+(\d{1,9})\s+(\d{1,9}).*\n", text := re.sub(r"#.*", "", text).strip())
    try:
        if not head:
            raise ValueError("no header")
        vertices, faces = map(int, head.groups())
        lines = [line for line in text[head.end() :].split("\n") if line.strip()]
        if len(lines) < vertices + faces:
            raise ValueError("a line is missing")
        triangles = _triangles(lines[vertices : vertices + faces])
        checked_size(path, vertices, len(triangles), "the file")
        positions = _numbers(lines[:vertices], range(3), np.float64)
    except SceneFileError:
        raise
    except (ValueError, Warning) as error:
        raise SceneFileError(f"{path}: no OFF file, cut off or damaged; export it again") from error
    mesh, notes = mesh_of(path, Stored("the mesh", positions, triangles))
    return of_one_mesh(path, mesh, notes)


def _triangles(lines: Sequence[str]) -> np.ndarray:
    """(triangles, 3) in the order of the faces, each of which is a line: a count, its indices, perhaps a colour."""
    alike: dict[str, list[int]] = {}
    for at, line in enumerate(lines):
        alike.setdefault(line.split(None, 1)[0], []).append(at)
    triangles, face = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    for word, places in alike.items():
        count = int(word)
        if not 3 <= count < len(lines[places[0]].split()):
            raise ValueError("a corner is missing")
        corners = _numbers([lines[at] for at in places], range(1, count + 1), np.int64)
        fan = np.stack([np.zeros(count - 2, np.int64), np.arange(1, count - 1), np.arange(2, count)], axis=1)
        triangles.append(corners[:, fan].reshape(-1, 3))
        face.append(np.repeat(places, count - 2))
    return np.concatenate(triangles)[np.argsort(np.concatenate(face), kind="stable")]


def _numbers(lines: Sequence[str], columns: range, dtype: type) -> np.ndarray:
    """Some columns of lines of numbers. Raises ValueError or a warning where one is missing or is not such a number."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return np.loadtxt(lines, dtype, usecols=columns, ndmin=2, comments=None)
