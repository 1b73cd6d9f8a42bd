"""Sets of tangent frames to measure: random rotations, and the vertices of users' meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ....encodings.codecs.files import called
from ....encodings.rotation import rotated_frame
from ....encodings.vec import Vec4
from ....gbuffer.scenes.files.read import READERS
from ....gbuffer.scenes.mesh import Mesh, tangents
from ...ground.choose import choose_or_read
from ...ground.options.words import Names
from ...subjects.scenes.mesh_files import mesh_file, say_notes

CHUNK = 2**16


@dataclass(frozen=True, eq=False)
class Frames:
    """Tangent frames.

    Attributes:
        normals: (count, 4), with the handedness, 1 or -1, as the fourth component.
        tangents: (count, 4), with 0 as the fourth component.
    """

    normals: np.ndarray
    tangents: np.ndarray


@dataclass(frozen=True)
class FrameSet:
    """A set of tangent frames, made chunk by chunk.

    Attributes:
        name: the catalogue's key, or a file's name.
        count: number of frames.
        seed: the seed with which the set was made.
        is_uniform: whether it covers all frames evenly.
        chunk: returns the chunk that starts at an index: CHUNK frames in float32, or fewer at the end.
    """

    name: str
    count: int
    seed: int
    is_uniform: bool
    chunk: Callable[[int], Frames]

    @property
    def starts(self) -> range:
        """The start index of each chunk."""
        return range(0, self.count, CHUNK)

    def chunks(self) -> Iterator[Frames]:
        """Return an iterator over the frames, one chunk at a time."""
        return map(self.chunk, self.starts)


def rotations(count: int, seed: int) -> FrameSet:
    """Return a set of random rotations, uniform by Haar's measure (K. Shoemake, Uniform Random Rotations, Graphics
    Gems III, 1992). On average, half of the frames are left-handed."""

    def chunk(start: int) -> Frames:
        random = np.random.default_rng([seed, start])
        some = min(count - start, CHUNK)
        u, (a, b) = random.random(some), 2 * np.pi * random.random((2, some))
        low, high = np.sqrt(1 - u), np.sqrt(u)
        q = Vec4(low * np.sin(a), low * np.cos(a), high * np.sin(b), high * np.cos(b))
        frame = rotated_frame(q, np.where(random.random(some) < 0.5, -1.0, 1.0))
        return frames_from(np.stack(frame.normal, axis=1), np.stack([*frame.tangent, frame.hand], axis=1))

    return FrameSet("rotations", count, seed, True, chunk)


def frames_from(normals: np.ndarray, with_hands: np.ndarray) -> Frames:
    """Return frames from unit normals (count, 3) and from tangents with the sign of the bitangent (count, 4), as in
    glTF.

    Tangents are made orthogonal to the normal; a tangent parallel to the normal is replaced by an orthogonal
    direction.
    """
    across = with_hands[:, :3] - normals * np.sum(normals * with_hands[:, :3], axis=1, keepdims=True)
    lost = np.linalg.norm(across, axis=1) < 1e-9
    across[lost] = np.cross(normals[lost], np.eye(3)[np.argmin(abs(normals[lost]), axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    hands = with_hands[:, 3:]
    arrays = (np.concatenate(parts, axis=1).astype(np.float32) for parts in ((normals, hands), (across, 0 * hands)))
    return Frames(*arrays)


FRAME_SETS: Mapping[str, Callable[[int, int], FrameSet]] = MappingProxyType({"rotations": rotations})


def frame_sets_named(names: Names, count: int, seed: int) -> list[FrameSet]:
    """Return the frame sets with these names: sets from the catalogue, or the vertices of mesh files.

    Raises:
        UsageError: an unknown name, or a file that cannot be read.
    """
    notes: dict[Path, tuple[str, ...]] = {}

    def read(path: Path) -> Callable[[int, int], FrameSet]:
        file = mesh_file(path)
        notes[path] = file.notes
        frame_set = mesh_frames(called(path.name), [piece.baked() for piece in file.pieces])
        return lambda *_: frame_set

    sets = [make(count, seed) for make in choose_or_read("frame set", names, FRAME_SETS, tuple(READERS), read)]
    say_notes(notes)
    return sets


def _as_in_files(mesh: Mesh) -> np.ndarray:
    """Return a mesh's tangents and hands for `frames_from`; the bitangents of authored tangents point against v."""
    return tangents(mesh) * (1.0, 1.0, 1.0, 1.0 if mesh.authored is None else -1.0)


def mesh_frames(name: str, meshes: list[Mesh]) -> FrameSet:
    """Return the frames at all vertices as a set, with authored tangents or else the direction of increasing u."""
    normals, with_hands = (
        np.concatenate(parts) for parts in zip(*((m.normals, _as_in_files(m)) for m in meshes), strict=True)
    )
    whole = frames_from(normals, with_hands)

    def chunk(start: int) -> Frames:
        part = slice(start, start + CHUNK)
        return Frames(whole.normals[part], whole.tangents[part])

    return FrameSet(name, len(normals), 0, False, chunk)
