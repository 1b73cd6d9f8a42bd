"""An animation of a wobbling highlight."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from .pictures import made_by

# What a difference is multiplied by; grey is none.
GAIN = 8.0
# Each pixel is shown as a square of this many.
ENLARGED = 2
CAPTIONS = ("encoded", "exact", f"difference x {GAIN:g}")
CAPTION_HEIGHT, GAP = 14, 4
MILLISECONDS = 80


def beside(image: np.ndarray, other: np.ndarray, title: str) -> Image.Image:
    """Return a frame of the animation: decoded normals, exact normals, and GAIN times their difference around grey,
    side by side.

    Args:
        image: displayed image with decoded normals, (height, width, 3), 0 to 1.
        other: the same with exact normals.
        title: text above the images.
    """
    apart = 0.5 + GAIN * (np.nan_to_num(image, nan=1.0) - other)
    height, width = (size * ENLARGED for size in image.shape[:2])
    wide = 3 * width + 2 * GAP
    sheet = Image.new("RGB", (wide, height + 2 * CAPTION_HEIGHT), "white")
    text = ImageDraw.Draw(sheet)
    text.text((2, 1), title, fill="black")
    for column, (pixels, caption) in enumerate(zip((image, other, apart), CAPTIONS, strict=True)):
        bytes_ = np.round(np.clip(np.nan_to_num(pixels), 0, 1) * 255).astype(np.uint8)
        left = column * (width + GAP)
        text.text((left + 2, CAPTION_HEIGHT), caption, fill="black")
        shown = Image.fromarray(bytes_).resize((width, height), Image.Resampling.NEAREST)
        sheet.paste(shown, (left, 2 * CAPTION_HEIGHT))
    return sheet


def write_animation(path: Path, frames: Sequence[Image.Image]) -> None:
    """Write an animated PNG file that loops forever. Raises OSError."""
    first, *others = frames
    first.save(
        path, format="png", save_all=True, append_images=others, duration=MILLISECONDS, loop=0, pnginfo=made_by()
    )
