"""A stand-in for an Intel GPU: null_i915.c, built once into the user's cache folder.

The library's name contains hashes of its sources and of its content. The library is built again if a source changes
or the file is damaged.
"""

from __future__ import annotations

import platform
import tempfile
from pathlib import Path

from ...ground.compilers import tools
from ...ground.compilers.text import own
from ...ground.machine.systems.people import how_to_install
from ...ground.machine.systems.preload import preloaded
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError

SOURCE = Path(__file__).with_name("null_i915.c")
SHARED = SOURCE.with_name("null_drm.h")
COMPILER = tools.C
NO_COMPILER = (
    f"no C compiler: these counts need {COMPILER}; install it ({how_to_install('gcc libc6-dev', counts=True)})"
)
# A build takes a tenth of a second.
SECONDS = 60.0
SAID = "NORMALBENCH_NULL_I915"


class NullDeviceError(Exception):
    """A failure to build the null device; one-line message. `is_missing`: whether something must be installed."""

    def __init__(self, message: str, is_missing: bool = False):
        super().__init__(message)
        self.is_missing = is_missing


def library() -> Path:
    """Return the path of the library that stands in for a GPU; build it if necessary. Raises NullDeviceError."""
    folder = _library_folder()
    stem = f"{SOURCE.stem}-{kept.key_of(SOURCE.read_bytes(), SHARED.read_bytes(), platform.machine())[:16]}"
    return _kept_library(folder, stem) or _built_library(folder, stem)


def _kept_library(folder: Path, stem: str) -> Path | None:
    """Return the path of a library that was built earlier and can be loaded; None if the library must be built."""
    try:
        paths = sorted(folder.glob(f"{stem}-*.so"))
    except OSError:
        return None
    named = (path for path in paths if path.name == _library_name(stem, path))
    return next((path.resolve() for path in named if folder != kept.folder() or kept.loadable(path)), None)


def _library_folder() -> Path:
    """Return a folder for built libraries from which processes can load them."""
    try:
        return kept.folder_to_execute_from()
    except OSError:
        # Building there says why it cannot be.
        return kept.folder()


def variables(words: str) -> dict[str, str]:
    """Return the environment variables with which a process finds the Intel GPU that the text `words` describes.
    Raises NullDeviceError."""
    return preloaded(library()) | {SAID: words}


def _library_name(stem: str, path: Path) -> str:
    """Return a library's expected file name, from the stem and a hash of its content; empty if the file cannot be
    read, or if others may have written it."""
    try:
        return f"{stem}-{kept.key_of(path.read_bytes())[:16]}.so" if kept.is_private(path) else ""
    except OSError:
        return ""


def _built_library(folder: Path, stem: str) -> Path:
    try:
        kept.make_folder(folder)
        # Others see a whole file or none: it is moved there once it is complete.
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            whole = Path(scratch) / "library.so"
            _compile(whole)
            path = folder / _library_name(stem, whole)
            whole.replace(path)
            return path.resolve()
    except OSError as error:
        message = f"the null device cannot be written into the cache folder {folder}: {error.strerror or error}"
        raise NullDeviceError(f"{message}; set XDG_CACHE_HOME to another folder") from error


def _compile(path: Path) -> None:
    files = {SOURCE.name: own(SOURCE), SHARED.name: own(SHARED)}
    words = ["-O1", "-shared", "-fPIC", "-o", path.name, SOURCE.name]
    try:
        done = tools.run(COMPILER, words, path.parent, files, SECONDS)
    except MissingError as error:
        raise NullDeviceError(NO_COMPILER, is_missing=True) from error
    except tools.ToolError as error:
        raise NullDeviceError(f"{error} for {SOURCE.name}") from error
    if done.status or not path.exists():
        last = [line.strip() for line in done.err.splitlines() if line.strip()][-1:]
        message = f"{COMPILER} cannot compile {SOURCE.name}: {last[0][:200] if last else f'status {done.status}'}"
        raise NullDeviceError(
            f"{message}; libc's headers may be missing ({how_to_install('gcc libc6-dev', counts=True)})"
        )
