"""PLY files (Turk 1994), ASCII and binary of either byte order: vertices with normals and uv, faces with any number
of corners.

The files are not read with trimesh (5.2), which refuses binary files with both triangles and quads, accepts truncated
text files as complete, and splits and merges vertices that have uv.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .mesh_file import MeshFile, Rounding, Stored, mesh_of, of_one_mesh
from .source import MAX_TEXT_BYTES, SceneFileError, checked_size, file_bytes

SIZES = {"i1": "char int8", "u1": "uchar uint8", "i2": "short int16", "u2": "ushort uint16"}
SIZES |= {"i4": "int int32", "u4": "uint uint32", "f4": "float float32", "f8": "double float64"}
TYPES = {name: kind for kind, names in SIZES.items() for name in names.split()}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
UV = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"))
POSITION, NORMAL = ("x", "y", "z"), ("nx", "ny", "nz")
FACES = ("vertex_indices", "vertex_index")
MAX_HEADER = 1 << 16
MAX_CORNERS = 255
# Characters of a number.
MAX_TOKEN = 64


@dataclass(frozen=True)
class Property:
    """A property of an element: its type and, if it is a list, the type of its count."""

    name: str
    type: str
    counted_by: str | None


@dataclass(frozen=True)
class Element:
    """A table in the file: its name, its number of rows and its columns."""

    name: str
    count: int
    properties: list[Property]


# Columns by name: (count,) arrays, or for a list property a list of arrays.
Table = dict[str, np.ndarray | list[np.ndarray]]


def read_ply(path: Path) -> MeshFile:
    """Read the mesh of a PLY file, in one grey material visible from both sides.

    Raises:
        SceneFileError: the file is not a PLY file, is damaged or too large, or has no faces.
    """
    mesh, notes = mesh_of(path, _mesh(path, *_tables(path)))
    return of_one_mesh(path, mesh, notes)


def ply_meshes(path: Path) -> list[Stored]:
    """Return the mesh of a PLY file, or its points, as stored. Raises SceneFileError."""
    return [read_cloud(path) if is_cloud(path) else _mesh(path, *_tables(path))]


def is_cloud(path: Path) -> bool:
    """Whether a PLY file has points with normals, and no faces. Raises SceneFileError."""
    _, elements, _ = _header(path, file_bytes(path))
    of = {element.name: element for element in elements}
    has_faces = "face" in of and of["face"].count > 0
    return not has_faces and "vertex" in of and {*NORMAL} <= {p.name for p in of["vertex"].properties}


def read_cloud(path: Path) -> Stored:
    """Return the points of a point cloud with their normals; points without positions receive distinct made-up
    positions. Raises SceneFileError, also if the points have no normals."""
    tables, types = _tables(path)
    normals, roundings = _normals(tables["vertex"], types["vertex"])
    if normals is None or not len(normals):
        raise SceneFileError(f"{path}: only points with nx, ny, nz are supported; export it again")
    positions = _columns(tables["vertex"], POSITION)
    # Points without places are told apart by their numbers.
    places = np.arange(3.0 * len(normals)).reshape(-1, 3) if positions is None else positions
    return Stored("the points", places, np.arange(len(normals))[:, None], normals, roundings=roundings)


def _normals(vertex: Table, types: dict[str, str]) -> tuple[np.ndarray | None, tuple[Rounding, ...]]:
    """Return decoded normals (or None) and their roundings (empty for floats). Signed integers represent [-1, 1]
    symmetrically about 0; unsigned integers represent it over their whole range."""
    normals, kinds = _columns(vertex, NORMAL), {types[name] for name in NORMAL if name in types}
    kind = np.dtype(kinds.pop() if len(kinds) == 1 else "f8")
    if normals is None or kind.kind == "f":
        return normals, ()
    full = np.iinfo(kind).max
    if kind.kind == "i":
        return np.maximum(normals / full, -1.0), (Rounding(full),)
    return normals / full * 2 - 1, (Rounding(full / 2),)


def _tables(path: Path) -> tuple[dict[str, Table], dict[str, dict[str, str]]]:
    """Return the columns of a PLY file and their types in the header, each by element and property. Raises
    SceneFileError."""
    data = file_bytes(path)
    order, elements, start = _header(path, data)
    tables: dict[str, Table] = {}
    if not order and len(data) > MAX_TEXT_BYTES:
        raise SceneFileError(f"{path}: {len(data)} bytes of text; the maximum is {MAX_TEXT_BYTES}: export it in binary")
    tokens = data[start:].split() if not order else []
    offset = 0 if not order else start
    for element in elements:
        if order:
            tables[element.name], offset = _binary(path, data, offset, element, order)
        else:
            tables[element.name], offset = _ascii(path, tokens, offset, element)
    return tables, {element.name: {p.name: p.type for p in element.properties} for element in elements}


def _header(path: Path, data: bytes) -> tuple[str, list[Element], int]:
    """Return the byte order ("<", ">" or "" for ASCII), the elements and the offset of the first row. Raises
    SceneFileError."""
    end = data.find(b"end_header", 0, MAX_HEADER)
    newline = data.find(b"\n", end)
    if not data.startswith(b"ply") or end < 0 or newline < 0:
        raise SceneFileError(f"{path}: no PLY header, which starts with ply and ends with end_header; export it again")
    order, elements = None, []
    for number, line in enumerate(data[:end].decode("latin-1").splitlines()[1:], 2):
        match line.split():
            case ["format", word, _] if word in ORDERS:
                order = ORDERS[word]
            case ["element", name, count] if count.isascii() and count.isdigit() and len(count) < 12:
                elements.append(Element(name, int(count), []))
            case ["property", "list", counted, kind, name] if counted in TYPES and kind in TYPES and elements:
                if TYPES[counted][0] == "f":
                    raise SceneFileError(f"{path}: line {number}: a list count must be an integer; export it again")
                elements[-1].properties.append(Property(name, TYPES[kind], TYPES[counted]))
            case ["property", kind, name] if kind in TYPES and elements:
                elements[-1].properties.append(Property(name, TYPES[kind], None))
            case [] | ["comment", *_] | ["obj_info", *_]:
                pass
            case _:
                raise SceneFileError(
                    f"{path}: line {number}: {line[:60]!r} is not a line of a PLY header; export it again"
                )
    if order is None:
        raise SceneFileError(f"{path}: the header names no format; expected one of {', '.join(ORDERS)}")
    return order, elements, newline + 1


def _check_count(path: Path, element: Element, left: int, least: int) -> None:
    """Raise SceneFileError if a table is not valid, or is larger than the rest of the file or the maximum size."""
    names = [p.name for p in element.properties]
    if not names or len(set(names)) < len(names):
        raise SceneFileError(f"{path}: element {element.name}: no properties, or a duplicate name; export it again")
    if element.count * least > left:
        raise SceneFileError(
            f"{path}: element {element.name}: the file holds fewer than {element.count} rows; it is cut off: "
            "export it again"
        )
    vertices, triangles = (element.count * (element.name == name) for name in ("vertex", "face"))
    checked_size(path, vertices, triangles, f"element {element.name}")


def _damage_error(path: Path, element: Element, row: int) -> SceneFileError:
    return SceneFileError(f"{path}: element {element.name}, row {row}: cut off or damaged; export it again")


def _binary(path: Path, data: bytes, offset: int, element: Element, order: str) -> tuple[Table, int]:
    """Return the table of an element in a binary file, read from `offset`, and the offset after it. Raises
    SceneFileError."""
    least = sum(np.dtype(p.counted_by or p.type).itemsize for p in element.properties)
    _check_count(path, element, len(data) - offset, least)
    lists = [p for p in element.properties if p.counted_by]
    lengths = _first_lengths(data, offset, element, order) if lists and element.count else {}
    table = _alike(data, offset, element, order, lengths)
    if table is not None:
        return table
    rows: dict[str, list] = {p.name: [] for p in element.properties}
    for row in range(element.count):
        for p in element.properties:
            try:
                values, offset = _values(data, offset, p, order)
            except ValueError as error:
                raise _damage_error(path, element, row) from error
            rows[p.name].append(values if p.counted_by else values[0])
    return {p.name: rows[p.name] if p.counted_by else np.array(rows[p.name]) for p in element.properties}, offset


def _values(data: bytes, offset: int, p: Property, order: str) -> tuple[np.ndarray, int]:
    """Return the value of a property at an offset, or a list property's values, and the offset after them. Raises
    ValueError beyond the end of the data, and for more than MAX_CORNERS values."""
    count = 1
    if p.counted_by:
        count = int(np.frombuffer(data, order + p.counted_by, 1, offset)[0])
        offset += np.dtype(p.counted_by).itemsize
        if not 0 <= count <= MAX_CORNERS:
            raise ValueError(count)
    kind = np.dtype(order + p.type)
    if offset + count * kind.itemsize > len(data):
        raise ValueError(offset)
    return np.frombuffer(data, kind, count, offset) if count else np.zeros(0, kind), offset + count * kind.itemsize


def _first_lengths(data: bytes, offset: int, element: Element, order: str) -> dict[str, int]:
    """Return the number of values that each property has in the first row; empty if the row is damaged."""
    lengths: dict[str, int] = {}
    try:
        for p in element.properties:
            values, offset = _values(data, offset, p, order)
            lengths[p.name] = len(values)
    except ValueError:
        return {}
    return lengths


def _alike(data: bytes, offset: int, element: Element, order: str, lengths: dict[str, int]) -> tuple[Table, int] | None:
    """Return an element's table, read in one step, and the offset after it; None if a row's lists differ in length
    from `lengths`, or if the data end too soon."""
    fields = []
    for p in element.properties:
        if p.counted_by:
            if p.name not in lengths and element.count:
                return None
            fields += [(f"{p.name} count", order + p.counted_by)]
            fields += [(p.name, order + p.type, (lengths.get(p.name, 0),))]
        else:
            fields += [(p.name, order + p.type)]
    kind = np.dtype(fields)
    if offset + element.count * kind.itemsize > len(data):
        return None
    rows = np.frombuffer(data, kind, element.count, offset) if element.count else np.zeros(0, kind)
    lists = [p for p in element.properties if p.counted_by]
    if any(np.any(rows[f"{p.name} count"] != lengths.get(p.name, 0)) for p in lists):
        return None
    return {p.name: rows[p.name] for p in element.properties}, offset + element.count * kind.itemsize


def _ascii(path: Path, tokens: list[bytes], index: int, element: Element) -> tuple[Table, int]:
    """Return the table of an element in an ASCII file, read from token number `index`, and the index after it. Raises
    SceneFileError."""
    _check_count(path, element, len(tokens) - index, len(element.properties))
    width = len(element.properties)
    if not any(p.counted_by for p in element.properties):
        part = tokens[index : index + element.count * width]
        try:
            if max(map(len, part), default=0) > MAX_TOKEN:
                raise ValueError(f"a number of more than {MAX_TOKEN} characters")
            rows = np.array(part, np.bytes_).astype(np.float64).reshape(-1, width)
        except ValueError as error:
            raise SceneFileError(f"{path}: element {element.name}: {error}; export it again") from error
        return {p.name: rows[:, column] for column, p in enumerate(element.properties)}, index + len(part)
    table: dict[str, list] = {p.name: [] for p in element.properties}
    for row in range(element.count):
        try:
            for p in element.properties:
                count = 1
                if p.counted_by:
                    count, index = int(tokens[index]), index + 1
                values = [float(token) for token in tokens[index : index + count]]
                if not 0 <= count <= MAX_CORNERS or len(values) < count:
                    raise ValueError(count)
                index += count
                table[p.name].append(np.array(values) if p.counted_by else values[0])
        except (ValueError, IndexError) as error:
            raise _damage_error(path, element, row) from error
    return {p.name: table[p.name] if p.counted_by else np.array(table[p.name]) for p in element.properties}, index


def _columns(table: Table, names: tuple[str, ...]) -> np.ndarray | None:
    """Return columns side by side, float64 of shape (rows, columns); None if a column is missing or is a list."""
    columns = [table.get(name) for name in names]
    if not all(isinstance(column, np.ndarray) and column.ndim == 1 for column in columns):
        return None
    # A NaN of the signalling kind is one all the same, and is found where numbers are checked.
    with np.errstate(invalid="ignore"):
        return np.stack([np.asarray(column, np.float64) for column in columns], axis=1)


def _mesh(path: Path, tables: dict[str, Table], types: dict[str, dict[str, str]]) -> Stored:
    vertex, face = tables.get("vertex", {}), tables.get("face", {})
    positions = _columns(vertex, POSITION)
    faces = next((face[name] for name in FACES if name in face), None)
    if positions is None or faces is None or not len(faces):
        raise SceneFileError(
            f"{path}: neither vertices with x, y, z and faces with vertex_indices, nor points with nx, ny, nz; export "
            "one of them"
        )
    uv = next((columns for names in UV if (columns := _columns(vertex, names)) is not None), None)
    triangles = _fans(path, faces)
    checked_size(path, len(positions), len(triangles), "faces")
    normals, roundings = _normals(vertex, types["vertex"])
    return Stored("the mesh", positions, triangles, normals, uv, roundings=roundings)


def _fans(path: Path, faces: np.ndarray | list[np.ndarray]) -> np.ndarray:
    """Return faces with any number of corners as triangles, fans around the first corner, int64 of shape
    (triangles, 3). Raises SceneFileError."""
    if isinstance(faces, np.ndarray):
        if faces.ndim != 2:
            raise SceneFileError(f"{path}: faces must be lists of vertices; export it again")
        faces = faces.astype(np.float64)
        fans = [np.stack([faces[:, 0], faces[:, k], faces[:, k + 1]], axis=1) for k in range(1, faces.shape[1] - 1)]
        triangles = np.stack(fans, axis=1).reshape(-1, 3) if fans else np.zeros((0, 3))
    else:
        triangles = np.array([(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)], np.float64)
    if not np.all(np.abs(triangles) < 2**32):
        raise SceneFileError(f"{path}: a face has a vertex index that is not a number; export it again")
    return triangles.astype(np.int64).reshape(-1, 3)
