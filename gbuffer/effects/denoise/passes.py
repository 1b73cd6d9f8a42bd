"""The passes of the denoiser: rays, guides, accumulation, filter and blending into the image."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import count
from typing import Any

from ...frame.canvas import Canvas
from ...frame.contract import Pass, Run
from ...frame.resource import SURFACES, Resource
from ...frame.resources import DEPTH, FINAL, SURFACE
from ...gl.device import ADD
from ..noise import NOISE

SIGNALS = ("reflections", "occlusion")
WEIGHTS_BY = ("power", "cone")
CLAMPS = ("none", "box", "variance")

# What rays march through; ssr_march.glsl reads it by this name.
NEAR = Resource("ssr_near", "r32f", follows=SURFACES)
# What one ray brings: reflected light, or 1 where nothing occludes; 0 on the background. 1 in w on surfaces.
NOISY = Resource("denoise_noisy", "rgba32f", follows=SURFACES)
# The decoded normal, world space, and depth in metres; 0 on the background.
GUIDE = Resource("denoise_guide", "rgba32f", follows=SURFACES, copies=2, kept=True)
ROUGHNESS = Resource("denoise_roughness", "r32f", follows=SURFACES)
HISTORY = Resource("denoise_history", "rgba32f", follows=SURFACES, copies=2, kept=True)
# The weight of the neighbours, without the pixel itself; the largest is 1 - (3/8)^2 = 0.859.
WEIGHTS = Resource("denoise_weights", "r32f", follows=SURFACES)
DENOISED = Resource("denoised", "rgba32f", follows=SURFACES, copies=2)

CONSTANTS: Mapping[str, Any] = {
    **NOISE,
    "HALVINGS": 8,  # these four as for ssr
    "EDGE": 0.05,
    "SELF": 0.125,
    "ROUNDING": 1e-4,
    "STEPS": 64,
    "THICKNESS": 0.1,  # metres
    "RADIUS": 1.0,  # metres beyond which nothing occludes
}
ACCUMULATION: Mapping[str, Any] = {
    "LEAST_SHARE": 0.05,  # of this frame in the history (Falcor's SVGFPass, mAlpha)
    "MOST_FRAMES": 32.0,  # Falcor's SVGFReproject.ps.slang
    "DEPTH_TIMES": 10.0,  # slopes that depths may differ by, and 0.01 m (the same)
    "DEPTH_MORE": 0.01,
    "SIGMAS": 1.0,  # half of the width of Salvi's clamp (An Excursion in Temporal Supersampling, 2016)
}
FILTER: Mapping[str, Any] = {
    "SLOPES": 1.0,  # sigma_z (Schied et al. 2017, section 4.4)
    "LEAST_DEPTH": 1e-3,  # share of the depth: their epsilon
    "LOBE_SHARE": 0.75 * 0.15**2,  # of GGX's volume in the cone: NRD's REBLUR once its history is long
    "LEAST_ANGLE": 1.5 / 255.0,  # radians: NRD's NRD_NORMAL_ENCODING_ERROR of 8-bit normals
    "ROUGHNESS_SHARE": 0.15,  # NRD's roughnessFraction
    "LEAST_ROUGHNESS_APART": 0.01,  # NRD's GetRoughnessWeightParams
}
AFTER = ("screen",)


def passes(settings: Mapping[str, Any]) -> tuple[Pass, ...]:
    """Return all passes, in order, for the effect's settings by name."""
    signal = SIGNALS.index(settings["of"])
    traced = partial(
        _traced, {"SIGNAL": signal, "BRIGHTEST": settings["brightest"], "SEED": settings["seed"], **CONSTANTS}
    )
    accumulated = {"CLAMP": CLAMPS.index(settings["clamp"]), "SAME": settings["same"], **ACCUMULATION}
    weights = {
        "WEIGHTS_BY": WEIGHTS_BY.index(settings["weights"]),
        "POWER_OF_NORMALS": settings["power"],
        "READS_ROUGHNESS": int(SIGNALS[signal] == "reflections"),
        **FILTER,
    }
    ours = (
        Pass("denoise_near", (*SURFACE, DEPTH), (NEAR,), lambda canvas: canvas.over("ssr_near.frag", NEAR), AFTER),
        Pass("denoise_rays", (*SURFACE, NEAR, FINAL), (NOISY,), traced, AFTER),
        Pass("denoise_guides", (*SURFACE, NEAR), (GUIDE, ROUGHNESS), _guided, AFTER),
        Pass("denoise_history", (NOISY, GUIDE), (HISTORY,), partial(_accumulated, accumulated), AFTER),
        Pass(
            "denoise_filter",
            (HISTORY, GUIDE, ROUGHNESS),
            (DENOISED, WEIGHTS),
            partial(_filtered, weights, settings["passes"]),
            AFTER,
        ),
    )
    over = Pass("denoise_over", (*SURFACE, DEPTH, DENOISED, FINAL), (FINAL,), _over, AFTER)
    return ours if signal else (*ours, over)


def _traced(macros: Mapping[str, Any], canvas: Canvas) -> Run:
    target, covers = canvas.target(NOISY), canvas.fullscreen("denoise_rays.frag", **macros)
    frames = count()

    def run() -> None:
        covers.program["frame"] = next(frames)
        canvas.cover(target, covers)

    return run


def _guided(canvas: Canvas) -> Run:
    return canvas.over("denoise_guides.frag", GUIDE, ROUGHNESS)


def _accumulated(macros: Mapping[str, Any], canvas: Canvas) -> Run:
    return canvas.over("denoise_history.frag", HISTORY, **macros)


def _filtered(macros: Mapping[str, Any], filter_passes: int, canvas: Canvas) -> Run:
    target, first_target = canvas.target(DENOISED), canvas.target(DENOISED, WEIGHTS)
    first, later = (canvas.fullscreen("denoise_filter.frag", IS_FIRST=int(not i), **macros) for i in range(2))

    def run() -> None:
        for i in range(filter_passes):
            if i:
                canvas.swap(DENOISED)
            covers = later if i else first
            covers.program["stride"] = 2**i
            canvas.cover(target if i else first_target, covers)

    return run


def _over(canvas: Canvas) -> Run:
    # What rays bring takes the place of all that the environment reflects.
    return canvas.over("ssr_over.frag", FINAL, depth=DEPTH, blend=ADD, AROUND=0, reflected=DENOISED.name)
