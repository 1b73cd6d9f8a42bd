"""Images in users' scene files as texels: PNG, JPEG and WebP.

An image's size is read from its header, and an image that is too large is refused before anything is decoded. Pillow
reads all images, but reduces 16-bit colours to 8 bits, so OpenImageIO reads 16-bit PNG files again.
"""

from __future__ import annotations

import io
import struct
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from PIL.Image import Image

FORMATS = ("PNG", "JPEG", "WEBP")
MAX_SIDE = 8192
SMALLER = f"the maximum is {MAX_SIDE} pixels per side: reduce its size"
DAMAGED = "is cut off or damaged; save it again"
PNG = b"\x89PNG\r\n\x1a\n"
# Chunks of a PNG file that its texels are made of.
NEEDED = (b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND")
# Where a PNG file's header has the bits of a channel.
DEPTH = 24


class PictureError(ValueError):
    """An image that cannot be read; the message says what is wrong and how to fix it."""


def sides(data: bytes) -> tuple[int, int]:
    """Return the width and height of an encoded image, from its header alone. Raises PictureError."""
    with _opened(_bare(data)) as picture:
        return picture.size


def texels(data: bytes) -> np.ndarray:
    """Return the texels of an encoded image, (height, width, 4), uint8, or uint16 for a 16-bit PNG file; row 0 is the
    top.

    Grey fills all three colours. An alpha that the image lacks is the largest integer. Colours are not converted:
    colour profiles and gamma are ignored.

    Raises:
        PictureError: the data are not in one of FORMATS, or are too large, truncated or damaged.
    """
    data = _bare(data)
    with _opened(data) as picture:
        try:
            pixels = np.asarray(picture.convert("RGBA"))
        except Exception as error:  # Pillow has errors of many kinds for damaged files
            raise PictureError(DAMAGED) from error
    return _deep_texels(data) if data.startswith(PNG) and data[DEPTH] == 16 else pixels


def _opened(data: bytes) -> Image:
    from PIL import Image  # start-up goes without it

    with warnings.catch_warnings():
        # Sizes are checked here, and what else Pillow warns of changes no texel.
        warnings.simplefilter("ignore")
        try:
            picture = Image.open(io.BytesIO(data), formats=FORMATS)
        except Image.DecompressionBombError as error:
            raise PictureError(f"is too large; {SMALLER}") from error
        except Exception as error:
            raise PictureError("is not a PNG, JPEG or WebP image; save it as PNG") from error
    if max(picture.size) > MAX_SIDE:
        raise PictureError(f"has {picture.width} x {picture.height} pixels; {SMALLER}")
    return picture


def _deep_texels(data: bytes) -> np.ndarray:
    """Return the texels of a 16-bit PNG file that Pillow can read, uint16 of shape (height, width, 4). Raises
    PictureError. OpenImageIO reads only files, so a temporary file is written."""
    import OpenImageIO as oiio  # noqa: N813 # as its own documentation has it

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        path.write_bytes(data)
        wishes = oiio.ImageSpec()
        # As it is stored: colours are not multiplied by alpha.
        wishes.attribute("oiio:UnassociatedAlpha", 1)
        file = oiio.ImageInput.open(str(path), wishes)
        pixels = None if file is None else file.read_image("uint16")
    if pixels is None:
        oiio.geterror()  # else the library prints it at exit
        raise PictureError(DAMAGED)
    return _widened(np.asarray(pixels))


def _bare(data: bytes) -> bytes:
    """Return a PNG file with only the chunks that its texels need; other files are unchanged.

    Damaged profiles and texts must not make an image unreadable, and libpng prints warnings about them.
    """
    if not data.startswith(PNG):
        return data
    kept, offset = [PNG], len(PNG)
    while offset + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, offset)
        if kind in NEEDED:
            kept.append(data[offset : offset + 12 + length])
        offset += 12 + length
    return b"".join(kept)


def _widened(image: np.ndarray) -> np.ndarray:
    """Return an image of 1 to 4 channels with colours and alpha, (height, width, 4): grey fills all three colours,
    and a missing alpha is the largest integer."""
    count = image.shape[2]
    colours = image[..., :3] if count >= 3 else np.repeat(image[..., :1], 3, axis=2)
    alpha = image[..., -1:] if count in (2, 4) else np.full_like(image[..., :1], np.iinfo(image.dtype).max)
    return np.concatenate([colours, alpha], axis=2)
