"""The chromaticity of light, with which the colour of highlights is reconstructed from a single light target.

The GLSL twin is `chromaticity.glsl`, which takes the weights from here.
"""

from __future__ import annotations

from ..vec import TINY, Vec3, dot, select

# Rec. 709, linear (M. Drobot, Architektury Deferred).
LUMA = (0.2126, 0.7152, 0.0722)

CONSTANTS = {"LUMA": LUMA}


def luminance(c: Vec3):
    """Return the luminance of linear light, as one array."""
    return dot(c, Vec3(*LUMA))


def chromaticity(c: Vec3) -> Vec3:
    """Return the colour of light at luminance 1; white where there is no light."""
    total = luminance(c)
    return select(total > TINY, c / select(total > TINY, total, 1.0), Vec3(1.0, 1.0, 1.0))


def coloured(diffuse: Vec3, specular) -> Vec3:
    """Return specular light, given only by its luminance, in the colour of the diffuse light: chroma(D) A."""
    return chromaticity(diffuse) * specular
