"""The pixels that a page can show: how a run's files store them, and how angles are stored as bytes."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image

from .codec_key import CodecKey

# A frame of 3840 x 2160 is shown.
MAX_PIXELS = 2**23
# What an animation may take inside a page.
MAX_FILM = 600_000
# An angle is kept as a byte: 1 is 2^LEAST_LOG2 degrees, each further step an eighth of an octave. 0 is the background.
LEAST_LOG2, STEPS_PER_OCTAVE = -20, 8
NOT_A_NUMBER = 255


def angle_bytes(degrees: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """Return angles as bytes, uint8 of the same shape: accurate to 4.5%, NOT_A_NUMBER for NaN, 0 for the background.

    Args:
        degrees: angles, of any shape.
        covered: bool of the same shape; false for the background.
    """
    known = np.maximum(np.nan_to_num(degrees), 2.0**LEAST_LOG2)
    steps = np.rint((np.log2(known) - LEAST_LOG2) * STEPS_PER_OCTAVE) + 1
    return np.where(covered, np.where(np.isnan(degrees), NOT_A_NUMBER, steps), 0).astype(np.uint8)


@dataclass(frozen=True)
class NormalPixels:
    """An image of normals after a codec's round trip.

    Attributes:
        angle: result of `angle_bytes`, of shape (height, width).
        codes: the stored bits, unsigned integers of shape (height, width, components).
        bits: bits of each component.
        decoded: decoded normals, [-1, 1] mapped to [0, 255], black on the background, uint8 of shape (height, width,
            3).
    """

    angle: np.ndarray
    codes: np.ndarray
    bits: tuple[int, ...]
    decoded: np.ndarray

    @property
    def shape(self) -> tuple[int, ...]:
        """Height, width, 3."""
        return self.decoded.shape


@dataclass(frozen=True)
class ImagePixels:
    """A rendered image as displayed, uint8 of shape (height, width, 3), and FLIP from 0 to 255, (height, width)."""

    final: np.ndarray
    flip: np.ndarray | None

    @property
    def shape(self) -> tuple[int, ...]:
        """Height, width, 3."""
        return self.final.shape


@dataclass(frozen=True)
class Pictured:
    """A codec with its pixels.

    Attributes:
        key: the codec.
        label: display name.
        codec: the codec's name in tables and charts; empty if it is not a codec.
        load: function that returns its pixels; None if its files are damaged.
        rank: if there is not room for all codecs, those of lower rank are shown.
    """

    key: CodecKey
    label: str
    codec: str
    load: Callable[[], NormalPixels | ImagePixels | None]
    rank: int = 0


@dataclass(frozen=True)
class Subject:
    """A subject on which several codecs were tested.

    Attributes:
        title: display name.
        of: "normals" or "image".
        original: function that returns the exact normals, or the image in 32-bit floats: uint8 of shape (height,
            width,
            3); None if the file is damaged.
        codecs: codecs with pixels, by bits, the best first.
        first: number of codecs that get room on a page before any other subject does.
    """

    title: str
    of: str
    original: Callable[[], np.ndarray | None]
    codecs: Sequence[Pictured]
    first: int = 0


@dataclass(frozen=True)
class Film:
    """An animation: a sentence that describes it, and its file."""

    said: str
    path: Path


def film_uri(path: Path) -> str:
    """Return an animated PNG as a data URI; empty if it is damaged, or larger than MAX_FILM bytes."""
    try:
        data = path.read_bytes()
        with Image.open(BytesIO(data), formats=["PNG"]) as image:
            image.verify()
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return ""
    return "data:image/png;base64," + base64.b64encode(data).decode("ascii") if len(data) <= MAX_FILM else ""


def read_png(path: Path) -> np.ndarray | None:
    """Return the pixels of a PNG file, uint8 of shape (height, width, 3); None if damaged or too large for a page."""
    try:
        with Image.open(path, formats=["PNG"]) as image:
            return None if image.width * image.height > MAX_PIXELS else np.asarray(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
