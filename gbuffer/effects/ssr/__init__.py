"""Screen-space reflections: mirrored rays, spread by roughness, that hit the surfaces visible on the screen.

A ray marches through the depth buffer (McGuire and Mara, Efficient GPU Screen-Space Ray Tracing, 2014), and the step
in which it passes behind a surface is bisected. The light at the hit replaces the surface's reflection of the
environment. A ray cannot hit anything outside the image or hidden behind another surface.
"""

from __future__ import annotations

from ...frame.contract import Pass
from ...scenes.scene import Scene
from ..effect import Choice, Effect, Number
from ..noise import SEED
from .passes import HITS, REFLECTED, passes

AROUND = ("environment", "nothing")
SETTINGS = {
    "steps": Number(64, 1, 4096, "Maximum number of steps per ray; a step is at least one pixel long."),
    "rays": Number(2, 1, 1024, "Number of rays per pixel, spread by its roughness; a mirror needs one."),
    "thickness": Number(0.1, 0.001, 100.0, "Distance in metres behind a surface within which a ray hits it."),
    "misses": Choice(AROUND, "Light for rays that hit nothing on screen."),
    "seed": SEED,
}


def _passes(steps: int, rays: int, thickness: float, misses: str, seed: int) -> tuple[Pass, ...]:
    return passes(steps, rays, thickness, misses == AROUND[0], seed)


def _lack_text(scene: Scene) -> str | None:
    return None if scene.is_metal_rough else "its materials have no roughness; use studio or a glTF file"


EFFECT = Effect(
    "ssr",
    "screen-space reflections, glossy by roughness",
    "McGuire and Mara 2014; Dupuy and Benyoub 2023",
    REFLECTED,
    _passes,
    SETTINGS,
    _lack_text,
    scene="studio",
    hits=HITS,
)
