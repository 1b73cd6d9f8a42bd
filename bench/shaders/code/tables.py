"""Look-up tables beside a codec's code: as a texture file, as a header of C, and as a NumPy file."""

from __future__ import annotations

import io
import struct
from collections.abc import Mapping

import numpy as np

# DXGI_FORMAT of 32-bit floats by the number of channels, and the head of a DDS file (Microsoft, "Programming Guide for
# DDS": DDS_HEADER and DDS_HEADER_DXT10).
FORMATS = {1: 41, 2: 16, 4: 2}
MAGIC, HEADER, PIXELS, TEXTURE_2D = b"DDS ", 124, 32, 3
# CAPS, HEIGHT, WIDTH, PITCH and PIXELFORMAT are given; the pixels' format is in the second header; it is a texture.
GIVEN, FOUR_LETTERS, IS_TEXTURE = 0x100F, 0x4, 0x1000


def dds(table: np.ndarray) -> bytes:
    """A table as a texture file of 32-bit floats, read by whatever reads DDS with its header of DirectX 10.

    Args:
        table: float32 of shape (height, width, channels), of 1, 2 or 4 channels.
    """
    height, width, channels = table.shape
    head = struct.pack("<7I44x", HEADER, GIVEN, height, width, width * channels * 4, 0, 1)
    pixels = struct.pack("<2I4s5I", PIXELS, FOUR_LETTERS, b"DX10", 0, 0, 0, 0, 0)
    caps = struct.pack("<5I", IS_TEXTURE, 0, 0, 0, 0)
    second = struct.pack("<5I", FORMATS[channels], TEXTURE_2D, 0, 1, 0)
    return MAGIC + head + pixels + caps + second + np.ascontiguousarray(table, "<f4").tobytes()


def header(tables: Mapping[str, np.ndarray]) -> str:
    """Tables as arrays of C: row by row, the channels of a texel next to each other."""
    return "\n".join([*(_array_text(name, tables[name]) for name in sorted(tables))])


def _array_text(name: str, table: np.ndarray) -> str:
    height, width, channels = table.shape
    rows = ("    " + ", ".join(f"{number!s}f" for number in row.ravel()) + "," for row in table)
    size = f"{height} rows of {width} texels of {channels} {'number' if channels == 1 else 'numbers'}"
    return "\n".join([f"// {size}.", f"static const float {name}[{table.size}] = {{", *rows, "};", ""])


def npy(table: np.ndarray) -> bytes:
    """A table as NumPy saves it."""
    file = io.BytesIO()
    np.save(file, table)
    return file.getvalue()


def table_files(tables: Mapping[str, np.ndarray], language: str, prefix: str) -> dict[str, bytes]:
    """What lies beside a file of a language, by name."""
    if not tables:
        return {}
    if language == "c":
        return {f"{prefix}_tables.h": header(tables).encode()}
    if language == "python":
        return {f"{name}.npy": npy(table) for name, table in tables.items()}
    return {f"{name}.dds": dds(table) for name, table in tables.items()}
