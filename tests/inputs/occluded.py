"""Scenes whose ambient occlusion has a closed form, and effects drawn over them."""

from __future__ import annotations

import numpy as np
from drawing import FP32

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import ChosenEffect, chosen
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import Mesh, grid_triangles, grid_uv, plane, sphere
from normalbench.gbuffer.scenes.scene import Material, Scene, ScenePart, View, placed

METHODS = ("ssao", "hbao", "sao", "gtao")
AROUND = np.arange(129) * (2 * np.pi / 128)
FROM_ABOVE = View((0.0, 20.0, 0.0), (0.0, 0.0, 0.0), 14.0, 1.0, 60.0, up=(0.0, 0.0, -1.0))


def plan_of(size: tuple[int, int], layout=FP32) -> Plan:
    return Plan(size, 1, layout, LIGHT_BUFFERS["rgba32f"], 1, False, 1.0)


def effect(text: str) -> ChosenEffect:
    """Return an effect by its name and settings, such as `gtao:slices=4`."""
    name, *settings = text.split(":")
    return chosen(EFFECTS[name], dict(setting.split("=") for setting in settings))


def scene_of_meshes(*meshes: Mesh, view: View = FROM_ABOVE) -> Scene:
    parts = tuple(ScenePart(mesh, placed((0, 0, 0)), np.array([0]), two_sided=True) for mesh in meshes)
    return Scene(parts, (Material(),), (), (1.0, 1.0, 1.0), view, view)


def turned(scene: Scene, rotation: np.ndarray) -> Scene:
    """Return the scene and its camera after one rotation, a (3, 3) matrix for column vectors."""
    whole = np.eye(4)
    whole[:3, :3] = rotation
    view = scene.view
    moved = (tuple(rotation @ np.array(v)) for v in (view.eye, view.target, view.up))
    eye, target, up = moved
    there = View(eye, target, view.fov, view.near, view.far, up)
    parts = tuple(ScenePart(p.mesh, whole @ p.models, p.materials, p.casts, p.two_sided) for p in scene.parts)
    return Scene(parts, scene.materials, (), scene.ambient, there, there)


def drawn_effect(gl, scene: Scene, text: str, size: tuple[int, int], resource=None, pipeline="deferred", layout=FP32):
    """Return an effect's result or another of its resources, (height, width) or (height, width, channels), and the
    G-buffer's positions and directions."""
    method = effect(text)
    with rendering(gl, PIPELINES[pipeline].with_effect(method.passes()), scene, plan_of(size, layout)) as drawing:
        drawing.draw()
        position, direction, *_ = drawing.gbuffer()
        return np.squeeze(drawing.read(resource or method.effect.result)[0]), position, direction


# Of a point in the middle of a level floor, the radius of a ball or a hole, and how far or deep it is.


def floor() -> Mesh:
    return plane(40.0, 40.0)


def ball(radius: float, x: float, y: float) -> Mesh:
    return sphere(radius, 192, 96).placed(np.eye(3), (x, y, 0))


def _sweep(radii, heights, outwards, up) -> Mesh:
    """Return the surface that a line from one radius and height to another sweeps as it turns about the axis."""
    cos, sin = np.cos(AROUND), np.sin(AROUND)
    rows = [np.stack([r * cos, 0 * cos + h, r * sin], axis=1) for r, h in zip(radii, heights, strict=True)]
    normals = np.tile(np.stack([outwards * cos, 0 * cos + up, outwards * sin], axis=1), (2, 1))
    return Mesh(np.concatenate(rows), normals, grid_triangles(1, len(AROUND) - 1), grid_uv(1, len(AROUND) - 1))


def pit(radius: float, height: float) -> tuple[Mesh, Mesh, Mesh]:
    """Return a floor under a round hole in a slab, with the hole's wall."""
    return (
        floor(),
        _sweep((radius, radius), (0.0, height), -1.0, 0.0),
        _sweep((radius, 20.0), (height, height), 0.0, 1.0),
    )


def disc(radius: float, height: float) -> Mesh:
    """Return a level disc over the middle of the floor."""
    return _sweep((0.0, radius), (height, height), 0.0, -1.0)


def pillar(radius: float, x: float, height: float) -> Mesh:
    """Return a pillar from the floor to the widest part of a ball."""
    return _sweep((radius, radius), (0.0, height), 1.0, 0.0).placed(np.eye(3), (x, 0, 0))


def by_ball(radius: float, x: float, y: float) -> float:
    """Return V at the middle of the floor for a ball entirely above it: 1 - cos t (R / D)^2."""
    distance = np.hypot(x, y)
    return 1 - y / distance * (radius / distance) ** 2


def by_dome(radius: float, x: float) -> float:
    """Return V for half a ball on the floor: with sin a = R / D, 1 - (a - sin a cos a) / pi."""
    a = np.arcsin(radius / x)
    return 1 - (a - np.sin(a) * np.cos(a)) / np.pi


def by_pit(radius: float, height: float) -> float:
    """Return V at the bottom of a pit: R^2 / (R^2 + h^2), the share that a disc over the pit's mouth would block."""
    return radius**2 / (radius**2 + height**2)


CLOSED = {
    "ball overhead": ((floor(), ball(0.5, 0.0, 2.0)), by_ball(0.5, 0.0, 2.0)),
    "ball at 37 degrees": ((floor(), ball(0.5, 1.5, 2.0)), by_ball(0.5, 1.5, 2.0)),
    "ball on the floor": ((floor(), ball(0.5, 1.0, 0.5)), by_ball(0.5, 1.0, 0.5)),
    "near ball on the floor": ((floor(), ball(0.5, 0.6, 0.5)), by_ball(0.5, 0.6, 0.5)),
    "disc": ((floor(), disc(1.0, 0.7)), 1 - 1.0 / (1.0 + 0.7**2)),
    "dome": ((floor(), ball(0.5, 1.0, 0.0)), by_dome(0.5, 1.0)),
    "near dome": ((floor(), ball(0.9, 1.1, 0.0)), by_dome(0.9, 1.1)),
    "shallow pit": (pit(1.0, 0.5), by_pit(1.0, 0.5)),
    "deep pit": (pit(1.0, 1.0), by_pit(1.0, 1.0)),
}
# Of these hardly anything is open behind what a camera above sees: a method that knows one depth a pixel can be exact.
SOLID = ("ball on the floor", "dome", "near dome", "shallow pit", "deep pit")
