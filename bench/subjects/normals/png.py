"""A check for more rows than a PNG header declares (ISO/IEC 15948), which libpng ignores.

The library rejects missing rows, wrong checksums and unknown filters. But if the header declares fewer or narrower
rows than the file has, libpng reads the image without an error, sheared or only in part.
"""

from __future__ import annotations

import struct
import zlib

CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # of each colour type
# Of each pass of an interlaced image: its first column and row, and how far apart they are.
ADAM7 = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))


# The widest and highest that libpng reads.
MAX_SIDE = 1_000_000


def sides(data: bytes) -> tuple[int, int]:
    """Return the width and height in the header; (0, 0) for a file too short for a header. The signature is not
    checked."""
    return struct.unpack(">II", data[16:24]) if len(data) >= 24 else (0, 0)


def has_surplus(data: bytes) -> bool:
    """Whether a PNG file has more rows than its header declares; at most one byte beyond those rows is decompressed.

    Errors that OpenImageIO detects are not checked: read the file with OpenImageIO first.
    """
    size = _rows_size(data)
    try:
        return len(zlib.decompressobj().decompress(_compressed_bytes(data), size + 1)) > size
    except zlib.error:  # beyond the last row
        return True


def _rows_size(data: bytes) -> int:
    """Return the size in bytes of all rows of a PNG file after decompression, including a filter byte per row."""
    width, height, depth, colour, _, _, interlaced = struct.unpack_from(">IIBBBBB", data, 16)
    bits = depth * CHANNELS[colour]
    passes = ADAM7 if interlaced else ((0, 0, 1, 1),)
    sides = [(-((x - width) // across), -((y - height) // down)) for x, y, across, down in passes]
    return sum(rows * (1 + (columns * bits + 7) // 8) for columns, rows in sides if columns > 0)


def _compressed_bytes(data: bytes) -> bytes:
    chunks, offset = [], 8
    while offset + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, offset)
        if kind == b"IEND":
            break
        if kind == b"IDAT":
            chunks.append(data[offset + 8 : offset + 8 + length])
        offset += 12 + length
    return b"".join(chunks)
