"""Users' mesh files as scenes: a camera that frames the meshes, lights around them and the surfaces that it sees."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ...environment.catalogue import ENVIRONMENTS
from ..mesh import facing, joined
from ..rasterise import Camera, Rendered, rasterise
from ..sampled import COARSENED, coarser, cut_out, mapped_normals
from ..scene import Light, Scene, ScenePart, View
from ..setting import Setting, coloured
from .gltf import gltf_meshes, read_gltf
from .mesh_file import MeshFile, Piece, Stored
from .obj import obj_meshes, read_obj
from .ply import ply_meshes, read_ply

READERS: Mapping[str, Callable[[Path], MeshFile]] = MappingProxyType(
    {
        ".glb": read_gltf,
        ".gltf": read_gltf,
        ".obj": read_obj,
        ".ply": read_ply,
    }
)
# What files say of their meshes, before anything is made up for a picture.
MESHES: Mapping[str, Callable[[Path], list[Stored]]] = MappingProxyType(
    {
        ".glb": gltf_meshes,
        ".gltf": gltf_meshes,
        ".obj": obj_meshes,
        ".ply": ply_meshes,
    }
)
FRAMES = 1
# From where a scene without a camera is seen: right of it, a little above, in front.
ASIDE = (0.45, 0.35, 1.0)
FOV = 40.0
MARGIN = 1.05
SUN = (-0.5, -0.7, -0.5)
AMBIENT = (0.05, 0.05, 0.06)
# What metal/rough meshes reflect where nothing is said.
AROUND = "studio"


def read_mesh_file(path: Path) -> MeshFile:
    """Read a file of one of the formats in READERS, chosen by its extension. Raises SceneFileError."""
    return READERS[path.suffix.lower()](path)


def file_view(file: MeshFile) -> View:
    """Return the file's camera or, without one, a camera from the side that shows everything in an image at least as
    wide as high."""
    if file.view:
        return file.view
    low, high = file.bounds
    middle = _float_triple((low + high) / 2)
    away = np.array(ASIDE) / np.linalg.norm(ASIDE)
    placed = file.drawn - middle
    across = View(_float_triple(away), (0.0, 0.0, 0.0), FOV, 0.0, 0.0).matrix()[:2, :3]
    nearer = placed @ away
    # How far away the eye must be for each vertex to lie within the angle of view.
    needed = nearer[:, None] + abs(placed @ across.T) / np.tan(np.radians(FOV / 2))
    distance = MARGIN * float(needed.max())
    near, far = distance - float(nearer.max()), distance - float(nearer.min())
    return View(_float_triple(middle + away * distance), middle, FOV, 0.9 * near, 1.1 * far)


def _float_triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z


def file_scene(file: MeshFile, setting: Setting) -> Scene:
    """Return the scene of a file's meshes, with the file's own lights or, if it has no lights, a sun.
    Metallic-roughness surfaces are also lit by an environment, other surfaces of a file without lights by
    `setting.lights` point lights."""
    view = file_view(file)
    aside = 0.01 * file.radius
    moved = (_float_triple(np.add(point, (aside, 0.0, 0.0))) for point in (view.eye, view.target))
    eye, target = moved
    return Scene(
        parts=_parts(file),
        materials=file.materials,
        lights=file.lights or _made_up_lights(file, setting),
        ambient=AMBIENT,
        view=view,
        previous=replace(view, eye=eye, target=target),
        environment=ENVIRONMENTS[AROUND].make() if file.is_metal_rough else None,
    )


def _parts(file: MeshFile) -> tuple[ScenePart, ...]:
    """Return the parts: meshes placed by rotation and uniform scale as instances, other meshes in world space."""
    rigid: dict[tuple[int, bool], list[Piece]] = {}
    parts = []
    for piece in file.pieces:
        two_sided = file.two_sided[piece.material]
        if piece.is_rigid:
            rigid.setdefault((id(piece.mesh), two_sided), []).append(piece)
        else:
            parts.append(
                ScenePart(piece.baked(), np.eye(4)[None], _material_indices(file, [piece]), two_sided=two_sided)
            )
    for (_, two_sided), pieces in rigid.items():
        models = np.stack([piece.model for piece in pieces])
        parts.append(ScenePart(pieces[0].mesh, models, _material_indices(file, pieces), two_sided=two_sided))
    return tuple(parts)


def _material_indices(file: MeshFile, pieces: list[Piece]) -> np.ndarray:
    return np.array([piece.material % len(file.materials) for piece in pieces])


def _made_up_lights(file: MeshFile, setting: Setting) -> tuple[Light, ...]:
    """Return a sun and, for materials that are not metallic-roughness, point lights that circle around the scene's
    centre, in a box about 1.5 times as large as the scene's."""
    direction = np.array(SUN) / np.linalg.norm(SUN)
    sun = Light("sun", (0.8, 0.77, 0.7), direction=_float_triple(direction))
    if file.is_metal_rough:
        return (sun,)
    rng = np.random.default_rng(setting.seed)
    low, high = file.bounds
    middle, half = (low + high) / 2, np.maximum(0.75 * (high - low), 0.3 * file.radius)
    turn = 2 * np.pi * (setting.time + rng.uniform(0, 1, setting.lights))
    out, height = np.sqrt(rng.uniform(0.3, 1, setting.lights)), rng.uniform(-0.3, 1, setting.lights)
    around = np.stack([out * np.cos(turn), height, out * np.sin(turn)], axis=1)
    colours = coloured(rng, setting.lights, 5.0 / np.sqrt(max(setting.lights, 1)))
    lamps = [
        Light("point", tuple(colour), _float_triple(place), 0.9 * file.radius)
        for colour, place in zip(colours, middle + around * half, strict=True)
    ]
    return (sun, *lamps)


@dataclass(frozen=True)
class SeenMesh(Rendered):
    """A mesh file as a camera sees it.

    Attributes:
        map_error_deg: estimated mean error, in degrees over all visible normals, from the rounding of 8-bit normal
            maps; None if no map has 8 bits.
    """

    map_error_deg: float | None


def seen(file: MeshFile, size: tuple[int, int]) -> SeenMesh:
    """Return the view-space normals, positions and coverage of an image of a mesh file, drawn without an OpenGL
    driver.

    A pixel's normal comes from its material's normal map, if it has one. Points that a material cuts out are holes.
    The back of a surface is drawn if its material is two-sided.
    """
    view = file_view(file)
    matrix = view.matrix()
    pieces = [piece.baked().placed(matrix[:3, :3].T, matrix[:3, 3]) for piece in file.pieces]
    drawn = [mesh if file.two_sided[p.material] else facing(mesh) for p, mesh in zip(file.pieces, pieces, strict=True)]
    camera = Camera(*size, view.fov, view.near, view.far)
    made_of = [(mesh, file.materials[p.material]) for mesh, p in zip(drawn, file.pieces, strict=True)]
    rendered = rasterise(joined(drawn), camera, cut_out(made_of))
    mapped = mapped_normals(rendered, camera, made_of)
    rougher = coarser(made_of)
    off = None
    if rougher and rendered.covered.any():
        other = mapped_normals(rendered, camera, rougher)[rendered.covered].astype(np.float64)
        apart = np.linalg.norm(mapped[rendered.covered] - other, axis=1)
        off = float(np.degrees(2 * np.arcsin(np.minimum(apart / 2, 1))).mean()) / COARSENED
    return SeenMesh(mapped, rendered.positions, rendered.covered, rendered.triangle, off)
