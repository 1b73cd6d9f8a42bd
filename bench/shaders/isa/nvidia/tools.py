"""The paths of NVIDIA's CUDA compiler and disassembler on this machine, from pip packages or an installed CUDA."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from functools import cache
from importlib.metadata import distributions
from importlib.util import find_spec
from pathlib import Path

from ....ground.output import cache as kept
from ..compiler import MissingDriverError, fingerprint

INSTALL = "install it (python -m pip install 'normalbench[nvidia]')"
NO_COMPILER = f"no CUDA compiler: libnvrtc was not found; {INSTALL}"
NO_DISASSEMBLER = f"no CUDA disassembler: nvdisasm was not found; {INSTALL}"
# `libnvrtc.so.12`, not `libnvrtc-builtins.so.12.9` or `libnvrtc.alt.so.12`.
LIBRARY = re.compile(r"libnvrtc\.so(\.[\d.]+)?$")
# A variable names an installed CUDA; pip's packages lie in folders of the package `nvidia`.
HOMES = ("CUDA_HOME", "CUDA_PATH")
SECONDS = 10


def library() -> Path | None:
    """Return the path of NVRTC's shared library; None if it is not found."""
    folders = (folder / part for folder in _folders() for part in ("lib", "lib64", "targets/x86_64-linux/lib"))
    return next((path for folder in folders for path in _libraries(folder)), None)


def disassembler() -> Path | None:
    """Return the path of the program nvdisasm; None if it is not found."""
    programs = (shutil.which("nvdisasm", path=str(folder / "bin")) for folder in _folders())
    named = next(filter(None, programs), None) or shutil.which("nvdisasm")
    return Path(named) if named else None


def _folders() -> Iterator[Path]:
    """Yield the folders that may contain parts of CUDA: those of pip packages, then those of an installed CUDA."""
    package = find_spec("nvidia")
    for root in (package.submodule_search_locations or ()) if package else ():
        yield from sorted(path for path in Path(root).glob("*") if path.is_dir())
    yield from (Path(os.environ[name]) for name in HOMES if os.environ.get(name))


def _libraries(folder: Path) -> list[Path]:
    # The shortest name is the one that programs link to.
    paths = (path for path in folder.glob("libnvrtc.so*") if LIBRARY.match(path.name))
    return sorted(paths, key=lambda path: (len(path.name), path.name))


def missing() -> str:
    """Return a one-line message on what this machine lacks; empty if nothing is missing."""
    return NO_COMPILER if not library() else NO_DISASSEMBLER if not disassembler() else ""


def found() -> tuple[Path, Path]:
    """Return the paths of NVRTC's library and of nvdisasm. Raises MissingDriverError if either is not found."""
    compiler, lister = library(), disassembler()
    if not compiler or not lister:
        raise MissingDriverError(missing())
    return compiler, lister


def identity() -> str:
    """Return a key that changes with either tool or with the code that uses their results.
    Raises MissingDriverError."""
    compiler, lister = found()
    builtins = sorted(compiler.parent.glob("libnvrtc-builtins.so*"))
    own = sorted(path for path in Path(__file__).parent.glob("*.py"))
    return kept.key_of(*map(fingerprint, (compiler, lister, *builtins)), *(path.read_text("utf-8") for path in own))


def title(number: str) -> str:
    """Return one text with both tools' names and versions. Raises MissingDriverError.

    Args:
        number: NVRTC's own version number, used if its library is not from a pip package."""
    compiler, lister = found()
    compiler_title = f"NVRTC {_package_version(compiler) or number} (CUDA's compiler, not the graphics driver's)"
    return f"{compiler_title}, nvdisasm {_version(lister)}"


@cache
def _package_version(path: Path) -> str:
    """Return the version of the NVRTC pip package that contains a file; empty if no such package does."""
    for package in distributions():
        name = package.metadata["Name"] or ""
        if name.startswith("nvidia-cuda-nvrtc") and any(package.locate_file(f) == path for f in package.files or ()):
            return package.version
    return ""


@cache
def _version(lister: Path) -> str:
    try:
        done = subprocess.run(
            [lister, "--version"], capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS
        )
    except (OSError, subprocess.TimeoutExpired):
        return "(unknown version)"
    match = re.search(r"\bV(\d+(?:\.\d+)+)", done.stdout)
    return match[1] if match else "(unknown version)"
