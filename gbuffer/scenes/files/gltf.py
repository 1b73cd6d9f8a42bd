"""glTF 2.0 and GLB files: meshes under their nodes' transforms, with their own normals and tangents; materials,
lights and the first camera.

A node's transform is applied to its vertices unchanged, even if it mirrors them or scales them non-uniformly. Normals
use the inverse transpose, and tangents are transformed like positions.

The files are not read with trimesh (5.2), which drops tangents, does not give a mirrored mesh the file's normals, and
accepts indices that are out of range and nodes that are their own ancestors.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..mesh import Mesh, laid_by
from ..metal_rough import MetalRough
from ..sampled import placed_uv
from ..scene import View
from .gltf_data import COMPONENTS, Gltf, Object, meant_numbers
from .gltf_lights import lights_of
from .gltf_materials import DEFAULT, Materials
from .gltf_packed import DRACO, draco_primitive
from .mesh_file import MeshFile, Piece, Rounding, Stored, checked_pieces, mesh_of
from .source import MAX_TRIANGLES, checked_indices, checked_size

TRIANGLES, STRIP, FAN = 4, 5, 6
ATTRIBUTES = {"NORMAL": 3, "TANGENT": 4, "TEXCOORD_0": 2, "TEXCOORD_1": 2}
# Cameras without a far plane see this many times as far as their near plane.
FAR = 1e5
# A file's bitangents go up in a picture, against v; those of `Mesh.authored` go along v.
ALONG_V = (1.0, 1.0, 1.0, -1.0)


def read_gltf(path: Path) -> MeshFile:
    """Return the default scene of a glTF or GLB file: its meshes, materials, lights and first camera.

    Raises:
        SceneFileError: the file is damaged, too large, needs an unsupported extension, names a file outside its
            folder, or has no triangles.
    """
    gltf = Gltf(path)
    nodes = list(_placed_nodes(gltf))
    notes = list(gltf.notes)
    _check_sizes(gltf, nodes)
    read = Materials(gltf)
    # A primitive without a material has the last.
    materials, two_sided = zip(*read.all(), (DEFAULT, False), strict=True)
    meshes: dict[int, list[tuple[Mesh, int]]] = {}
    pieces = []
    for node, model in nodes:
        if "mesh" in node:
            index = node["mesh"]
            mesh = gltf.entry("meshes", index, "a node")
            if index not in meshes:
                meshes[index] = list(_primitives(gltf, mesh, f"meshes[{index}]", materials, notes))
            pieces += [Piece(part, model, material) for part, material in meshes[index]]
    view = next((v for node, model in nodes if (v := _camera(gltf, node, model, notes))), None)
    kept = checked_pieces(path, pieces, notes)
    lights = lights_of(gltf, nodes, kept, notes)
    unique_notes = tuple(dict.fromkeys([*notes, *read.notes]))
    return MeshFile(path, kept, materials, two_sided, view, unique_notes, lights)


def gltf_meshes(path: Path) -> list[Stored]:
    """Return the meshes of the default scene as stored, including points and lines, each mesh once and in its own
    space.

    Raises:
        SceneFileError: as for `read_gltf`, except that the file may have no triangles.
    """
    gltf = Gltf(path)
    # A mesh in several places is read once.
    nodes = {str(node["mesh"]): (node, model) for node, model in _placed_nodes(gltf) if "mesh" in node}
    _check_sizes(gltf, list(nodes.values()))
    places = [(gltf.entry("meshes", node["mesh"], "a node"), f"meshes[{node['mesh']}]") for node, _ in nodes.values()]
    return [
        _stored(gltf, primitive, gltf.whole(primitive, "mode", where, TRIANGLES), where)
        for mesh, place in places
        for primitive, where in _mesh_primitives(gltf, mesh, place)
    ]


def _children(gltf: Gltf, index: int) -> list[int]:
    place = f"nodes[{index}]"
    children = gltf.list_of(gltf.entry("nodes", index, "the scene"), "children", place)
    for child in children:
        gltf.entry("nodes", child, f"{place}.children")
    return children


def _checked_tree(gltf: Gltf) -> list[int]:
    """Return the indices of the nodes that have no parent. Raises SceneFileError if the nodes do not form trees."""
    count = len(gltf.list_of(gltf.json, "nodes", "the file"))
    parents: dict[int, int] = {}
    for index in range(count):
        for child in _children(gltf, index):
            if child in parents:
                raise gltf.error(f"nodes[{child}]", f"is a child of nodes[{parents[child]}] and of nodes[{index}]")
            parents[child] = index
    tops = [index for index in range(count) if index not in parents]
    reached, waiting = set(tops), list(tops)
    while waiting:
        children = _children(gltf, waiting.pop())
        reached.update(children)
        waiting += children
    lost = sorted(set(range(count)) - reached)
    if lost:
        raise gltf.error(f"nodes[{lost[0]}]", "is its own ancestor: a cycle")
    return tops


def _placed_nodes(gltf: Gltf) -> Iterator[tuple[Object, np.ndarray]]:
    """Yield each node of the default scene with its matrix to world space."""
    tops = _checked_tree(gltf)
    if gltf.list_of(gltf.json, "scenes", "the file"):
        scene = gltf.entry("scenes", gltf.json.get("scene", 0), "the file's scene")
        named = gltf.list_of(scene, "nodes", "the scene")
        allowed = set(tops)
        for index in named:
            gltf.entry("nodes", index, "the scene")
            if index not in allowed:
                raise gltf.error("the scene", f"lists nodes[{index}] twice, or lists a node that has a parent")
            allowed.discard(index)
        tops = named
    waiting = [(index, np.eye(4)) for index in reversed(tops)]
    while waiting:
        index, above = waiting.pop()
        node = gltf.entry("nodes", index, "the scene")
        with np.errstate(over="ignore", invalid="ignore"):
            model = above @ _local_matrix(gltf, node, f"nodes[{index}]")
        if not np.all(np.abs(model) < 1e15):
            raise gltf.error(
                f"nodes[{index}]", "is moved or scaled beyond 1e15", "apply the transforms in the exporter"
            )
        yield node, model
        waiting += [(child, model) for child in reversed(_children(gltf, index))]


def _local_matrix(gltf: Gltf, node: Object, place: str) -> np.ndarray:
    """Return a node's own matrix, (4, 4), for column vectors; the file lists its numbers column by column. Raises
    SceneFileError."""
    if "matrix" in node:
        matrix = np.array(gltf.numbers(node, "matrix", place, tuple(np.eye(4).ravel()))).reshape(4, 4).T
        if not np.array_equal(matrix[3], (0, 0, 0, 1)):
            raise gltf.error(f"{place}.matrix", "is not an affine transform")
        return matrix
    x, y, z, w = gltf.numbers(node, "rotation", place, (0.0, 0.0, 0.0, 1.0))
    length = np.sqrt(x * x + y * y + z * z + w * w)
    if length < 1e-9:
        raise gltf.error(f"{place}.rotation", "is not a quaternion: its length is 0")
    x, y, z, w = (c / length for c in (x, y, z, w))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    ]
    matrix[:3, :3] *= gltf.numbers(node, "scale", place, (1.0, 1.0, 1.0))
    matrix[:3, 3] = gltf.numbers(node, "translation", place, (0.0, 0.0, 0.0))
    return matrix


def _check_sizes(gltf: Gltf, nodes: list[tuple[Object, np.ndarray]]) -> None:
    """Raise SceneFileError if the meshes of all nodes together are too large to read; only headers are used."""
    sizes: dict[int, tuple[int, int]] = {}
    vertices = triangles = 0
    for node, _ in nodes:
        if "mesh" in node:
            index = node["mesh"]
            mesh = gltf.entry("meshes", index, "a node")
            if index not in sizes:
                sizes[index] = _size(gltf, mesh, f"meshes[{index}]")
            vertices, triangles = vertices + sizes[index][0], triangles + sizes[index][1]
    checked_size(gltf.path, vertices, triangles, "the scene")


def _size(gltf: Gltf, mesh: Object, place: str) -> tuple[int, int]:
    """Return the number of a mesh's vertices and an upper bound on its number of triangles, from headers alone."""
    vertices = triangles = 0
    for primitive, where in _mesh_primitives(gltf, mesh, place):
        attributes = gltf.child(primitive, "attributes", where)
        count = gltf.count(attributes.get("POSITION"), f"{where}.POSITION")
        corners = gltf.count(primitive["indices"], f"{where}.indices") if "indices" in primitive else count
        vertices += count
        triangles += corners // 3 if primitive.get("mode", TRIANGLES) == TRIANGLES else corners
    return vertices, triangles


def _mesh_primitives(gltf: Gltf, mesh: Object, place: str) -> list[tuple[Object, str]]:
    """Return each primitive of a mesh, with its place for messages, such as "meshes[0].primitives[1]". Raises
    SceneFileError."""
    primitives = gltf.list_of(mesh, "primitives", place)
    if not all(isinstance(primitive, dict) for primitive in primitives):
        raise gltf.error(f"{place}.primitives", "contains an entry that is not an object")
    return [(primitive, f"{place}.primitives[{number}]") for number, primitive in enumerate(primitives)]


def _primitives(
    gltf: Gltf, mesh: Object, place: str, materials: tuple[MetalRough, ...], notes: list[str]
) -> Iterator[tuple[Mesh, int]]:
    """Yield a triangle mesh for each primitive of a mesh, with its material's index (-1 for the default). Points and
    lines are left out and noted."""
    for primitive, where in _mesh_primitives(gltf, mesh, place):
        mode = gltf.whole(primitive, "mode", where, TRIANGLES)
        if mode not in (TRIANGLES, STRIP, FAN):
            notes.append("points and lines are not drawn")
            continue
        material = -1
        if "material" in primitive:
            gltf.entry("materials", primitive["material"], where)
            material = primitive["material"]
        yield _primitive(gltf, primitive, mode, materials[material], where, notes), material


def _primitive(gltf: Gltf, primitive: Object, mode: int, material: MetalRough, where: str, notes: list[str]) -> Mesh:
    stored = _stored(gltf, primitive, mode, where)
    if len(stored.corners) > MAX_TRIANGLES:
        many = f"has {len(stored.corners)} triangles; the maximum is {MAX_TRIANGLES}"
        raise gltf.error(where, many, "export fewer objects")
    mesh, mesh_notes = mesh_of(gltf.path, stored)
    notes += mesh_notes
    notes += _lacking_uv(material, stored.uv, stored.second_uv)
    normal_map = material.normal_map
    return mesh if normal_map is None or mesh.authored is not None else laid_by(mesh, placed_uv(mesh, normal_map))


def _lacking_uv(material: MetalRough, *sets: np.ndarray | None) -> list[str]:
    """Return notes on the uv sets that a material's maps use and a mesh lacks."""
    lacking = {m.uv_set for m in material.maps if m is not None and sets[m.uv_set] is None}
    remarks = ("their textures are sampled at one point", "TEXCOORD_0 is used")
    return [f"some meshes have no TEXCOORD_{uv_set}: {remarks[uv_set]}" for uv_set in sorted(lacking)]


def _stored(gltf: Gltf, primitive: Object, mode: int, where: str) -> Stored:
    """Return a primitive as stored, or its points if it has no triangles."""
    corners, arrays = _stored_numbers(gltf, primitive, mode, where)
    normals, uv, second = (arrays.get(name) for name in ("NORMAL", "TEXCOORD_0", "TEXCOORD_1"))
    # Tangents without normals say nothing (glTF 2.0, 3.7.2.1).
    tangents = arrays["TANGENT"] * ALONG_V if normals is not None and "TANGENT" in arrays else None
    roundings = () if normals is None else _roundings(gltf, primitive["attributes"]["NORMAL"], where)
    return Stored(where, arrays["POSITION"], corners, normals, uv, tangents, second, roundings)


def _roundings(gltf: Gltf, index: object, where: str) -> tuple[Rounding, ...]:
    """Return how an accessor's normals were rounded: by their own integers, and by the octahedral map with which
    EXT_meshopt_compression packed them."""
    accessor = gltf.entry("accessors", index, where)
    kind = np.dtype(COMPONENTS[accessor["componentType"]])
    bits = gltf.octahedral_bits.get(accessor.get("bufferView"))
    packed = () if bits is None else (Rounding(2 ** (bits - 1) - 1, is_octahedral=True),)
    return packed + ((Rounding(np.iinfo(kind).max),) if kind.kind == "i" else ())


def _stored_numbers(gltf: Gltf, primitive: Object, mode: int, where: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return a primitive's vertex indices, (triangles, 3) or (points, 1), and its attributes by name, always with
    POSITION. Raises SceneFileError."""
    attributes = gltf.child(primitive, "attributes", where)
    position = gltf.entry("accessors", attributes.get("POSITION"), f"{where}.POSITION")
    extension = gltf.extension(primitive, DRACO, where)
    packed_triangles, packed = None, {}
    if extension and (gltf.requires(DRACO) or "bufferView" not in position):
        packed_triangles, packed = draco_primitive(gltf, primitive, where)
    arrays = {}
    for name, width in {"POSITION": 3, **ATTRIBUTES}.items():
        if name in packed and name in attributes:
            arrays[name] = _unpacked(gltf, attributes[name], packed[name], width, f"{where}.{name}")
        elif name in attributes:
            arrays[name] = gltf.accessor(attributes[name], width, f"{where}.{name}")
        if len(arrays.get(name, arrays["POSITION"])) != len(arrays["POSITION"]):
            raise gltf.error(
                f"{where}.{name}", f"has {len(arrays[name])} elements for {len(arrays['POSITION'])} positions"
            )
    count = len(arrays["POSITION"])
    if packed_triangles is not None:
        return checked_indices(gltf.path, packed_triangles, count, f"{where}.{DRACO}"), arrays
    corners = gltf.indices(primitive["indices"], f"{where}.indices") if "indices" in primitive else np.arange(count)
    return _triangles(checked_indices(gltf.path, corners, count, f"{where}.indices"), mode), arrays


def _unpacked(gltf: Gltf, index: object, stored: np.ndarray, width: int, place: str) -> np.ndarray:
    """Return a Draco attribute's numbers, float64 of shape (count, width), normalised if the accessor requires it.
    Raises SceneFileError if `stored` has the wrong shape."""
    accessor = gltf.entry("accessors", index, place)
    count = gltf.whole(accessor, "count", place)
    if stored.shape != (count, width):
        raise gltf.error(place, f"is packed as {' x '.join(map(str, stored.shape))} numbers, not {count} x {width}")
    return meant_numbers(stored, accessor.get("normalized") is True)


def _triangles(corners: np.ndarray, mode: int) -> np.ndarray:
    """Return the triangles of a list, strip or fan of vertex indices, (triangles, 3), with consistent winding; for
    points and lines, the indices unchanged, (points, 1)."""
    if mode not in (TRIANGLES, STRIP, FAN):
        return corners[:, None]
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    count = max(len(corners) - 2, 0)
    step = np.arange(count)
    if mode == FAN:
        return np.stack([corners[step + 1], corners[step + 2], np.broadcast_to(corners[:1], count)], axis=1)
    odd = step % 2
    return np.stack([corners[step], corners[step + 1 + odd], corners[step + 2 - odd]], axis=1)


def _colour(values: np.ndarray) -> tuple[float, float, float]:
    r, g, b = map(float, values)
    return r, g, b


def _camera(gltf: Gltf, node: Object, model: np.ndarray, notes: list[str]) -> View | None:
    """Return a node's perspective camera, which looks down its -z, y up; None if the node has no camera, or an
    orthographic camera, which is noted. Raises SceneFileError."""
    if "camera" not in node:
        return None
    camera = gltf.entry("cameras", node["camera"], "a node")
    place = f"cameras[{node['camera']}]"
    if camera.get("type") != "perspective":
        notes.append(f"{place} is ignored: not a perspective camera")
        return None
    lens = gltf.child(camera, "perspective", place)
    fov, near = (gltf.number(lens, key, place, 0.0) for key in ("yfov", "znear"))
    far = gltf.number(lens, "zfar", place, near * FAR)
    back, up, eye = model[:3, 2], model[:3, 1], model[:3, 3]
    length = np.linalg.norm(back)
    if not (0.01 < fov < 3.1 and 0 < near < far) or length == 0 or np.linalg.norm(np.cross(up, back)) == 0:
        needs = "an angle of 0.01 to 3.1, 0 < znear < zfar and a nonzero scale"
        raise gltf.error(place, f"is not a valid camera, which needs {needs}")
    return View(_colour(eye), _colour(eye - back / length), float(np.degrees(fov)), near, far, _colour(up))
