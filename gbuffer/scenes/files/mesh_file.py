"""Contents of mesh files as read: meshes, their placement, their materials and a camera."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from ..mesh import Mesh, joined, smooth_normals
from ..metal_rough import MetalRough
from ..scene import Light, Material, View
from .source import SceneFileError, checked_indices, checked_numbers

# Of a normal or tangent that says no direction.
NOTHING = 1e-12


@dataclass(frozen=True)
class Rounding:
    """The coarseness of stored normals.

    Attributes:
        most: number of steps from 0 to 1: 127 for signed 8 bits, 127.5 for unsigned 8 bits that represent [-1, 1].
        is_octahedral: whether the numbers are an octahedral code, and not x, y and z.
    """

    most: float
    is_octahedral: bool = False


@dataclass(frozen=True, eq=False)
class Stored:
    """A mesh as a file stores it, unchecked.

    Attributes:
        place: its place in the file, for messages.
        positions: (vertices, 3).
        corners: vertex indices: (triangles, 3) for triangles, (points, 1) for points.
        normals: (vertices, 3), of any length; None if the file has no normals.
        uv, tangents, second_uv: as in `Mesh`; tangents are as in `Mesh.authored`, but of any length.
        roundings: the rounding of the normals, if the file defines it.
    """

    place: str
    positions: np.ndarray
    corners: np.ndarray
    normals: np.ndarray | None = None
    uv: np.ndarray | None = None
    tangents: np.ndarray | None = None
    second_uv: np.ndarray | None = None
    roundings: tuple[Rounding, ...] = ()


@dataclass(frozen=True)
class Piece:
    """One instance of a mesh.

    Attributes:
        mesh: the mesh in its own space; pieces with the same mesh share it.
        model: (4, 4), matrix to world space for column vectors, of any scale and handedness.
        material: index into the file's materials.
    """

    mesh: Mesh
    model: np.ndarray
    material: int

    def baked(self) -> Mesh:
        """The mesh in world space."""
        return self.mesh.placed(self.model[:3, :3].T, self.model[:3, 3])

    @property
    def is_rigid(self) -> bool:
        """Whether `model` consists of rotation, uniform scale and translation, as the renderer's instances must."""
        linear = self.model[:3, :3]
        square = linear @ linear.T
        scale = np.trace(square) / 3
        return bool(np.linalg.det(linear) > 0 and np.allclose(square, scale * np.eye(3), atol=1e-9 * scale, rtol=0))


@dataclass(frozen=True)
class MeshFile:
    """The contents of a mesh file.

    Attributes:
        path: the file's path.
        pieces: the instances of its meshes; at least one.
        materials, two_sided: the pieces' materials, and whether the back of each material is drawn.
        view: the file's own camera; None if it has no camera.
        notes: notes on data that were ignored or had to be made up, each in a few words.
        lights: the file's own lights, a sun first; empty if it has no lights.
    """

    path: Path
    pieces: tuple[Piece, ...]
    materials: tuple[Material, ...] | tuple[MetalRough, ...]
    two_sided: tuple[bool, ...]
    view: View | None
    notes: tuple[str, ...]
    lights: tuple[Light, ...] = ()

    @property
    def is_metal_rough(self) -> bool:
        """Whether the file's materials are metallic-roughness and not Blinn-Phong."""
        return isinstance(self.materials[0], MetalRough)

    @cached_property
    def baked(self) -> Mesh:
        """All pieces in world space, joined into one mesh."""
        return joined([piece.baked() for piece in self.pieces])

    @cached_property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The minimum and the maximum corner of everything that is drawn, in world space, (3,) each."""
        return self.drawn.min(axis=0), self.drawn.max(axis=0)

    @cached_property
    def radius(self) -> float:
        """Radius of the sphere around the centre of `bounds` that contains everything that is drawn."""
        low, high = self.bounds
        return float(np.linalg.norm(self.drawn - (low + high) / 2, axis=1).max())

    @cached_property
    def drawn(self) -> np.ndarray:
        """The vertices of all triangles in world space, (vertices, 3), without vertices that no triangle uses."""
        return self.baked.positions[np.unique(self.baked.triangles)]


def of_one_mesh(path: Path, mesh: Mesh, notes: Iterable[str]) -> MeshFile:
    """Return a `MeshFile` with one mesh, in a grey material that is visible from both sides."""
    return MeshFile(path, (Piece(mesh, np.eye(4), 0),), (Material(),), (True,), None, tuple(notes))


def mesh_of(path: Path, stored: Stored) -> tuple[Mesh, list[str]]:
    """Return the mesh that a file stores, and notes on data that had to be made up; no notes if the data are
    complete.

    Normals are scaled to unit length; smooth normals replace normals that are missing or have zero length. Triangles
    with zero area are left out.

    Raises:
        SceneFileError: an index is out of range, a number is not valid, or no triangle is left.
    """
    place, normals, tangents = stored.place, stored.normals, stored.tangents
    positions = checked_numbers(path, np.asarray(stored.positions, np.float64), f"{place}: the position")
    triangles = checked_indices(path, np.asarray(stored.corners, np.int64), len(positions), place).reshape(-1, 3)
    corners = positions[triangles]
    triangles = triangles[np.any(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) != 0, axis=1)]
    if not len(triangles):
        raise SceneFileError(f"{path}: {place}: no triangle has an area; export it as triangles")
    notes = [] if normals is not None else ["meshes without normals: smooth normals were generated"]
    given = np.zeros_like(positions) if normals is None else np.asarray(normals, np.float64)
    has_normals = normals is not None
    normals, smooth_count = _completed_normals(
        checked_numbers(path, given, f"{place}: the normal"), positions, triangles
    )
    if smooth_count and has_normals:
        notes.append("normals of zero length: replaced by smooth normals")
    uv, second_uv = (
        None if given is None else checked_numbers(path, np.asarray(given, np.float64), f"{place}: the uv")
        for given in (stored.uv, stored.second_uv)
    )
    mesh = Mesh(positions, normals, triangles, np.zeros((len(positions), 2)) if uv is None else uv, second_uv=second_uv)
    return (mesh if tangents is None else replace(mesh, authored=_tangents(path, place, tangents))), notes


def _completed_normals(normals: np.ndarray, positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, int]:
    """Return unit normals, with smooth normals in place of normals of zero length, and the number of normals replaced
    at vertices that triangles use."""
    length = np.linalg.norm(normals, axis=1)
    lost = length < NOTHING
    normals = normals / np.where(lost, 1.0, length)[:, None]
    if lost.any():
        normals[lost] = smooth_normals(positions, triangles)[lost]
        # What is left belongs to no triangle, or to some that cancel each other: any direction will do.
        normals[np.linalg.norm(normals, axis=1) < 0.5] = (0.0, 0.0, 1.0)
    used = np.zeros(len(positions), bool)
    used[triangles] = True
    return normals, int((lost & used).sum())


def _tangents(path: Path, place: str, tangents) -> np.ndarray | None:
    """Return unit tangents with signs of 1 or -1, (vertices, 4); None if any tangent has zero length, so that all
    tangents are derived from the uv instead. Raises SceneFileError."""
    tangents = checked_numbers(path, np.asarray(tangents, np.float64), f"{place}: the tangent")
    length = np.linalg.norm(tangents[:, :3], axis=1, keepdims=True)
    if (length < NOTHING).any():
        return None
    return np.concatenate([tangents[:, :3] / length, np.where(tangents[:, 3:] < 0, -1.0, 1.0)], axis=1)


def checked_pieces(path: Path, pieces: Iterable[Piece], notes: list[str]) -> tuple[Piece, ...]:
    """Return the pieces that can be visible; a piece with zero scale is left out and noted.

    Raises:
        SceneFileError: no piece is left, or a piece is moved beyond 1e15.
    """
    kept = []
    for piece in pieces:
        linear = piece.model[:3, :3]
        size = np.abs(linear).max()
        if size == 0 or abs(np.linalg.det(linear / size)) < 1e-9:
            notes.append("a node with zero scale was skipped")
            continue
        kept.append(piece)
        reach = np.abs(piece.mesh.positions).max() * size * 3 + np.abs(piece.model[:3, 3]).max()
        if not reach < 1e15:
            raise SceneFileError(f"{path}: a node moves its mesh beyond 1e15; apply the transforms in the exporter")
    if not kept:
        raise SceneFileError(f"{path}: nothing to draw: no mesh of triangles; export meshes with the scene")
    return tuple(kept)
