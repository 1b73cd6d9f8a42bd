"""The vertex normals of a mesh as a set: in object space, as in vertex buffers, without a camera."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....encodings.codecs.files import called
from ....gbuffer.scenes.files.mesh_file import NOTHING, Rounding, Stored
from ....gbuffer.scenes.files.read import MESHES
from ....gbuffer.scenes.files.source import TOO_LARGE, checked_indices
from ...ground.choose import PART, VERTICES, whole_file_of
from ...ground.output.errors import UsageError
from ..scenes.mesh_files import read_or_refused
from .normal_sets import OBJECT, NormalSet, from_arrays
from .own_errors import FINE, all_roundings, bits_text, own_error_deg, own_error_note

# What such a set is called by: mesh.glb#vertices.
ENDINGS = tuple(f"{ending}{PART}{VERTICES}" for ending in MESHES)


# Files whose normals may be rounded so that it is worth to read them once more for it.
MAY_BE_ROUNDED = (".glb", ".gltf", ".ply")


@dataclass(frozen=True)
class OwnRounding:
    """The rounding of a file's normals.

    Attributes:
        roundings: all roundings of the file's meshes.
        error_deg: the mean angle by which the roundings have rotated the vertex normals; None if it is unknown.
    """

    roundings: tuple[Rounding, ...]
    error_deg: float | None

    @property
    def notes(self) -> list[str]:
        """Remarks on the rounding; empty if the error is unknown or smaller than that of any 24-bit encoding."""
        own = self.error_deg
        if own is None or own < FINE:
            return []
        return [own_error_note(f"its vertex normals have {bits_text(self.roundings)} and", own)]


@dataclass(frozen=True, eq=False)
class Vertices:
    """The vertices in a file.

    Attributes:
        normals: the object-space unit normals of distinct vertices, of shape (count, 3), where they have a direction.
        zero, not_finite: the number of finite normals without a direction, and of normals that are NaN or infinite.
        own: the rounding of the file's normals.
        notes: remarks on vertices and meshes that were left out.
    """

    normals: np.ndarray
    zero: int
    not_finite: int
    own: OwnRounding
    notes: tuple[str, ...]


def check_part(word: str) -> None:
    """Raise UsageError if the text after a mesh file's name is not a known part."""
    file, mark, part = word.rpartition(PART)
    if mark and part != VERTICES and Path(file).suffix.lower() in MESHES:
        raise UsageError(f"{word}: unknown part {part!r} of a mesh file; known: {file}{PART}{VERTICES}")


def vertex_set(path: Path) -> tuple[NormalSet, list[str]]:
    """Return the vertex normals of a mesh file, and remarks on them. Raises UsageError."""
    file = Path(whole_file_of(str(path)))
    vertices = vertices_of(file)
    lost = vertices.zero + vertices.not_finite
    name = f"{called(file.name)}{PART}{VERTICES}"
    # What does not count stands at the end: it is counted as pixels of a frame are.
    n = np.concatenate([vertices.normals, np.zeros((lost, 3))]).astype(np.float32)
    covered = np.arange(len(n)) < len(vertices.normals)
    ahead = np.broadcast_to(np.array([0, 0, -1], np.float32), n.shape)
    normal_set = from_arrays(
        name, f"vertex normals of {called(file.name)}", n, ahead, covered, None, vertices.not_finite or None
    )
    return replace(normal_set, code_space=OBJECT, own_error_deg=vertices.own.error_deg), [
        *vertices.notes,
        *vertices.own.notes,
    ]


def drawn_error(path: Path) -> tuple[float, list[str]]:
    """Return the mean error of a mesh file's vertex normals in degrees (0 if it is unknown), and remarks on it.
    Normals interpolated between vertices have a smaller error if the vertices' errors differ in direction.

    Raises UsageError.
    """
    all_meshes = _said(path) if path.suffix.lower() in MAY_BE_ROUNDED else []
    meshes = [mesh for mesh in all_meshes if mesh.normals is not None]
    own = _own_rounding(_all_used(path, meshes), meshes)
    return own.error_deg or 0.0, own.notes


def vertices_of(path: Path) -> Vertices:
    """Return the distinct vertices that triangles or points in a mesh file use. Raises UsageError."""
    all_meshes = _said(path)
    meshes = [mesh for mesh in all_meshes if mesh.normals is not None]
    if not meshes:
        raise UsageError(f"{path}: no vertex normals in it; export it with normals")
    used = _all_used(path, meshes)
    rows = np.concatenate(used)
    # A vertex may stand in a file several times, as at a seam of its uv.
    _, first = np.unique(rows.view(np.dtype((np.void, rows.itemsize * rows.shape[1])))[:, 0], return_index=True)
    normals = rows[np.sort(first), 3:]
    finite, length = _lengths(normals)
    points = finite & (length >= min(_least(mesh.roundings) for mesh in meshes))
    if not points.any():
        raise UsageError(f"{path}: none of its {len(normals)} vertex normals has a direction; export it with normals")
    zero, not_finite = int((finite & ~points).sum()), int((~finite).sum())
    notes = tuple(_left_out(zero, not_finite, len(all_meshes) - len(meshes)))
    own = _own_rounding(used, meshes)
    return Vertices(normals[points] / length[points, None], zero, not_finite, own, notes)


def _said(path: Path) -> list[Stored]:
    return read_or_refused(lambda: MESHES[path.suffix.lower()](path))


def _all_used(path: Path, meshes: Sequence[Stored]) -> list[np.ndarray]:
    return read_or_refused(lambda: [_used(path, mesh) for mesh in meshes])


def _used(path: Path, stored: Stored) -> np.ndarray:
    """Return the positions and normals of a mesh's used vertices, of shape (count, 6). Raises SceneFileError."""
    corners = np.asarray(stored.corners, np.int64).ravel()
    used = np.unique(checked_indices(path, corners, len(stored.positions), stored.place))
    both = (np.asarray(numbers, np.float64)[used] for numbers in (stored.positions, stored.normals))
    # 0 is added, so that -0 is 0.
    return np.concatenate(list(both), axis=1) + 0.0


def _lengths(normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which normals are finite and have finite squares, and the normals' lengths; both of shape (count,)."""
    with np.errstate(invalid="ignore"):
        finite = np.asarray((np.abs(normals) < TOO_LARGE).all(axis=1))
    return finite, np.linalg.norm(np.where(finite[:, None], normals, 0), axis=1)


def _least(roundings: Sequence[Rounding]) -> float:
    """Return the length below which a normal has no direction. Unsigned integers cannot represent 0: the nearest
    value is half a step away."""
    return max([NOTHING, *(1 / rounding.most for rounding in roundings if not rounding.is_octahedral)])


def _own_rounding(used: Sequence[np.ndarray], meshes: Sequence[Stored]) -> OwnRounding:
    """Return the roundings of all meshes' normals, with the mean error over all vertices, even exact vertices."""
    known_roundings: dict[Rounding, None] = {}
    turned, known = 0.0, False
    for rows, mesh in zip(used, meshes, strict=True):
        finite, length = _lengths(rows[:, 3:])
        points = finite & (length >= _least(mesh.roundings))
        unit = rows[points, 3:] / length[points, None]
        roundings = all_roundings(unit, mesh.roundings)
        own = own_error_deg(unit, roundings)
        known_roundings |= dict.fromkeys(roundings)
        turned, known = turned + len(rows) * (own or 0.0), known or own is not None
    return OwnRounding(tuple(known_roundings), turned / sum(map(len, used)) if known else None)


def _left_out(zero: int, not_finite: int, without: int) -> list[str]:
    parts = [f"{zero} vertex normals of zero length"] * bool(zero)
    parts += [f"{not_finite} NaN or infinite vertex normals"] * bool(not_finite)
    notes = [f"{' and '.join(parts)} are left out"] if parts else []
    return notes + [f"{without} of its meshes have no normals and are left out"] * bool(without)
