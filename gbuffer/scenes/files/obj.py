"""Wavefront OBJ files, and the colours in their MTL files.

The files are not read with trimesh (5.2), which counts negative indices from the end of the file and not from their
line, accepts 0 as an index, drops all normals if one index is out of range, skips unknown lines, and does not name
the line at which a file is damaged.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..scene import Material
from .mesh_file import MeshFile, Piece, Stored, checked_pieces, mesh_of
from .source import MAX_TEXT_BYTES, MAX_TRIANGLES, SceneFileError, checked_size, file_bytes, resource

# Numbers a line needs; more (a weight, a colour) are passed over.
VERTEX_DATA = {"v": 3, "vn": 3, "vt": 2}
KINDS = ("v", "vt", "vn")
# What a file may hold and this reader does not draw.
PASSED_OVER = frozenset(
    "g o s l p vp cstype deg surf end parm curv curv2 trim hole scrv sp con mg lod".split()  # noqa: SIM905 # to be read
)
COLOURS = {"Kd": "albedo", "Ks": "specular", "Ke": "emissive"}
NUMBERS = {"Ns": "power", "d": "alpha"}
LIMITS = {"power": (1.0, 2048.0), "alpha": (0.0, 1.0)}

# Of a corner: position, uv, normal; -1 where it has none.
Corner = tuple[int, int, int]


@dataclass
class _Obj:
    """The contents of an OBJ file, read line by line.

    Attributes:
        data: rows of numbers by kind.
        vertices: distinct corners.
        known: index of each corner in `vertices`, by its text in the file.
        corners: indices into `vertices`, three per triangle, by material.
        libraries, material, triangles: material files, the current material, and the number of triangles so far.
    """

    data: dict[str, list[tuple[float, ...]]] = field(default_factory=lambda: {kind: [] for kind in VERTEX_DATA})
    vertices: list[Corner] = field(default_factory=list)
    known: dict[str, int] = field(default_factory=dict)
    corners: dict[str, list[int]] = field(default_factory=dict)
    libraries: list[str] = field(default_factory=list)
    material: str = ""
    triangles: int = 0


def read_obj(path: Path) -> MeshFile:
    """Read an OBJ file: one mesh per material, visible from both sides.

    Raises:
        SceneFileError: the file is damaged, too large, has no faces, or names a file outside its folder.
    """
    obj = _obj_of(path)
    notes: list[str] = []
    known = _materials(path, obj.libraries, notes)
    pieces = []
    for index, stored in enumerate(_stored(path, obj)):
        mesh, made_up = mesh_of(path, stored)
        notes += made_up
        pieces.append(Piece(mesh, np.eye(4), index))
    materials = tuple(known.get(name, Material()) for name in obj.corners)
    kept = checked_pieces(path, pieces, notes)
    return MeshFile(path, kept, materials, (True,) * len(materials), None, tuple(dict.fromkeys(notes)))


def obj_meshes(path: Path) -> list[Stored]:
    """Return the meshes of an OBJ file as stored, one per material. Raises SceneFileError."""
    return list(_stored(path, _obj_of(path)))


def _obj_of(path: Path) -> _Obj:
    obj = _Obj()
    for number, words in _lines(file_bytes(path, MAX_TEXT_BYTES)):
        try:
            _take(obj, words)
        except (ValueError, IndexError) as error:
            shown = " ".join(words)[:60]
            raise SceneFileError(f"{path}: line {number}: {shown!r}: {error}; export it again") from error
    return obj


def _stored(path: Path, obj: _Obj) -> Iterator[Stored]:
    tables = {kind: _table(rows, VERTEX_DATA[kind]) for kind, rows in obj.data.items()}
    vertices = np.array(obj.vertices, np.int64).reshape(-1, 3)
    for name, corners in obj.corners.items():
        yield _mesh(path, f"material {name!r}" if name else "the mesh", tables, vertices, corners)


def _lines(data: bytes) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that is not empty; a line may continue after a backslash."""
    words: list[str] = []
    for number, line in enumerate(data.decode("utf-8", "replace").split("\n"), 1):
        text = line.partition("#")[0].rstrip()
        words += text.removesuffix("\\").split()
        if words and not text.endswith("\\"):
            yield number, words
            words = []


def _take(obj: _Obj, words: list[str]) -> None:
    """Add the content of one line, given as its words, to `obj`. Raises ValueError or IndexError if the line is not
    valid."""
    kind, rest = words[0], words[1:]
    if kind in VERTEX_DATA:
        size = VERTEX_DATA[kind]
        if len(rest) < size:
            raise ValueError(f"expected {size} numbers")
        obj.data[kind].append(tuple(map(float, rest[:size])))
    elif kind == "f":
        _take_face(obj, [obj.known[text] if text in obj.known else _new_corner(obj, text) for text in rest])
    elif kind == "usemtl":
        obj.material = " ".join(rest)
    elif kind == "mtllib":
        obj.libraries.append(" ".join(rest))
    elif kind not in PASSED_OVER:
        raise ValueError("not a line of an OBJ file")


def _take_face(obj: _Obj, corners: list[int]) -> None:
    if len(corners) < 3:
        raise ValueError("a face must have at least three corners")
    obj.triangles += len(corners) - 2
    if obj.triangles > MAX_TRIANGLES:
        raise ValueError(f"more than {MAX_TRIANGLES} (2^22) triangles")
    indices = obj.corners.setdefault(obj.material, [])
    for second, third in itertools.pairwise(corners[1:]):
        indices += (corners[0], second, third)


def _new_corner(obj: _Obj, text: str) -> int:
    """Add a corner, "position/uv/normal" with the last two optional, and return its index in `obj.vertices`. Indices
    in the text start at 1; negative indices count from the end. Raises ValueError."""
    words = text.split("/")
    if len(words) > len(KINDS) or not words[0]:
        raise ValueError("a corner must be position/uv/normal")
    indices = [_checked_index(word, len(obj.data[kind])) for word, kind in zip(words, KINDS, strict=False)]
    position, uv, normal = indices + [-1] * (len(KINDS) - len(indices))
    obj.vertices.append((position, uv, normal))
    # What a negative index means changes from line to line.
    if "-" not in text:
        obj.known[text] = len(obj.vertices) - 1
    return len(obj.vertices) - 1


def _checked_index(word: str, count: int) -> int:
    if not word:
        return -1
    index = int(word)
    index = index - 1 if index > 0 else index + count
    if not 0 <= index < count:
        raise ValueError(f"index {word} is out of range: there are {count} so far")
    return index


def _mesh(path: Path, place: str, tables: dict[str, np.ndarray], vertices: np.ndarray, corners: list[int]) -> Stored:
    """Return a mesh with one vertex per distinct corner; it has normals if any corner has a normal. Raises
    SceneFileError if the mesh is too large."""
    used, triangles = np.unique(np.array(corners, np.int64), return_inverse=True)
    checked_size(path, len(used), len(triangles) // 3, place)
    position, uv, normal = vertices[used].T
    normals = tables["vn"][normal] if (normal >= 0).any() else None
    return Stored(place, tables["v"][position], triangles.reshape(-1, 3), normals, tables["vt"][uv])


def _table(rows: list[tuple[float, ...]], width: int) -> np.ndarray:
    """Return rows of numbers as an array, (rows + 1, width), with a last row of zeros for the index -1."""
    return np.concatenate([np.array(rows).reshape(-1, width), np.zeros((1, width))])


def _materials(path: Path, libraries: list[str], notes: list[str]) -> dict[str, Material]:
    """Return the materials of the MTL files next to the OBJ file, by name; a missing MTL file is noted."""
    materials: dict[str, Material] = {}
    for name in dict.fromkeys(libraries):
        try:
            data = resource(path, name, "mtllib")
        except SceneFileError as error:
            if "no such file" not in str(error):
                raise
            notes.append(f"{name} does not exist; its materials are grey")
            continue
        materials |= _read_mtl(path, name, data, notes)
    return materials


def _read_mtl(path: Path, name: str, data: bytes, notes: list[str]) -> dict[str, Material]:
    materials: dict[str, Material] = {}
    current = ""
    for number, words in _lines(data):
        try:
            match words:
                case ["newmtl", *rest]:
                    current = " ".join(rest)
                    materials[current] = Material()
                case [word, *numbers] if word in COLOURS and current:
                    colour = tuple(
                        min(_checked_number(n), 1.0) for n in (numbers * 3 if len(numbers) == 1 else numbers)[:3]
                    )
                    materials[current] = replace(materials[current], **{COLOURS[word]: colour})
                case [word, value] if word in NUMBERS and current:
                    low, high = LIMITS[NUMBERS[word]]
                    materials[current] = replace(
                        materials[current], **{NUMBERS[word]: min(max(_checked_number(value), low), high)}
                    )
                case [word, *_] if word.lower().startswith(("map_", "bump", "norm", "disp", "decal", "refl")):
                    notes.append("textures are ignored; only colours are used")
        except ValueError as error:
            raise SceneFileError(f"{path}: {name}, line {number}: {error}; export it again") from error
    return materials


def _checked_number(text: str) -> float:
    number = float(text)
    if not number >= 0 or math.isinf(number):
        raise ValueError(f"{text} is not a number of at least 0")
    return number
