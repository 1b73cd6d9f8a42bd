"""Metallic-roughness materials as in glTF 2.0 (appendix B), and the texture maps that vary them over a surface."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

Colour = tuple[float, float, float]
Wrap = Literal["repeat", "mirror", "clamp"]
# Of light that meets a dielectric of refractive index 1.5 head on, the share that it reflects.
DIELECTRIC = 0.04


@dataclass(frozen=True, eq=False)
class Map:
    """A texture map on a surface.

    Attributes:
        texels: (height, width, 4), uint8 or uint16; or float32, which is not filtered; row 0 is at v = 0. A channel
            that a file lacks is filled with the largest integer. Maps of the same image share the array.
        is_srgb: whether the first three channels are sRGB colours; 8 bits only.
        wrap: wrap modes beyond [0, 1] along u and along v.
        uv_set: the uv set of the mesh that it uses, 0 or 1.
        placed: (2, 3), matrix of the texture coordinates: the map is sampled at placed @ (u, v, 1).
    """

    texels: np.ndarray
    is_srgb: bool = False
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")
    uv_set: int = 0
    placed: np.ndarray = field(default_factory=lambda: np.eye(3)[:2])


@dataclass(frozen=True, eq=False)
class MetalRough:
    """A metallic-roughness material: a GGX specular lobe over Lambertian diffuse reflection.

    Attributes:
        base: linear base colour, each channel in [0, 1].
        metalness: 0 for a dielectric, 1 for a metal.
        roughness: perceptual roughness, 0 for a mirror, 1 for the dullest surface; GGX's alpha is its square.
        reflectance: reflectance of a dielectric at normal incidence.
        emission: linear light that the surface emits, 0 or more.
        alpha: opacity; below 1 the surface is transparent and drawn after all opaque surfaces.
        cutoff: points with a lower alpha are not drawn; 0 draws everything.
        normal_scale: factor on the normal map's x and y.
        occlusion_strength: strength of the occlusion map, 0 to 1.
        base_map: colour and alpha, times `base` and `alpha`.
        rough_metal_map: roughness in G and metalness in B, times `roughness` and `metalness`.
        normal_map: the normal in the tangent frame, x along u and y along -v: RGB are x, y, z by 2 c - 1.
        occlusion_map: R is the share of ambient light that arrives.
        emission_map: emitted light, times `emission`.
    """

    base: Colour = (0.5, 0.5, 0.5)
    metalness: float = 0.0
    roughness: float = 0.5
    reflectance: float = DIELECTRIC
    emission: Colour = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    cutoff: float = 0.0
    normal_scale: float = 1.0
    occlusion_strength: float = 1.0
    base_map: Map | None = None
    rough_metal_map: Map | None = None
    normal_map: Map | None = None
    occlusion_map: Map | None = None
    emission_map: Map | None = None
    # It is shaded by the light pass in full, as the Deferred ID's 0 says.
    kind: Literal["general"] = "general"

    @property
    def maps(self) -> tuple[Map | None, ...]:
        """The material's maps in the order of `MAPS`; None for a map that it lacks."""
        return tuple(getattr(self, f"{name}_map") for name in MAPS)


MAPS = ("base", "rough_metal", "normal", "occlusion", "emission")
