"""Highlights on the spheres in scene gloss: their positions in a frame, and their brightness."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....gbuffer.scenes.built_in.gloss import POWERS
from ....gbuffer.scenes.scene import Light, Scene

# A light in each channel of the image, so that three highlights of one sphere lie in one frame and none in another.
# Before the spheres, so that all of them are lit by all; as bright wherever they stand.
LIGHTS = (
    Light("point", (40.0, 0.0, 0.0), (-5.0, 4.0, 8.0), 40.0),
    Light("point", (0.0, 40.0, 0.0), (6.0, 2.0, 7.0), 40.0),
    Light("point", (0.0, 0.0, 40.0), (0.5, -6.0, 8.0), 40.0),
)


def lit_scene(scene: Scene) -> Scene:
    """Return scene gloss reduced to its highlights: only the spheres, in black, under LIGHTS."""
    spheres = tuple(replace(material, albedo=(0.0,) * 3) for material in scene.materials[: len(POWERS)])
    return replace(scene, parts=scene.parts[:1], materials=spheres, lights=LIGHTS, ambient=(0.0,) * 3)


@dataclass(frozen=True)
class Spots:
    """The highlights in a frame, for each sphere and light.

    Attributes:
        centroids: x and y in pixels, float64 of shape (spheres, lights, 2); NaN if no light reaches a sphere.
        peaks: the brightest pixel, float64 of shape (spheres, lights).
    """

    centroids: np.ndarray
    peaks: np.ndarray


def spheres_of(power: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """Return the sphere that each pixel shows, int of shape (height, width): 0 for no sphere, 1 for the first of
    POWERS, and so on."""
    match = np.abs(power[..., None] - np.array(POWERS)) < 0.01 * np.array(POWERS)
    return np.where(covered & match.any(axis=-1), match.argmax(axis=-1) + 1, 0)


def spots(linear: np.ndarray, spheres: np.ndarray) -> Spots:
    """Return the highlights in a frame: centroids weighted by light, and peaks.

    Args:
        linear: the image of `lit_scene`, (height, width, 3).
        spheres: the result of `spheres_of`.
    """
    from scipy import ndimage

    y, x = np.indices(spheres.shape)
    index, light = np.arange(1, len(POWERS) + 1), np.nan_to_num(linear.astype(np.float64))
    centroids, peaks = [], []
    for channel in np.moveaxis(light, -1, 0):
        total, along, down = (ndimage.sum_labels(channel * by, spheres, index) for by in (1, x, y))
        with np.errstate(invalid="ignore", divide="ignore"):
            centroids.append(np.stack([along, down], axis=-1) / total[:, None])
        peaks.append(ndimage.maximum(channel, spheres, index))
    return Spots(np.stack(centroids, axis=1), np.stack(peaks, axis=1))


def wobble(frames: list[Spots], exact: Spots) -> tuple[np.ndarray, np.ndarray]:
    """Return how far highlights move and how much they flicker from frame to frame.

    Args:
        frames: highlights of an encoding in two or more frames.
        exact: highlights of exact normals, which do not move.

    Returns:
        squared pixels, and squared percent of the exact peak, each averaged over pairs of frames and lights, of shape
        (spheres,); NaN if no light reaches a sphere.
    """
    moved = np.diff(np.stack([frame.centroids for frame in frames]), axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        flickered = 100 * np.diff(np.stack([frame.peaks for frame in frames]), axis=0) / exact.peaks
    return np.mean(np.sum(moved**2, axis=-1), axis=(0, 2)), np.mean(flickered**2, axis=(0, 2))
