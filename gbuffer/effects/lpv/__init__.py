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
    "iterations": Number(8, 0, 8, "Steps of propagation; each carries light one cell further."),
    "cascades": Number(2, 1, 3, "Volumes, each with cells twice as wide as those of the one before."),
    "cells": Number(16, 4, 64, "Cells along each axis of a volume."),
    "extent": Number(
        0.0, 0.0, 1000.0, "Metres along each axis of the finest volume; 0 makes the coarsest as large as the scene."
    ),
    "amplifier": Number(1.0, 0.0, 4.0, "Times what surfaces block of the light that passes; 0 blocks nothing."),
    "blend": Number(0.2, 0.0, 0.5, "The outer share of a volume over which the next coarser one takes over."),
    "format": Choice(tuple(FORMATS), "Format of the volumes; `shared` is an exponent and four numbers in RGBA8."),
    "sums": Choice(SUMS, "Format in which the light and blockers of a cell are added up first."),
    "texels": Number(128, 16, 1024, "Texels on a side of each reflective shadow map."),
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
    "light propagation volumes: one bounce of the sun's and the spots' light",
    "Kaplanyan 2009; Kaplanyan and Dachsbacher 2010",
    INDIRECT,
    _passes,
    SETTINGS,
    _lack_text,
)
