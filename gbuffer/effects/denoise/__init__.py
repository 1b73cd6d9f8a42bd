"""Denoising: one ray a pixel, accumulated over frames and filtered with weights that read the G-buffer's normals.

SVGF's accumulation and a-trous filter (Schied et al. 2017) without its luminance weight, which reads no normals. The
history is rejected as in Falcor's SVGFPass, and can be clamped as temporal anti-aliasing clamps it. The other weight
of normals is that of NVIDIA's NRD: a cone whose width follows the roughness.

The rays of a measured G-buffer are by default those of the exact one, so that only the denoiser reads the code.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...frame.contract import Pass
from ...frame.resource import Resource
from ...scenes.scene import Scene
from ..effect import Choice, Effect, Number
from ..noise import SEED
from .passes import CLAMPS, DENOISED, HISTORY, NOISY, SIGNALS, WEIGHTS, WEIGHTS_BY, passes

EXACT_RAYS = "exact"


@dataclass(frozen=True, kw_only=True, eq=False)
class Denoiser(Effect):
    """A denoiser.

    Attributes:
        noisy: the image that it denoises, of one ray a pixel.
        weights: the weight of a pixel's neighbours in the first pass of the filter.
        history: the accumulated light, and in w the number of frames in it; 1 if the history was rejected.
    """

    noisy: Resource
    weights: Resource
    history: Resource


def _passes(**settings: Any) -> tuple[Pass, ...]:
    return passes(settings)


def _lack_text(scene: Scene) -> str | None:
    return None if scene.is_metal_rough else "its materials have no roughness; use studio or a glTF file"


SETTINGS = {
    "of": Choice(SIGNALS, "Signal to denoise."),
    "weights": Choice(WEIGHTS_BY, "Weight of normals: a power of their dot product (SVGF), or a cone (NRD)."),
    "power": Number(128, 1, 1024, "Exponent of the dot product; SVGF and Falcor use 128."),
    "passes": Number(5, 1, 8, "Number of passes of the filter; each doubles its radius."),
    "frames": Number(32, 1, 256, "Number of frames of the moving camera; the last one is compared."),
    "clamp": Choice(CLAMPS, "Bounds of the history, from 3 x 3 pixels of this frame."),
    "same": Number(
        0.9872, -1.0, 1.0, "Least dot product with the history's normal; Falcor's is 0.9872 on flat surfaces."
    ),
    "brightest": Number(
        4.0, 0.01, 65504.0, "Most light of a ray, in the scene's unit: few bright rays decide no figure."
    ),
    "rays": Choice((EXACT_RAYS, "own"), "Normals that rays start from: exact ones, or those of the measured G-buffer."),
    "seed": SEED,
}
EFFECT = Denoiser(
    "denoise",
    "a denoiser of reflections or occlusion, over space and time",
    "Schied et al. 2017 (SVGF); Falcor; NRD; Karis 2014; Salvi 2016",
    DENOISED,
    _passes,
    SETTINGS,
    _lack_text,
    scene="studio",
    noisy=NOISY,
    weights=WEIGHTS,
    history=HISTORY,
)
