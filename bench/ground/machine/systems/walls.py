"""The walls of Landlock that programs need: a compiler, another tool, this Python, and a compiled program."""

from __future__ import annotations

import os
import shutil
import struct
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ...output.errors import MissingError
from .. import children
from . import landlock

NONE = "Landlock: none; C generated from your files is not run here"
# Where systems keep libraries and what compilers include; what is not there is left out. Nix has all in one folder.
LIBRARIES = ("/lib", "/lib32", "/lib64", "/libx32", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/libx32")
LIBRARIES += ("/usr/local/lib", "/nix/store", "/etc/ld.so.cache", "/dev/zero", "/dev/urandom")
HEADERS = ("/usr/include", "/usr/local/include", "/usr/share/gcc")
WRITTEN = ("/dev/null",)
# What a driver of compilers starts, by the names that it knows.
PARTS = ("cc1", "cc1plus", "collect2", "as", "ld")
SECONDS = 60


@dataclass(frozen=True)
class Wall:
    """The files that a process may use: see `landlock.restrict`. Walls are combined with `|`."""

    reads: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    executes: tuple[str, ...] = ()

    def __or__(self, other: Wall) -> Wall:
        """Return a wall that allows everything that either wall allows."""
        kinds = zip(*((wall.reads, wall.writes, wall.executes) for wall in (self, other)), strict=True)
        return Wall(*(tuple(dict.fromkeys((*own, *more))) for own, more in kinds))

    def around(self, words: Sequence[str]) -> list[str]:
        """Return a command that runs `words` behind this wall; the first word is replaced by the program's path. See
        `landlock.command`."""
        program = shutil.which(words[0]) or words[0]
        return landlock.command([program, *words[1:]], [*self.reads], [*self.writes], [*self.executes])

    def restrict(self) -> None:
        """Put this process behind this wall. Raises OSError and RuntimeError, as `landlock.restrict` does."""
        landlock.restrict([*self.reads], [*self.writes], [*self.executes])


def require() -> None:
    """Raise MissingError if this system does not support walls."""
    if not landlock.is_available():
        raise MissingError(NONE)


def of_program(path: Path | str) -> Wall:
    """Return the wall for a program, which may use the system's libraries and start itself again."""
    loader = _loader(path)
    return Wall(LIBRARIES, WRITTEN, (str(path), *filter(None, [loader])))


def of_tool(path: Path | str) -> Wall:
    """Return the wall for a tool: the files that `of_program` allows and, unless the tool's folder is directly in
    /usr, that folder and the folders lib and lib64 next to it."""
    folder = Path(path).resolve().parent
    own = (folder, *(folder.parent / name for name in ("lib", "lib64")))
    return of_program(path) | Wall(_spared(own) if folder.parent != Path("/usr") else ())


@cache
def of_c_compiler(tool: str) -> Wall:
    """Return the wall for a C or C++ compiler that compiles and links: the parts, headers and libraries that it
    names."""
    parts = [shutil.which(_said(tool, f"-print-prog-name={name}")) for name in PARTS]
    lines = [line.partition(":") for line in _said(tool, "-print-search-dirs").splitlines()]
    places = [place for name, _, text in lines if name != "programs" for place in text.strip(" =").split(os.pathsep)]
    wall = of_tool(shutil.which(tool) or tool) | Wall((*HEADERS, *_spared(map(Path, places))))
    for part in filter(None, parts):
        wall |= of_program(part)
    return wall


def of_python() -> Wall:
    """Return the wall for this Python: its own folders, the folders that it imports from, and this program's
    folder."""
    package = Path(__file__).parents[4]
    folders = (sys.prefix, sys.base_prefix, *filter(os.path.isabs, sys.path), *Path(sys.executable).parents[:1])
    return of_program(sys.executable) | Wall(_spared((package, *map(Path, folders))))


def _spared(paths: Iterable[Path]) -> tuple[str, ...]:
    """Return the absolute paths that exist, resolved, without duplicates and without folders that contain the home
    folder."""
    home = Path.home().resolve()
    resolved = dict.fromkeys(str(path.resolve()) for path in paths if path.is_absolute() and path.exists())
    return tuple(path for path in resolved if not home.is_relative_to(path))


def _said(tool: str, option: str) -> str:
    return children.finished([tool, option], SECONDS).stdout.strip()


def _loader(path: Path | str) -> str:
    """Return the path of the library loader that a 64-bit ELF program names; empty for anything else."""
    with suppress(OSError, struct.error, ValueError), Path(path).open("rb") as file:
        head = file.read(64)
        (start,), (size, count) = struct.unpack_from("<Q", head, 32), struct.unpack_from("<HH", head, 54)
        for number in range(count if head[:5] == b"\x7fELF\x02" else 0):
            file.seek(start + number * size)
            kind, _, place, _, _, length, *_ = struct.unpack("<IIQQQQQQ", file.read(56))
            if kind == 3:  # PT_INTERP of elf.h
                file.seek(place)
                return file.read(length).rstrip(b"\0").decode()
    return ""
