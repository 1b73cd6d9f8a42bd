"""PNG pixels of 8 and 16 bits a channel (ISO/IEC 15948), without interlacing.

Pillow reads 16-bit colour as 8-bit, and what reads it right is large (OpenCV) or no longer kept (pypng): this is the
part of the format that is needed. A filter refers to the pixels to the left, above and above left, so the pixels of one
rising diagonal depend on no other of it and are undone together.
"""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

import numpy as np

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # of each colour type that is no palette
NONE, SUB, UP, AVERAGE, PAETH = range(5)


class PngError(ValueError):
    """Damaged, or of a kind that is not read; one line."""


class Header(NamedTuple):
    """What a PNG file says of itself."""

    width: int
    height: int
    depth: int
    colour: int
    interlaced: int


def header(data: bytes) -> Header:
    """The size and kind of an image. Raises PngError where there is no PNG header."""
    if not data.startswith(SIGNATURE) or len(data) < 33 or data[12:16] != b"IHDR":
        raise PngError("no PNG header")
    width, height, depth, colour, _, _, interlaced = struct.unpack_from(">IIBBBBB", data, 16)
    if not width or not height:
        raise PngError(f"a size of {width} x {height}")
    return Header(width, height, depth, colour, interlaced)


def pixels(data: bytes) -> np.ndarray:
    """Numbers as they are stored, uint8 or uint16 of shape (height, width, channels).

    The size is believed: ask `header` first. Raises PngError.
    """
    head = header(data)
    channels = CHANNELS.get(head.colour)
    if channels is None or head.depth not in (8, 16):
        raise PngError(f"{head.depth} bits of colour type {head.colour} are not read")
    if head.interlaced:
        raise PngError("it is interlaced; save it without interlacing")
    step = channels * head.depth // 8
    rows = np.frombuffer(_inflated(data, head.height * (1 + head.width * step)), np.uint8).reshape(head.height, -1)
    if rows[:, 0].max() > PAETH:
        raise PngError(f"row {int(np.argmax(rows[:, 0] > PAETH))} has no known filter; it is damaged")
    plain = _unfiltered(rows[:, 1:].reshape(head.height, head.width, step), rows[:, 0])
    stored = plain.reshape(head.height, -1).view(">u2" if head.depth == 16 else "u1")
    return stored.astype(np.uint16 if head.depth == 16 else np.uint8).reshape(head.height, head.width, channels)


def _inflated(data: bytes, size: int) -> bytes:
    """The image data, of just that many bytes; never more is unpacked."""
    packed, at = [], len(SIGNATURE)
    while at + 12 <= len(data):
        (length,), kind = struct.unpack_from(">I", data, at), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + length]
        if len(body) < length or data[at + 8 + length : at + 12 + length] != struct.pack(">I", zlib.crc32(kind + body)):
            raise PngError(f"the {kind.decode('latin-1')!r} chunk at byte {at} is cut off or damaged")
        if kind == b"IDAT":
            packed.append(body)
        at += 12 + length
    try:
        found = zlib.decompressobj().decompress(b"".join(packed), size + 1)
    except zlib.error as error:
        raise PngError(f"its data are damaged ({error})") from error
    if len(found) != size:
        raise PngError(f"its data are {'more than' if len(found) > size else len(found)} {size} bytes; it is damaged")
    return found


def _unfiltered(filtered: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """Bytes of shape (height, width, bytes a pixel) from those of each row's filter."""
    height, width, step = filtered.shape
    # A row and a column of zeros stand for what lies outside.
    plain = np.zeros((height + 1, width + 1, step), np.uint8)
    for diagonal in range(height + width - 1):
        y = np.arange(max(0, diagonal - width + 1), min(height, diagonal + 1))
        x = diagonal - y
        left, up, corner = (plain[y + i, x + j].astype(np.int16) for i, j in ((1, 0), (0, 1), (0, 0)))
        guesses = (left, up, (left + up) // 2, _paeth(left, up, corner))
        kind = kinds[y][:, None]
        guess = np.select([kind == k for k in (SUB, UP, AVERAGE, PAETH)], guesses, np.int16(0))
        plain[y + 1, x + 1] = (filtered[y, x] + guess).astype(np.uint8)
    return plain[1:, 1:].copy()


def _paeth(left: np.ndarray, up: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """Whichever neighbour is nearest to left + up - corner, the earlier one of equals."""
    away = [abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)]
    nearest_left = (away[0] <= away[1]) & (away[0] <= away[2])
    return np.where(nearest_left, left, np.where(away[1] <= away[2], up, corner))
