"""Lights of glTF files, by KHR_lights_punctual."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np

from ..scene import Light
from .gltf_data import Gltf, Object
from .mesh_file import Piece

PUNCTUAL = "KHR_lights_punctual"
KINDS: dict[str, Literal["sun", "point", "spot"]] = {"directional": "sun", "point": "point", "spot": "spot"}
# A light without a range reaches this many times as far as the scene does, where its window takes 1 % of it.
REACH = 4.0
# The least angle, in degrees, between the two cones of a spot light.
LEAST_RIM = 0.1
ROUNDED_OFF = "its lights fall off with 1 / (d^2 + 1), not 1 / d^2"


def lights_of(
    gltf: Gltf, nodes: Iterable[tuple[Object, np.ndarray]], pieces: Iterable[Piece], notes: list[str]
) -> tuple[Light, ...]:
    """Return the lights of nodes, a sun first; append a note to `notes` for each difference from the file.

    A light of colour c gives an irradiance of pi c at a distance of 0, so a colour is an intensity divided by pi. The
    intensity of a sun is in lux, the intensity of other lights in candela.

    Raises:
        SceneFileError: a light is damaged.
    """
    named = [(extension, model) for node, model in nodes if (extension := gltf.extension(node, PUNCTUAL, "a node"))]
    if not named:
        return ()
    corners = np.concatenate([_corners(piece) for piece in pieces])
    candidates = (_light(gltf, extension.get("light"), model, corners, notes) for extension, model in named)
    lights = [light for light in candidates if light]
    lamps = [light for light in lights if light.kind != "sun"]
    if lamps:
        notes.append(ROUNDED_OFF)
    suns = sorted((light for light in lights if light.kind == "sun"), key=lambda sun: -sum(sun.colour))
    if len(suns) > 1:
        notes.append(f"only the brightest of {len(suns)} directional lights is drawn")
    return (*suns[:1], *lamps)


def _corners(piece: Piece) -> np.ndarray:
    """Return the corners of a piece's bounding box in world space, (8, 3)."""
    used = piece.mesh.positions[np.unique(piece.mesh.triangles)]
    ends = np.stack([used.min(axis=0), used.max(axis=0)])
    corners = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(8, 3)
    return corners @ piece.model[:3, :3].T + piece.model[:3, 3]


def _light(gltf: Gltf, index: object, model: np.ndarray, corners: np.ndarray, notes: list[str]) -> Light | None:
    """Return a light along the -z axis of its node; None if its type is unknown or it emits no light."""
    data, place = _data(gltf, index)
    kind = KINDS.get(data["type"]) if isinstance(data.get("type"), str) else None
    if kind is None:
        notes.append(f"{place} is ignored: not a directional, point or spot light")
        return None
    colour = np.array(gltf.numbers(data, "color", place, (1.0, 1.0, 1.0)))
    colour = np.maximum(colour * gltf.number(data, "intensity", place, 1.0) / np.pi, 0.0)
    if not colour.any():
        return None
    position, back = model[:3, 3], model[:3, 2]
    if kind != "point" and not back.any():
        raise gltf.error(place, "is in a node with zero scale: it has no direction")
    direction = -back / (np.linalg.norm(back) or 1.0)
    reach = REACH * float(np.linalg.norm(corners - position, axis=1).max())
    radius = gltf.number(data, "range", place, reach) if kind != "sun" else 0.0
    if kind != "sun" and radius <= 0:
        raise gltf.error(f"{place}.range", f"is {radius}, but must be above 0")
    inner, outer = _cones(gltf, gltf.child(data, "spot", place), place)
    return Light(kind, _triple(colour), _triple(position), radius, _triple(direction), inner, outer)


def _data(gltf: Gltf, index: object) -> tuple[Object, str]:
    known = gltf.list_of(gltf.extension(gltf.json, PUNCTUAL, "the file"), "lights", PUNCTUAL)
    if type(index) is not int or not 0 <= index < len(known) or not isinstance(known[index], dict):
        raise gltf.error(
            f"a node's {PUNCTUAL}", f"refers to a light that does not exist; the number of lights is {len(known)}"
        )
    return known[index], f"{PUNCTUAL}.lights[{index}]"


def _cones(gltf: Gltf, spot: Object, place: str) -> tuple[float, float]:
    """Return the half angles of a spot light's inner and outer cones in degrees, 0 and 45 by default. The inner angle
    is at least LEAST_RIM smaller than the outer. Raises SceneFileError."""
    inner, outer = (
        float(np.degrees(gltf.number(spot, key, place, default)))
        for key, default in (("innerConeAngle", 0.0), ("outerConeAngle", np.pi / 4))
    )
    if not 0 <= inner <= outer <= 90 + 1e-3 or outer < LEAST_RIM:
        raise gltf.error(
            f"{place}.spot", f"has cones of {inner:.4g} and {outer:.4g} degrees, not in ascending order from 0 to 90"
        )
    return min(inner, outer - LEAST_RIM), outer


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z
