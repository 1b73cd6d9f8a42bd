"""The seeds' pictures of a codec: what is stored, what comes back, and how far off it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

GAIN = 30.0
RENDER_GAIN = 16.0
POWER = 1024.0
CAPTIONS = {
    "encoded": "encoded",
    "decoded": "decoded",
    "error": f"|error| x {GAIN:.0f}",
    "power": f"1 - dot^{POWER:.0f}",
}


def _bytes(values: np.ndarray) -> np.ndarray:
    return np.round(np.clip(np.nan_to_num(values), 0, 1) * 255).astype(np.uint8)


def codec_pictures(
    normals: np.ndarray, encoded: np.ndarray, decoded: np.ndarray, covered: np.ndarray
) -> dict[str, np.ndarray]:
    """The four pictures, uint8 of shape (height, width, 3), black on the background.

    Args:
        normals, encoded, decoded: float arrays of shape (height, width, 3), in [-1, 1].
        covered: bool of shape (height, width).
    """
    mask = covered[..., None]
    # The seeds raise the dot product to 1024; a negative one is as wrong as can be.
    along = np.clip(np.sum(normals * decoded, axis=-1, keepdims=True), 0, 1)
    return {
        "encoded": _bytes((encoded * 0.5 + 0.5) * mask),
        "decoded": _bytes((decoded * 0.5 + 0.5) * mask),
        "error": _bytes(np.abs(normals - decoded) * GAIN * mask),
        "power": _bytes((1 - along**POWER) * mask * np.ones(3)),
    }


def render_pictures(image: np.ndarray, reference: np.ndarray) -> dict[str, np.ndarray]:
    """A rendered image, its reference, and how far they are apart, uint8 of shape (height, width, 3).

    Args:
        image, reference: as displayed, float arrays of shape (height, width, 3), in [0, 1].
    """
    difference = np.abs(np.nan_to_num(image, nan=1.0) - reference) * RENDER_GAIN
    return {"final": _bytes(image), "reference": _bytes(reference), "difference": _bytes(difference)}


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Write uint8 pixels of shape (height, width, 3). Raises OSError."""
    Image.fromarray(pixels).save(path, format="png")


def contact_sheet(rows: dict[str, dict[str, np.ndarray]], scale: int = 2) -> np.ndarray:
    """One picture of many: a row for each name, its pictures side by side at 1/scale, captions in the margin."""
    lines = []
    for name, pictures in rows.items():
        small = [_caption(_shrunk(picture, scale), f"{name}: {CAPTIONS[kind]}") for kind, picture in pictures.items()]
        lines.append(np.concatenate(small, axis=1))
    return np.concatenate(lines, axis=0)


def _shrunk(pixels: np.ndarray, scale: int) -> np.ndarray:
    height, width = (size // scale * scale for size in pixels.shape[:2])
    cells = pixels[:height, :width].reshape(height // scale, scale, width // scale, scale, 3)
    return np.round(cells.mean(axis=(1, 3))).astype(np.uint8)


def _caption(pixels: np.ndarray, text: str, height: int = 16) -> np.ndarray:
    image = Image.new("RGB", (pixels.shape[1], pixels.shape[0] + height), "white")
    image.paste(Image.fromarray(pixels), (0, height))
    ImageDraw.Draw(image).text((3, 2), text, fill="black")
    return np.asarray(image)
