"""Water: a radial grid displaced by waves, with reflection, refraction and scattering.

Jo Kyeong-jun's talk on hybrid deferred rendering; Kryachko, Using Vertex Texture Displacement for Realistic Water
Rendering, GPU Gems 2, chapter 18. The guard on texture lookups and the light in crests follow NVIDIA's sample Island
11. Surfaces under water are lit as if the water were not there, except for caustics: sunlight is not absorbed on its
way down.
"""

from __future__ import annotations

from ...frame.contract import Pass
from ...scenes.scene import Scene
from ..effect import Choice, Effect, Number
from .grid import Grid
from .passes import Look, passes
from .resources import WATER, Maps
from .water_waves import OCTAVES

FRESNEL, REFRACTION = ("exact", "schlick"), ("two_depth", "alpha", "unguarded")
SETTINGS = {
    "waves": Number(1.0, 0.0, 4.0, "Factor on the slope of the scene's waves; 0 is still water."),
    "octaves": Number(OCTAVES, 1, OCTAVES, "Number of octaves of waves; the longest waves are kept."),
    "chop": Number(0.2, 0.0, 1.0, "Metres that points move up a slope, per unit of slope; sharpens crests."),
    "texels": Choice(("256", "128", "512"), "Texels per side of the wave maps."),
    "rings": Number(256, 16, 1024, "Number of rings of the grid."),
    "spokes": Number(256, 16, 1024, "Number of vertices per ring."),
    "fresnel": Choice(FRESNEL, "Fresnel's formula, or Schlick's approximation of it."),
    "refraction": Choice(
        REFRACTION,
        "Keeps objects above the water out of the refraction: a lookup that hits such an object stays in place "
        "(two_depth), the object has no weight (alpha), or nothing is done (unguarded).",
    ),
    "caustics": Number(1.0, 0.0, 1.0, "Strength of the caustics: their share of the sunlight on the ground."),
    "blur": Number(
        1.0, 0.0, 4.0, "Factor on the tilt of invisibly short waves, which blurs the mirror image vertically."
    ),
    "power": Number(1000.0, 16.0, 4096.0, "Blinn-Phong power of the sun's highlight."),
    "seed": Number(0, 0, 2**31 - 1, "Seed of the waves."),
}


def _passes(
    waves: float,
    octaves: int,
    chop: float,
    texels: str,
    rings: int,
    spokes: int,
    fresnel: str,
    refraction: str,
    caustics: float,
    blur: float,
    power: float,
    seed: int,
) -> tuple[Pass, ...]:
    maps = Maps(octaves, int(texels))
    chosen = {
        "EXACT_FRESNEL": int(fresnel == FRESNEL[0]),
        "BY_ALPHA": int(refraction == REFRACTION[1]),
        "GUARDED": int(refraction != REFRACTION[2]),
        "CAUSTICS": float(caustics),
        "BLUR": float(blur),
        "SUN_POWER": float(power),
    }
    return passes(Look(maps, seed, waves, Grid(rings, spokes), maps.defines(chop) | chosen))


def _lack_text(scene: Scene) -> str | None:
    if scene.water is None:
        return "it has no water"
    return None if scene.view.eye[1] > scene.water.level else "the camera is under water"


EFFECT = Effect(
    "water",
    "water: waves that reflect, refract and scatter light",
    "Jo Kyeong-jun; Kryachko 2005; NVIDIA Island 11",
    WATER,
    _passes,
    SETTINGS,
    _lack_text,
    scene="lake",
)
