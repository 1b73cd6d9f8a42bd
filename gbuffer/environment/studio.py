"""A photographer's studio: a dark room with soft boxes, strips of light and a wall with a fine grid."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from .made import drawn, mixed, rises

TITLE = "a dark room with soft boxes, thin strips and a fine grid, which shows banding in reflections"

# Half of the room's sides, in metres, seen from its middle.
ROOM = np.array([3.0, 2.0, 3.0])
WALL, CORNER, FLOOR = np.array([0.055, 0.055, 0.06]), np.array([0.02, 0.02, 0.022]), np.array([0.09, 0.088, 0.085])
LINES = np.array([0.7, 0.72, 0.75])
# Of the grid, in metres: the distance of its lines, and their width between the middles of their soft edges.
MESH, LINE = 0.25, 0.04
# Its wall, behind a viewer who looks along -z: so reflections show it.
GRID = (2, 1)


@dataclass(frozen=True)
class Panel:
    """A lamp on a wall.

    Attributes:
        axis, side: the wall: 0, 1, 2 for x, y, z, and -1 or 1.
        middle, half: centre and half size along the wall's other two axes, in metres.
        edge: width of the border in which its light fades, in metres.
        light: linear colour at its centre.
    """

    axis: int
    side: int
    middle: tuple[float, float]
    half: tuple[float, float]
    edge: float
    light: tuple[float, float, float]


PANELS = (
    # Two overhead, and one to each side: warm and cool.
    Panel(1, 1, (0.0, 0.9), (1.3, 0.75), 0.3, (12, 11.8, 11.4)),
    Panel(1, 1, (0.0, -1.4), (1.8, 0.22), 0.1, (9, 9.2, 9.6)),
    Panel(0, -1, (0.25, 0.3), (1.1, 1.3), 0.45, (7.5, 6.9, 6.0)),
    Panel(0, 1, (0.3, 0.9), (1.3, 0.3), 0.12, (8, 9, 10.5)),
    # Thin tubes, upright at the grid's sides and level on the wall across.
    *(Panel(2, 1, (x, 0.35), (0.05, 1.2), 0.03, (20, 20, 20)) for x in (-2.4, -2.0, 2.0, 2.4)),
    *(Panel(2, -1, (0.0, y), (2.0, 0.04), 0.03, (14, 14.5, 15)) for y in (0.3, 0.75, 1.2)),
)


@functools.cache
def studio() -> np.ndarray:
    """Return the radiance, (256, 512, 3), float32, from 0.02 to 15. Tubes of 20 are narrower than two texels."""
    return drawn(_light)


def _light(towards: np.ndarray) -> np.ndarray:
    reached = np.abs(towards) / ROOM
    nearest = np.maximum(np.maximum(reached[..., 0], reached[..., 1]), reached[..., 2])
    place = towards / nearest[..., None]
    light = _walls(place)
    for axis, side in sorted({(panel.axis, panel.side) for panel in PANELS}):
        there = (reached[..., axis] == nearest) & (towards[..., axis] * side > 0)
        if there.any():
            light[there] = _with_lamps(light[there], (axis, side), np.delete(place[there], axis, axis=-1))
    return light


def _with_lamps(light: np.ndarray, wall: tuple[int, int], across: np.ndarray) -> np.ndarray:
    """Return the light of a wall, (count, 3), with its lamps and grid, at positions along the wall's two axes."""
    if wall == GRID:
        light = mixed(light, LINES, _grid(across))
    for panel in PANELS:
        if (panel.axis, panel.side) == wall:
            inside = np.array(panel.half) - np.abs(across - panel.middle)
            # Brightest in its middle.
            light = mixed(light, np.array(panel.light, np.float64), rises(inside, 0, panel.edge).prod(-1))
    return light


def _walls(place: np.ndarray) -> np.ndarray:
    """Return the colours of the walls at these points, (count, 3): darker in corners, lighter towards the floor."""
    x, y, z = np.moveaxis(np.abs(place) / ROOM, -1, 0)
    second = np.maximum(np.minimum(x, y), np.minimum(np.maximum(x, y), z))
    floor = mixed(WALL, FLOOR, rises(-place[..., 1], 1.4, 2.0))
    return mixed(floor, CORNER, rises(second, 0.3, 1.0))


def _grid(across: np.ndarray) -> np.ndarray:
    """Return the share, 0 to 1, of the grid's light lines at positions along the wall's two axes, (count, 2)."""
    distance = np.abs((across + MESH / 2) % MESH - MESH / 2).min(-1)
    is_there = (np.abs(across[:, 0]) < 1.5 + LINE / 2) & (across[:, 1] > -1.27)
    return is_there * (1 - rises(distance, LINE / 4, 3 * LINE / 4))
