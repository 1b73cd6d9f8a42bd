"""Light propagation volumes: one bounce of sunlight and spotlights, propagated through a lattice of cells.

Kaplanyan, Light Propagation Volumes in CryEngine 3, SIGGRAPH 2009 course; Kaplanyan and Dachsbacher, Cascaded Light
Propagation Volumes for Real-Time Indirect Illumination, I3D 2010.
"""

from __future__ import annotations

from ...frame.contract import Pass
from ...scenes.scene import Scene
from ..effect import Choice, Effect, Number
from .passes import inject, lookup, propagate
from .volumes import FORMATS, INDIRECT, SUMS, Volumes

SETTINGS = {
    "iterations": Number(8, 0, 8, "Number of propagation steps; each moves light by one cell."),
    "cascades": Number(2, 1, 3, "Number of volumes; the cells of each are twice as wide as in the previous volume."),
    "cells": Number(16, 4, 64, "Cells along each axis of a volume."),
    "extent": Number(
        0.0, 0.0, 1000.0, "Side of the finest volume in metres; 0 makes the coarsest volume as large as the scene."
    ),
    "amplifier": Number(1.0, 0.0, 4.0, "Factor on the light that surfaces block; 0 blocks nothing."),
    "blend": Number(0.2, 0.0, 0.5, "Outer fraction of a volume that blends into the next coarser volume."),
    "format": Choice(
        tuple(FORMATS), "Format of the volumes; `shared` packs four numbers with a shared exponent into RGBA8."
    ),
    "sums": Choice(SUMS, "Format in which the light and the blockers of each cell are summed first."),
    "texels": Number(128, 16, 1024, "Texels per side of each reflective shadow map."),
}


def _passes(
    iterations: int,
    cascades: int,
    cells: int,
    extent: float,
    amplifier: float,
    blend: float,
    format: str,
    sums: str,
    texels: int,
) -> tuple[Pass, ...]:
    volumes = Volumes(cells, cascades, format, sums, texels)
    return (
        inject(volumes, extent, amplifier > 0),
        propagate(volumes, iterations, amplifier),
        lookup(volumes, extent, blend),
    )


def _lack_text(scene: Scene) -> str | None:
    sends = any(light.kind in ("sun", "spot") for light in scene.lights)
    return None if sends else "no sun or spot light lights the volume"


EFFECT = Effect(
    "lpv",
    "light propagation volumes: one bounce of sunlight and spotlights",
    "Kaplanyan 2009; Kaplanyan and Dachsbacher 2010",
    INDIRECT,
    _passes,
    SETTINGS,
    _lack_text,
)
