"""A G-buffer lit in NumPy and float64 by the published formulas: the reference for the light passes.

It works in world space, not view space: positions and directions are first taken back through the camera, so that a
light, an axis or a matrix that the renderer gets wrong does not cancel out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from normalbench.gbuffer.defines.materials import CONSTANTS
from normalbench.gbuffer.frame.scene_buffers import IDENTITIES, sun_matrix
from normalbench.gbuffer.scenes.scene import KINDS, Light, Scene

# How far float32 may put a point off in the shadow map, in texels and in depth: the comparison may go either way.
TEXEL_ERROR, DEPTH_ERROR = 1e-3, 1e-6


@dataclass(frozen=True)
class Surfaces:
    """The surfaces in the covered pixels, in world space, one row each.

    Attributes:
        covered: (height, width), the pixels of the rows.
        position, direction, to_eye, albedo, specular: (n, 3).
        power, kind, instance: (n,).
    """

    covered: np.ndarray
    position: np.ndarray
    direction: np.ndarray
    to_eye: np.ndarray
    albedo: np.ndarray
    specular: np.ndarray
    power: np.ndarray
    kind: np.ndarray
    instance: np.ndarray

    def image(self, rows: np.ndarray) -> np.ndarray:
        """Return rows of the covered pixels as an image, 0 elsewhere."""
        image = np.zeros((*self.covered.shape, *rows.shape[1:]))
        image[self.covered] = rows
        return image


def surfaces(scene: Scene, gbuffer: list[np.ndarray]) -> Surfaces:
    """Return the covered pixels of the result of `Rendering.gbuffer`, in world space."""
    position, direction, albedo, specular = (np.asarray(texels, np.float64) for texels in gbuffer)
    covered = position[..., 3] > 0
    to_world = np.linalg.inv(scene.view.matrix())
    place = position[covered][:, :3] @ to_world[:3, :3].T + to_world[:3, 3]
    return Surfaces(
        covered,
        place,
        direction[covered][:, :3] @ to_world[:3, :3].T,
        _unit(np.array(scene.view.eye) - place),
        albedo[covered][:, :3],
        specular[covered][:, :3],
        albedo[covered][:, 3],
        direction[covered][:, 3].astype(int),
        position[covered][:, 3].astype(int),
    )


@dataclass(frozen=True)
class Lit:
    """Light on surfaces: the sums D and S, (n, 3), and the possible error of each, because float32 cannot tell
    whether a texel of the shadow map is in front."""

    diffuse: np.ndarray
    specular: np.ndarray
    diffuse_slack: np.ndarray
    specular_slack: np.ndarray


def relight(scene: Scene, seen: Surfaces, shadow_map: np.ndarray | None) -> Lit:
    """Return the light from all lamps of the scene on surfaces.

    Args:
        shadow_map: depths, row 0 first; None leaves the sun without shadows.
    """
    sums = np.zeros((4, len(seen.position), 3))
    for light in scene.lights:
        if light.kind == "sun":
            to_light = np.broadcast_to(-np.array(light.direction), seen.position.shape)
            low, high = (1.0, 1.0) if shadow_map is None else sunlit(scene, seen.position, shadow_map)
            middle, slack = (low + high) / 2, (high - low) / 2
        else:
            way = np.array(light.position) - seen.position
            distance = np.linalg.norm(way, axis=1)
            to_light = way / distance[:, None]
            middle, slack = arrives(light, distance, to_light), 0.0
        terms = answers(seen, to_light)
        for total, share, term in zip(sums, (middle, middle, slack, slack), (*terms, *terms), strict=True):
            total += (share * term)[:, None] * np.array(light.colour)
    return Lit(*sums)


def arrives(light: Light, distance: np.ndarray, to_light: np.ndarray) -> np.ndarray:
    """Return the share of a point or spot light's colour that arrives.

    Karis 2013, Real Shading in Unreal Engine 4: saturate(1 - (d / r)^4)^2 / (d^2 + 1). A spot's cone is a smooth step
    in the cosine, from the outer half angle to the inner.
    """
    share = np.clip(1 - (distance / light.radius) ** 4, 0, 1) ** 2 / (distance**2 + 1)
    if light.kind == "spot":
        cosine = to_light @ -np.array(light.direction)
        outside, inside = np.cos(np.radians([light.outer, light.inner]))
        t = np.clip((cosine - outside) / (inside - outside), 0, 1)
        share = share * (3 * t**2 - 2 * t**3)
    return share


def sunlit(scene: Scene, position: np.ndarray, shadow_map: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest share of sunlight that float32 allows, by 3 x 3 percentage-closer filtering.

    A point outside the map is lit, and so is a point that is no farther from the sun than the texel's depth.
    """
    size = shadow_map.shape[0]
    matrix = sun_matrix(scene)
    place = position @ matrix[:3, :3].T + matrix[:3, 3]
    texel, depth = place[:, :2] * size, place[:, 2]
    # Where the map holds nothing, and beyond it, nothing is in the way.
    open_map = np.pad(np.where(shadow_map < 1, shadow_map.astype(np.float64), np.inf), 2, constant_values=np.inf)
    low, high = np.full(len(position), np.inf), np.full(len(position), -np.inf)
    for nudge in ((0, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)):
        corner = np.floor(texel + np.array(nudge) * TEXEL_ERROR).astype(int)
        column, row = np.clip(corner, -2, size + 1).T
        least, most = np.zeros(len(position)), np.zeros(len(position))
        for up in (-1, 0, 1):
            for right in (-1, 0, 1):
                tap = np.clip(row + up, -2, size + 1) + 2, np.clip(column + right, -2, size + 1) + 2
                least += depth + DEPTH_ERROR <= open_map[tap]
                most += depth - DEPTH_ERROR <= open_map[tap]
        low, high = np.minimum(low, least / 9), np.maximum(high, most / 9)
    return low, high


def answers(seen: Surfaces, to_light: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return D and S of each surface for white light of brightness 1."""
    halfway = _unit(to_light + seen.to_eye)
    with_light, with_half = (np.sum(seen.direction * d, axis=1) for d in (to_light, halfway))
    eye_half = np.sum(seen.to_eye * halfway, axis=1)
    terms = np.zeros((2, len(to_light)))
    for number, kind in enumerate(KINDS):
        here = seen.kind == number
        terms[:, here] = _KINDS[kind](with_light[here], with_half[here], eye_half[here], seen.power[here])
    return terms[0], terms[1]


def blinn_phong(cosine: np.ndarray, power: np.ndarray | float) -> np.ndarray:
    """Return (n + 8) / 8 (N.H)^n, which conserves energy under N.L (Hoffman, Real-Time Rendering, 3rd ed., 7.6)."""
    return (power + 8) / 8 * np.clip(cosine, 0, 1) ** power


def _general(with_light, with_half, _eye_half, power):
    irradiance = np.clip(with_light, 0, None)
    return irradiance, irradiance * blinn_phong(with_half, power)


def _skin(with_light, with_half, eye_half, power):
    """Return energy-conserving wrapped diffuse light (McAuley 2011): max(N.L + w, 0) / (1 + w)^2."""
    wrap = float(CONSTANTS["SKIN_WRAP"])
    highlight = _general(with_light, with_half, eye_half, power)[1]
    return np.clip(with_light + wrap, 0, None) / (1 + wrap) ** 2, highlight


def _hair(with_light, with_half, _eye_half, power):
    """Return hair shading by Kajiya and Kay 1989, D = sin(T, L) for the strand T, with Scheuermann's highlight of
    2004, D sin(T, H)^n."""
    sine = np.sin(np.arccos(np.clip(with_light, -1, 1)))
    return sine, sine * np.sin(np.arccos(np.clip(with_half, -1, 1))) ** power


def _glossy(with_light, with_half, eye_half, power):
    """Return a clear coat that reflects F (Schlick 1994); the rest lights the base, which has a broad lobe."""
    normal = float(CONSTANTS["COAT_F0"])
    reflected = normal + (1 - normal) * (1 - eye_half) ** 5
    broad = float(CONSTANTS["BASE_SHARE"]) * blinn_phong(with_half, float(CONSTANTS["BASE_POWER"]))
    irradiance = np.clip(with_light, 0, None)
    return irradiance * (1 - reflected) * (1 + broad), irradiance * reflected * blinn_phong(with_half, power)


_KINDS = {"general": _general, "skin": _skin, "hair": _hair, "glossy": _glossy}


def emissive(scene: Scene, seen: Surfaces) -> np.ndarray:
    """Return the light that surfaces emit, (n, 3), by their instances' materials; the G-buffer lacks this light."""
    materials = np.concatenate([part.materials for part in scene.parts])
    own = np.array([material.emissive for material in scene.materials])[materials]
    if not own.any():
        return np.zeros_like(seen.position)
    assert len(own) <= IDENTITIES, "two instances share a number"
    return own[seen.instance - 1]


def image(scene: Scene, seen: Surfaces, lit: Lit) -> np.ndarray:
    """Return the image without transparent surfaces: ambient light, emitted light, albedo x D + specular x S."""
    colour = seen.albedo * (np.array(scene.ambient) + lit.diffuse) + seen.specular * lit.specular
    return seen.image(colour + emissive(scene, seen))


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)
