"""Image files as other programs write them, for the laboratory to read."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
from PIL import Image

EXR_ROWS = {"none": (0, 1), "RLE": (1, 1), "ZIPS": (2, 1), "ZIP": (3, 16)}


def png(pixels: np.ndarray) -> bytes:
    """Return a PNG file with 8-bit RGB."""
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "png")
    return buffer.getvalue()


def png16(pixels: np.ndarray, interlaced: bool = False) -> bytes:
    """Return a PNG file with 16-bit RGB, its rows filtered in each of the five ways in turn."""
    height, width, _ = pixels.shape
    rows = pixels.astype(">u2").view(np.uint8).reshape(height, -1).astype(np.int64)
    padded = np.pad(rows, ((1, 0), (6, 0)))
    left, above, corner = padded[1:, :-6], padded[:-1, 6:], padded[:-1, :-6]
    apart = [abs(left + above - corner - neighbour) for neighbour in (left, above, corner)]
    nearest = np.choose(np.argmin(apart, axis=0), [left, above, corner])
    guesses = [np.zeros_like(rows), left, above, (left + above) // 2, nearest]
    packed = b"".join(
        bytes([y % 5]) + ((rows[y] - guesses[y % 5][y]) % 256).astype(np.uint8).tobytes() for y in range(height)
    )
    data = zlib.compress(packed)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 2, 0, 0, interlaced))]
    chunks += [(b"IDAT", data[:100]), (b"IDAT", data[100:]), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(map(_chunk, chunks))


def _chunk(one: tuple[bytes, bytes]) -> bytes:
    name, data = one
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def hdr(pixels: np.ndarray, runs: bool = True) -> bytes:
    """Return a Radiance RGBE file, with runs of each channel or pixel by pixel."""
    height, width, _ = pixels.shape
    exponent = np.frexp(pixels.max(axis=-1))[1]
    scale = np.where(pixels.max(axis=-1) > 0, np.ldexp(1.0, 8 - exponent), 0.0)
    codes = np.concatenate([np.floor(pixels * scale[..., None]), (exponent + 128)[..., None]], axis=-1).astype(np.uint8)
    rows = [_runs(row) if runs else row.tobytes() for row in codes]
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + b"".join(rows)


def _runs(row: np.ndarray) -> bytes:
    packed = bytes([2, 2, len(row) >> 8, len(row) & 255])
    for channel in row.T:
        # One run of what is the same at the row's begin, then numbers as they are.
        same = int(np.argmax(channel != channel[0])) or len(channel)
        same = min(same, 127)
        packed += bytes([128 + same, channel[0]])
        for start in range(same, len(channel), 128):
            part = channel[start : start + 128]
            packed += bytes([len(part)]) + part.tobytes()
    return packed


def exr(pixels: np.ndarray, packing: str = "ZIP", kind: type = np.float16, names: str = "RGB", flags: int = 0) -> bytes:
    """Return an OpenEXR file with the scanlines of one part."""
    height, width, _ = pixels.shape
    code, rows = EXR_ROWS[packing]
    order = sorted(range(3), key=lambda at: names[at])
    word = 1 if kind is np.float16 else 2
    channels = b"".join(f"{names[index]}\0".encode() + struct.pack("<IIii", word, 0, 1, 1) for index in order) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [("channels", "chlist", channels), ("compression", "compression", bytes([code]))]
    attributes += [("dataWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0")]
    head = struct.pack("<II", 20000630, 2 | flags)
    head += b"".join(f"{name}\0{of}\0".encode() + struct.pack("<I", len(data)) + data for name, of, data in attributes)
    blocks = [_block(pixels[y : y + rows, :, order].astype(kind), y, packing) for y in range(0, height, rows)]
    start = len(head) + 1 + 8 * len(blocks)
    places = [start + sum(map(len, blocks[:i])) for i in range(len(blocks))]
    return head + b"\0" + struct.pack(f"<{len(places)}Q", *places) + b"".join(blocks)


def _block(pixels: np.ndarray, y: int, packing: str) -> bytes:
    raw = np.ascontiguousarray(np.moveaxis(pixels, -1, 1)).tobytes()
    if packing.startswith("ZIP"):
        turned = np.frombuffer(raw[::2] + raw[1::2], np.uint8).astype(int)
        packed = zlib.compress((np.diff(turned, prepend=128) + 128).astype(np.uint8).tobytes())
        raw = packed if len(packed) < len(raw) else raw
    return struct.pack("<iI", y, len(raw)) + raw
