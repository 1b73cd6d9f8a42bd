"""The response of a metallic-roughness surface to a light, in float64 by the formulas: a reference for GLSL."""

from __future__ import annotations

import numpy as np

from normalbench.gbuffer.environment.dfg import dfg


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sum(a * b, axis=-1, keepdims=True)


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def answer(n, v, l, roughness, albedo, f0) -> np.ndarray:  # noqa: E741
    """Return outgoing light for a head-on irradiance of pi: pi n.l (D V F gain + albedo / pi (1 - reflected share)).

    Args:
        n, v, l: unit normals and directions to the eye and to the light, (count, 3).
        roughness: (count, 1), 0.045 or more.
        albedo, f0: diffuse albedo and reflectance at normal incidence, (count, 3).
    """
    a, h = roughness**2, unit(l + v)
    n_l, n_v, n_h, v_h = np.maximum(dot(n, l), 0), np.clip(dot(n, v), 1e-4, 1), dot(n, h), dot(v, h)
    distribution = a**2 / (np.pi * (n_h**2 * (a**2 - 1) + 1) ** 2)
    smith = n_l * np.sqrt(n_v**2 * (1 - a**2) + a**2) + n_v * np.sqrt(n_l**2 * (1 - a**2) + a**2)
    fresnel = f0 + (1 - f0) * (1 - v_h) ** 5
    scale, bias = dfg(n_v, roughness)
    gain = 1 + f0 * (1 / (scale + bias) - 1)
    lobe = distribution * 0.5 / np.maximum(smith, 1e-300) * fresnel * gain
    return np.where(n_l > 0, n_l * (np.pi * lobe + albedo * (1 - (f0 * scale + bias) * gain)), 0.0)


def from_lamp(light, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the colour that arrives from a point light in view space, and the direction to it, (count, 3) each."""
    way = np.array(light.position) - position
    away2 = dot(way, way)
    window = np.maximum(1 - (away2 / light.radius**2) ** 2, 0)
    return np.array(light.colour) * window**2 / (away2 + 1), unit(way)
