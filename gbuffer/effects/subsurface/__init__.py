"""Subsurface scattering in screen space: skin's diffuse light, blurred before it is multiplied by the albedo.

Jimenez, Sundstedt and Gutierrez, Screen-Space Perceptual Rendering of Human Skin, 2009; Jimenez and Gutierrez,
SeparableSSS, 2012; Christensen and Burley 2015. The pairs of Gaussians, the stencil and scattering before texturing
are from Jo Kyeong-jun, Advanced Rendering with Vision Engine.
"""

from __future__ import annotations

from ...frame.contract import Pass
from ...scenes.scene import Scene
from ..effect import Choice, Effect, Number
from ..noise import SEED
from .passes import SCATTERED, Scatter, burley, gaussians, separable, skin_light, sun_entry
from .profile import GAUSSIANS

SETTINGS = {
    "method": Choice(
        ("separable", "gaussians", "burley"),
        "Jimenez's kernel in two steps, a sum of Gaussians, or Christensen and Burley's profile on a disc.",
    ),
    "samples": Choice(("17", "11", "25", "33", "65", "97"), "Taps per step; 25 or more reach 3 mm, fewer 2 mm."),
    "width": Number(0.01, 0.0001, 10.0, "Metres on the surface for 3 mm of the profile; 0.003 is true to scale."),
    "follow": Number(
        0.5,
        0.0,
        100.0,
        "Fraction of light that a depth step of one width blocks; 0 ignores depth. Burley: on or off.",
    ),
    "pairs": Choice(tuple(map(str, GAUSSIANS)), "Method gaussians: number of blurs along rows and columns."),
    "transmittance": Number(1, 0, 1, "Whether sunlight shines through thin parts; requires a shadow map."),
    "translucency": Number(0.83, 0.0, 0.999, "Clarity of the skin: its thickness is multiplied by 1 - translucency."),
    "seed": SEED,
}


def _passes(
    method: str,
    samples: str,
    width: float,
    follow: float,
    pairs: str,
    transmittance: int,
    translucency: float,
    seed: int,
) -> tuple[Pass, ...]:
    scatter = Scatter(width, follow, int(samples))
    blurs = {
        "separable": lambda: separable(scatter),
        "gaussians": lambda: gaussians(scatter, int(pairs)),
        "burley": lambda: burley(scatter, seed),
    }
    entry = (sun_entry(),) if transmittance else ()
    return *entry, skin_light(width, translucency, bool(transmittance)), *blurs[method]()


def _lack_text(scene: Scene) -> str | None:
    kinds = {scene.materials[i].kind for part in scene.parts for i in part.materials if scene.materials[i].alpha == 1}
    return None if "skin" in kinds else "it has no skin"


EFFECT = Effect(
    "subsurface",
    "screen-space subsurface scattering of skin",
    "Jimenez and Gutierrez 2012; Jo Kyeong-jun 2011; Christensen and Burley 2015",
    SCATTERED,
    _passes,
    SETTINGS,
    _lack_text,
    scene="head",
)
