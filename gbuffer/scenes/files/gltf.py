"""glTF 2.0 and GLB files: meshes with their own normals and tangents under their nodes' transforms, plain materials,
the first camera.

A node's transform goes to its vertices as it stands: mirrored and of three scales if need be, normals by the inverse
transpose, tangents as positions.

Read here and not by trimesh (5.2), which drops tangents, gives a mirrored mesh no normals of the file's, and takes
indices that are out of range and nodes that are their own ancestors.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..mesh import Mesh
from ..scene import Material, View
from .gltf_data import Gltf, Object
from .mesh_file import MeshFile, Piece, checked_pieces, mesh_of
from .source import MAX_TRIANGLES, checked_indices, checked_size

TRIANGLES, STRIP, FAN = 4, 5, 6
ATTRIBUTES = {"NORMAL": 3, "TANGENT": 4, "TEXCOORD_0": 2}
# Cameras without a far plane see this many times as far as their near plane.
FAR = 1e5
# Specular reflectance of anything but metal, seen straight on.
DIELECTRIC = 0.04


def read_gltf(path: Path) -> MeshFile:
    """The default scene of a glTF or GLB file.

    Raises:
        SceneFileError: it is damaged, too large, needs an extension that is not read, names a file outside its folder,
            or has no triangles.
    """
    gltf = Gltf(path)
    nodes = list(_placed_nodes(gltf))
    notes = list(gltf.notes)
    _check_sizes(gltf, nodes)
    meshes: dict[int, list[tuple[Mesh, int]]] = {}
    pieces = []
    for node, model in nodes:
        if "mesh" in node:
            index = node["mesh"]
            mesh = gltf.entry("meshes", index, "a node")
            if index not in meshes:
                meshes[index] = list(_primitives(gltf, mesh, f"meshes[{index}]", notes))
            pieces += [Piece(made, model, material) for made, material in meshes[index]]
    materials = [_material(gltf, index) for index in range(len(gltf.list_of(gltf.json, "materials", "the file")))]
    view = next((v for node, model in nodes if (v := _camera(gltf, node, model, notes))), None)
    return MeshFile(
        path,
        checked_pieces(path, pieces, notes),
        # A primitive without a material has the last.
        (*(material for material, _ in materials), Material()),
        (*(two_sided for _, two_sided in materials), False),
        view,
        tuple(dict.fromkeys(notes)),
    )


def _children(gltf: Gltf, index: int) -> list[int]:
    place = f"nodes[{index}]"
    children = gltf.list_of(gltf.entry("nodes", index, "the scene"), "children", place)
    for child in children:
        gltf.entry("nodes", child, f"{place}.children")
    return children


def _checked_tree(gltf: Gltf) -> list[int]:
    """The nodes that are no one's children. Raises SceneFileError where nodes are no trees."""
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
    """Each node of the default scene with its matrix to world space."""
    tops = _checked_tree(gltf)
    if gltf.list_of(gltf.json, "scenes", "the file"):
        scene = gltf.entry("scenes", gltf.json.get("scene", 0), "the file's scene")
        named = gltf.list_of(scene, "nodes", "the scene")
        allowed = set(tops)
        for index in named:
            gltf.entry("nodes", index, "the scene")
            if index not in allowed:
                raise gltf.error("the scene", f"names nodes[{index}] twice, or a child by itself")
            allowed.discard(index)
        tops = named
    waiting = [(index, np.eye(4)) for index in reversed(tops)]
    while waiting:
        index, above = waiting.pop()
        node = gltf.entry("nodes", index, "the scene")
        with np.errstate(over="ignore", invalid="ignore"):
            model = above @ _local(gltf, node, f"nodes[{index}]")
        if not np.all(np.abs(model) < 1e15):
            raise gltf.error(
                f"nodes[{index}]", "is moved or scaled beyond 1e15", "apply the transforms in the exporter"
            )
        yield node, model
        waiting += [(child, model) for child in reversed(_children(gltf, index))]


def _local(gltf: Gltf, node: Object, place: str) -> np.ndarray:
    """A node's own matrix, (4, 4), for column vectors; the file lists it column by column."""
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
    """Raises SceneFileError where all meshes in all their places are more than is read; from headers alone."""
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
    """Vertices and, at most, triangles of a mesh."""
    vertices = triangles = 0
    for number, primitive in enumerate(_of_mesh(gltf, mesh, place)):
        where = f"{place}.primitives[{number}]"
        attributes = gltf.child(primitive, "attributes", where)
        count = gltf.count(attributes.get("POSITION"), f"{where}.POSITION")
        corners = gltf.count(primitive["indices"], f"{where}.indices") if "indices" in primitive else count
        vertices += count
        triangles += corners // 3 if primitive.get("mode", TRIANGLES) == TRIANGLES else corners
    return vertices, triangles


def _of_mesh(gltf: Gltf, mesh: Object, place: str) -> list[Object]:
    primitives = gltf.list_of(mesh, "primitives", place)
    if not all(isinstance(primitive, dict) for primitive in primitives):
        raise gltf.error(f"{place}.primitives", "holds what is not an object")
    return primitives


def _primitives(gltf: Gltf, mesh: Object, place: str, notes: list[str]) -> Iterator[tuple[Mesh, int]]:
    """The triangle meshes of a mesh, each with its material's index."""
    for number, primitive in enumerate(_of_mesh(gltf, mesh, place)):
        where = f"{place}.primitives[{number}]"
        mode = gltf.whole(primitive, "mode", where, TRIANGLES)
        if mode not in (TRIANGLES, STRIP, FAN):
            notes.append("points and lines are not drawn")
            continue
        material = -1
        if "material" in primitive:
            gltf.entry("materials", primitive["material"], where)
            material = primitive["material"]
        made, said = _primitive(gltf, primitive, mode, where)
        notes += said
        yield made, material


def _primitive(gltf: Gltf, primitive: Object, mode: int, where: str) -> tuple[Mesh, list[str]]:
    attributes = gltf.child(primitive, "attributes", where)
    positions = gltf.accessor(attributes.get("POSITION"), 3, f"{where}.POSITION")
    found = {}
    for name, width in ATTRIBUTES.items():
        if name in attributes:
            found[name] = gltf.accessor(attributes[name], width, f"{where}.{name}")
            if len(found[name]) != len(positions):
                raise gltf.error(f"{where}.{name}", f"are {len(found[name])} for {len(positions)} positions")
    corners = (
        gltf.indices(primitive["indices"], f"{where}.indices") if "indices" in primitive else np.arange(len(positions))
    )
    checked_indices(gltf.path, corners, len(positions), f"{where}.indices")
    triangles = _triangles(corners, mode)
    if len(triangles) > MAX_TRIANGLES:
        raise gltf.error(where, f"has {len(triangles)} triangles; the most is {MAX_TRIANGLES}", "export fewer objects")
    normals, uv = found.get("NORMAL"), found.get("TEXCOORD_0")
    # Tangents without normals say nothing (glTF 2.0, 3.7.2.1).
    tangents = found.get("TANGENT") if normals is not None else None
    return mesh_of(gltf.path, where, positions, triangles, normals, uv, tangents)


def _triangles(corners: np.ndarray, mode: int) -> np.ndarray:
    """Triangles of a list, strip or fan of corners, (triangles, 3), all wound one way."""
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    count = max(len(corners) - 2, 0)
    step = np.arange(count)
    if mode == FAN:
        return np.stack([corners[step + 1], corners[step + 2], np.broadcast_to(corners[:1], count)], axis=1)
    odd = step % 2
    return np.stack([corners[step], corners[step + 1 + odd], corners[step + 2 - odd]], axis=1)


def _material(gltf: Gltf, index: int) -> tuple[Material, bool]:
    """A metallic-roughness material as Blinn-Phong, and whether its back is drawn.

    The power is 2 / a^2 - 2, a the square of the roughness (Walter et al. 2007). Where a texture says what is metal,
    nothing is: textures are not read.
    """
    place = f"materials[{index}]"
    data = gltf.entry("materials", index, place)
    pbr = gltf.child(data, "pbrMetallicRoughness", place)
    *base, alpha = np.clip(gltf.numbers(pbr, "baseColorFactor", place, (1.0, 1.0, 1.0, 1.0)), 0.0, 1.0)
    metal, roughness = (
        np.clip(gltf.number(pbr, key, place, 1.0), 0, 1) for key in ("metallicFactor", "roughnessFactor")
    )
    if "metallicRoughnessTexture" in pbr:
        metal = 0.0
    base, a = np.array(base), max(float(roughness) ** 2, 1e-3)
    emissive = np.clip(gltf.numbers(data, "emissiveFactor", place, (0.0, 0.0, 0.0)), 0.0, 1.0)
    made = Material(
        albedo=_colour(base * (1 - metal)),
        specular=_colour(DIELECTRIC + (base - DIELECTRIC) * metal),
        power=float(np.clip(2 / a**2 - 2, 1.0, 2048.0)),
        # Emission that a texture would mask is none.
        emissive=(0.0, 0.0, 0.0) if "emissiveTexture" in data else _colour(emissive),
        alpha=float(alpha) if data.get("alphaMode") == "BLEND" else 1.0,
    )
    return made, data.get("doubleSided") is True


def _colour(values: np.ndarray) -> tuple[float, float, float]:
    r, g, b = map(float, values)
    return r, g, b


def _camera(gltf: Gltf, node: Object, model: np.ndarray, notes: list[str]) -> View | None:
    """A node's perspective camera: it looks down its -z, y up."""
    if "camera" not in node:
        return None
    camera = gltf.entry("cameras", node["camera"], "a node")
    place = f"cameras[{node['camera']}]"
    if camera.get("type") != "perspective":
        notes.append(f"{place} is not perspective: not used")
        return None
    lens = gltf.child(camera, "perspective", place)
    fov, near = (gltf.number(lens, key, place, 0.0) for key in ("yfov", "znear"))
    far = gltf.number(lens, "zfar", place, near * FAR)
    back, up, eye = model[:3, 2], model[:3, 1], model[:3, 3]
    length = np.linalg.norm(back)
    if not (0.01 < fov < 3.1 and 0 < near < far) or length == 0 or np.linalg.norm(np.cross(up, back)) == 0:
        raise gltf.error(place, "is no camera: an angle of 0.01 to 3.1, 0 < znear < zfar, and a scale that is not 0")
    return View(_colour(eye), _colour(eye - back / length), float(np.degrees(fov)), near, far, _colour(up))
