"""Lookup tables next to a codec's functions, as texture files or as a C header."""

from __future__ import annotations

import struct
import textwrap
from collections.abc import Iterable, Mapping

import numpy as np

from ..translator.texels import Texels
from ..translator.writer import INDENT
from .fold import WIDTH

# DXGI_FORMAT of 8-bit numbers in [0, 1] and of 32-bit floats by the number of channels, and the head of a DDS file
# (Microsoft, "Programming Guide for DDS": DDS_HEADER and DDS_HEADER_DXT10).
BYTES, FLOATS = {1: 61, 2: 49, 4: 28}, {1: 41, 2: 16, 4: 2}
LARGEST = np.float32(255.0)
KB = 1024
MAGIC, HEADER, PIXELS, TEXTURE_2D = b"DDS ", 124, 32, 3
# CAPS, HEIGHT, WIDTH, PITCH and PIXELFORMAT are given; the pixels' format is in the second header; it is a texture.
GIVEN, FOUR_LETTERS, IS_TEXTURE = 0x100F, 0x4, 0x1000


def texels_of(table: np.ndarray) -> Texels:
    """Return the size of a table and the format in which it is stored: 8 bits if they are exact, else floats.

    Args:
        table: float32 of shape (height, width, channels).
    """
    whole = _as_bytes(table)
    return Texels(*table.shape, is_bytes=bool((whole / LARGEST == table).all()))


def _as_bytes(table: np.ndarray) -> np.ndarray:
    return np.clip(np.rint(table * LARGEST), 0, 255).astype(np.uint8)


def kept(table: np.ndarray) -> np.ndarray:
    """Return a table as a file stores it, with the same shape: uint8 if 8 bits are exact, else float32."""
    return _as_bytes(table) if texels_of(table).is_bytes else np.ascontiguousarray(table, "<f4")


def dds(table: np.ndarray) -> bytes:
    """Return a table as the bytes of a DDS texture file with the DX10 header.

    Args:
        table: float32 of shape (height, width, channels), with 1, 2 or 4 channels.
    """
    height, width, channels = table.shape
    data = kept(table)
    head = struct.pack("<7I44x", HEADER, GIVEN, height, width, width * channels * data.itemsize, 0, 1)
    pixels = struct.pack("<2I4s5I", PIXELS, FOUR_LETTERS, b"DX10", 0, 0, 0, 0, 0)
    caps = struct.pack("<5I", IS_TEXTURE, 0, 0, 0, 0)
    kind = (BYTES if data.dtype == np.uint8 else FLOATS)[channels]
    second = struct.pack("<5I", kind, TEXTURE_2D, 0, 1, 0)
    return MAGIC + head + pixels + caps + second + data.tobytes()


def header(tables: Mapping[str, np.ndarray]) -> str:
    """Return tables as the text of C arrays, sorted by name: row by row, with the channels of a texel together."""
    return "\n".join([*(_array_text(name, tables[name]) for name in sorted(tables))])


def _array_text(name: str, table: np.ndarray) -> str:
    texels, data = texels_of(table), kept(table)
    suffix, kind = ("", "unsigned char") if texels.is_bytes else ("f", "float")
    rows = (line for row in data for line in _lines(f"{number!s}{suffix}" for number in row.ravel()))
    numbers = f"{texels.channels} {'number' if texels.channels == 1 else 'numbers'}"
    size = f"{texels.height} rows of {texels.width} texels of {numbers}{', multiples of 1/255' * texels.is_bytes}"
    return "\n".join([f"// {size}.", f"static const {kind} {name}[{table.size}] = {{", *rows, "};", ""])


def _lines(numbers: Iterable[str]) -> list[str]:
    text = ", ".join(numbers) + ","
    return textwrap.wrap(text, WIDTH, initial_indent=INDENT, subsequent_indent=INDENT)


def table_lines(tables: Mapping[str, np.ndarray]) -> list[str]:
    """Return the lines about tables in the head of a file, one line per table."""
    held = {name: texels_of(table) for name, table in tables.items()}
    return [
        f"Table: {name}, {texels.width} x {texels.height} texels of {texels.format}, {texels.bytes / KB:.4g} kB."
        for name, texels in held.items()
    ]


def table_files(tables: Mapping[str, np.ndarray], language: str, stem: str, prefix: str) -> dict[str, bytes]:
    """Return the contents of the table files next to a file in a language, by file name: for C one header with all
    tables, else a DDS file for each table, named after `stem` and the table without the prefix; {} without tables."""
    if not tables:
        return {}
    if language == "c":
        return {f"{stem}_tables.h": header(tables).encode()}
    return {f"{stem}_{name.removeprefix(f'{prefix}_')}.dds": dds(table) for name, table in tables.items()}
