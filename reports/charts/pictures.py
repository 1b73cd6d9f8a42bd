"""Images for codecs: the stored numbers, the decoded values and their errors."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from PIL.PngImagePlugin import PngInfo

GAIN = 30.0
RENDER_GAIN = 16.0
POWER = 1024.0
# What the colours of a position's error stand for: powers of ten, in the scene's unit.
DECADES = (-6, 1)
COLOURS = "viridis"
SCALE_HEIGHT = 24
SLOPE = "the rebuilt surface, lit by its own slope"
# Towards the light that rebuilt surfaces are lit by, view space.
LIGHT = np.array([0.3, 0.5, 0.8]) / np.linalg.norm([0.3, 0.5, 0.8])


def _byte_pixels(values: np.ndarray) -> np.ndarray:
    return np.round(np.clip(np.nan_to_num(values), 0, 1) * 255).astype(np.uint8)


def codec_pictures(
    normals: np.ndarray, encoded: np.ndarray, decoded: np.ndarray, covered: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the images `encoded`, `decoded`, `error` and `power`, uint8 of shape (height, width, 3), with a black
    background.

    Args:
        normals, encoded, decoded: float arrays of shape (height, width, 3), in [-1, 1].
        covered: bool of shape (height, width).
    """
    mask = covered[..., None]
    # The seeds raise the dot product to 1024; a negative one is as wrong as can be.
    along = np.clip(np.sum(normals * decoded, axis=-1, keepdims=True), 0, 1)
    return {
        "encoded": _byte_pixels((encoded * 0.5 + 0.5) * mask),
        "decoded": normals_picture(decoded, covered),
        "error": _byte_pixels(np.abs(normals - decoded) * GAIN * mask),
        "power": _byte_pixels((1 - along**POWER) * mask * np.ones(3)),
    }


def normals_picture(normals: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """Return normals as bytes, [-1, 1] mapped to [0, 255], with a black background; shapes as for
    `codec_pictures`."""
    return _byte_pixels((normals * 0.5 + 0.5) * covered[..., None])


def picture(image: np.ndarray) -> np.ndarray:
    """Return a displayed image, floats in [0, 1], as bytes."""
    return _byte_pixels(image)


def grey(values: np.ndarray) -> np.ndarray:
    """Return numbers in [0, 1], (height, width), as grey pixels: uint8 of shape (height, width, 3)."""
    return _byte_pixels(values[..., None] * np.ones(3))


def difference(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Return the absolute difference between two displayed images, times RENDER_GAIN, as bytes; NaN in `image` counts
    as 1."""
    return _byte_pixels(np.abs(np.nan_to_num(image, nan=1.0) - reference) * RENDER_GAIN)


def strips(lines: Sequence[np.ndarray], height: int) -> np.ndarray:
    """Return lines of displayed colours, (width, 3) each, as an image of strips, `height` pixels each; in bytes."""
    return np.concatenate([np.repeat(_byte_pixels(line)[None], height, axis=0) for line in lines])


def depth_pictures(errors: np.ndarray, positions: np.ndarray, covered: np.ndarray) -> dict[str, np.ndarray]:
    """Return two uint8 images: `position_error`, the errors of rebuilt positions in colour below a scale of powers of
    ten; and `shaded`, the rebuilt surface lit by its own slope below a caption, where depth steps show as terraces.

    Args:
        errors: distances between true and rebuilt positions, (height, width).
        positions: rebuilt positions in view space, row 0 at the top, (height, width, 3).
        covered: bool of shape (height, width).
    """
    with np.errstate(divide="ignore"):
        powers = np.log10(errors)
    coloured = _coloured(powers) * covered[..., None]
    return {
        "position_error": np.concatenate([_scale_of_colours(errors.shape[1]), coloured]),
        "shaded": _captioned_pixels(
            _byte_pixels(_lit(positions)[..., None] * covered[..., None] * np.ones(3)), SLOPE, SCALE_HEIGHT
        ),
    }


def _coloured(powers: np.ndarray) -> np.ndarray:
    """Return colours, uint8, for the exponents of powers of ten; exponents outside DECADES get the colour of the
    nearer end."""
    import matplotlib

    low, high = DECADES
    share = np.clip((np.nan_to_num(powers, nan=high) - low) / (high - low), 0, 1)
    return _byte_pixels(matplotlib.colormaps[COLOURS](share)[..., :3])


def _scale_of_colours(width: int, height: int = SCALE_HEIGHT) -> np.ndarray:
    """Return the colour scale as a uint8 image, labelled with powers of ten."""
    low, high = DECADES
    strip = _coloured(np.broadcast_to(np.linspace(low, high, width), (height // 3, width)))
    image = Image.new("RGB", (width, height), "white")
    image.paste(Image.fromarray(strip), (0, height - len(strip)))
    draw = ImageDraw.Draw(image)
    for power in range(low, high + 1):
        text = f"{10.0**power:g}"
        left = (power - low) / (high - low) * (width - 1)
        left = min(max(left - draw.textlength(text) / 2, 2), width - 2 - draw.textlength(text))
        draw.text((left, 2), text, fill="black")
    return np.asarray(image)


def _lit(positions: np.ndarray) -> np.ndarray:
    """Return the shading, 0 to 1, of the surface through neighbouring positions; the last row and column are repeated
    to keep the size."""
    right, down = np.diff(positions, axis=1)[:-1], np.diff(positions, axis=0)[:, :-1]
    normals = np.cross(down, right)
    with np.errstate(invalid="ignore", divide="ignore"):
        light = np.sum(normals * LIGHT, axis=-1) / np.linalg.norm(normals, axis=-1)
    return np.pad(np.maximum(np.nan_to_num(light), 0), ((0, 1), (0, 1)), mode="edge")


def made_by() -> PngInfo:
    """Return the PNG metadata that marks a file as made by normalbench, so that it may be replaced."""
    info = PngInfo()
    info.add_text("Software", "normalbench")
    return info


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Write uint8 pixels of shape (height, width, 3) as a PNG file. Raises OSError."""
    # Runs alone: a quarter of the time, for files that are a twelfth larger.
    Image.fromarray(pixels).save(path, format="png", compress_type=zlib.Z_RLE, pnginfo=made_by())


def _captioned_pixels(pixels: np.ndarray, text: str, height: int) -> np.ndarray:
    image = Image.new("RGB", (pixels.shape[1], pixels.shape[0] + height), "white")
    image.paste(Image.fromarray(pixels), (0, height))
    ImageDraw.Draw(image).text((3, 2), text, fill="black")
    return np.asarray(image)
