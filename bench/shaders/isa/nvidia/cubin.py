"""The output of NVIDIA's compiler, a 64-bit ELF file: a kernel's machine code, registers and stack."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from ..compiler import DriverError

TEXT, ABOUT = b".text.", b".nv.info"
# A section's header (ELF-64): name, type, flags, address, place, size, link, info, alignment, size of an entry.
SECTION = struct.Struct("<IIQQQQIIQQ")
# `.nv.info` is a list of attributes: format, number, and a size, or a value where the format is not SIZED. Of these two
# the words are the function's symbol and the figure. Numbers are those that cuobjdump names EIATTR_REGCOUNT and
# EIATTR_FRAME_SIZE.
SIZED, REGISTERS, STACK = 4, 0x2F, 0x11


@dataclass(frozen=True)
class Kernel:
    """A kernel's machine code, registers per lane and stack size in bytes. Numbers that the file lacks are None."""

    code: bytes
    registers: int | None
    stack: int | None


def kernel_of(cubin: bytes) -> Kernel:
    """Return the kernel in an ELF file. Raises DriverError unless the file is valid and has exactly one function."""
    try:
        sections = list(_sections(cubin))
        code = [data for name, data in sections if name.startswith(TEXT)]
        about = dict(pair for name, data in sections if name == ABOUT for pair in _attributes(data))
    except (struct.error, IndexError, ValueError, OverflowError) as error:
        raise DriverError(f"NVRTC's output is not a known ELF file: {error}") from error
    if len(code) != 1:
        raise DriverError(f"NVRTC's output has {len(code)} functions: calls are not counted")
    return Kernel(code[0], about.get(REGISTERS), about.get(STACK))


def _sections(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield (name, contents) for each section in a 64-bit ELF file. Raises ValueError for any other file."""
    if data[:5] != b"\x7fELF\x02":
        raise ValueError("not a 64-bit ELF file")
    (start,) = struct.unpack_from("<Q", data, 0x28)
    size, count, names = struct.unpack_from("<HHH", data, 0x3A)
    headers = [SECTION.unpack_from(data, start + i * size) for i in range(count)]
    strings = headers[names][4]
    for name, _, _, _, place, length, *_ in headers:
        offset = strings + name
        yield data[offset : data.index(b"\0", offset)], data[place : place + length]


def _attributes(data: bytes) -> Iterator[tuple[int, int]]:
    """Yield (number, value) for each attribute with two words of data; the value is the second word."""
    offset = 0
    while offset < len(data):
        kind, number, size = struct.unpack_from("<BBH", data, offset)
        if kind == SIZED and size == 8:
            yield number, struct.unpack_from("<II", data, offset + 4)[1]
        offset += 4 + (size if kind == SIZED else 0)
