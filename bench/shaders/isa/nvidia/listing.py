"""Listings of several kernels' machine code by one nvdisasm process, which takes a fifth of a second to start."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ..compiler import DriverError
from .sass import SIZE

SECONDS = 8
_PLACE = re.compile(r"^\s*/\*([0-9a-f]+)\*/")
# What has a place in the code among its operands.
_JUMP = re.compile(r"\b(?:BRA|BSSY|JMP|CALL|WARPSYNC|BREAK)\b[^;]*?(0x[0-9a-f]+)(?=[ ;)])")


def listings(codes: Sequence[bytes], architecture: str, program: Path) -> list[str]:
    """Return nvdisasm's listing of each kernel, with addresses relative to the kernel's start.

    Args:
        codes: the machine code of each kernel.
        architecture: the GPU architecture, such as sm_86.
        program: the path of nvdisasm.

    Raises:
        DriverError: nvdisasm fails, or does not list everything."""
    with tempfile.NamedTemporaryFile(suffix=".bin") as file:
        file.write(b"".join(codes))
        file.flush()
        # Machine code alone: of a whole file it also analyses what it lists, for twice the time.
        command = [program, "-hex", "-b", architecture.upper().replace("_", ""), file.name]
        try:
            done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise DriverError(f"nvdisasm: {error}") from error
    if done.returncode:
        errors = [line for line in done.stderr.splitlines() if line.strip()]
        message = errors[0][:200] if errors else "no message"
        raise DriverError(f"nvdisasm ended with status {done.returncode}: {message}")
    return _parted(done.stdout.splitlines(), [len(code) for code in codes])


def _parted(lines: Sequence[str], sizes: Sequence[int]) -> list[str]:
    """Return nvdisasm's lines as one text per kernel, split according to the kernels' sizes in bytes. Raises
    DriverError if the lines do not match the sizes."""
    starts = [sum(sizes[:i]) for i in range(len(sizes) + 1)]
    parts: list[list[str]] = [[] for _ in sizes]
    index, is_inside = 0, False
    for line in lines:
        if match := _PLACE.match(line):
            place, is_inside = int(match[1], 16), True
            while place >= starts[index + 1]:
                index += 1
            line = _relative_line(line, place, starts[index])
        if is_inside:
            parts[index].append(line)
    if any(
        sum(bool(_PLACE.match(line)) for line in some) * SIZE != size for some, size in zip(parts, sizes, strict=True)
    ):
        raise DriverError("nvdisasm did not list all instructions")
    return ["\n".join(some) + "\n" for some in parts]


def _relative_line(line: str, place: int, start: int) -> str:
    """Return a line of a listing with its address, and that of its jump target, relative to the kernel's start."""
    line = line.replace(f"/*{place:04x}*/", f"/*{place - start:04x}*/", 1)
    code, mark, words = line.partition(";")
    if jump := _JUMP.search(code + ";"):
        first, last = jump.span(1)
        code = f"{code[:first]}{hex(int(jump[1], 16) - start)}{code[last:]}"
    return code + mark + words
