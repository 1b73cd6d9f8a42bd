"""Results that are computed once and stay valid, kept in the user's cache folder: one file per key.

Some results are machine code that this process loads, and all results determine figures. Therefore nothing is read
that another user may have written.
"""

from __future__ import annotations

import atexit
import functools
import hashlib
import json
import os
import shutil
import stat
import tempfile
from collections.abc import Callable
from contextlib import suppress
from errno import EACCES
from pathlib import Path
from typing import Any

from ..machine.systems.files import cache_home, forbids_execution, is_closed, is_guarded, is_own, moved_over
from .errors import MissingError

# The cache is for its user alone.
PRIVATE = 0o700
# Set for this process and its children where nothing is to be read from the cache, or kept in it.
OFF, ANEW = "NORMALBENCH_NO_CACHE", "NORMALBENCH_ANEW"


def switch_off() -> None:
    """Switch the cache off from now on, in this process and in processes that it starts."""
    os.environ[OFF] = "1"


def measure_anew() -> None:
    """Have figures measured again even if they are cached, in this process and in processes that it starts."""
    os.environ[ANEW] = "1"


def is_off() -> bool:
    """Whether the cache is switched off."""
    return bool(os.environ.get(OFF))


def folder() -> Path:
    """Return the cache folder: under XDG_CACHE_HOME, or in this system's folder for caches."""
    home = os.environ.get("XDG_CACHE_HOME", "")
    # The XDG specification has relative paths ignored.
    return (Path(home) if Path(home).is_absolute() else cache_home()) / "normalbench"


def make_folder(path: Path) -> None:
    """Make a folder of the cache, and the folders above it, for this user only.

    If others could write into a folder until now, it is closed to them, and their entries are removed.

    Raises:
        OSError: the folder cannot be made, or belongs to another user.
    """
    for directory in reversed((path, *path.parents)):
        if not directory.is_dir():
            # Something else of that name is an error.
            directory.mkdir(PRIVATE, exist_ok=not directory.is_symlink())
        elif directory.is_relative_to(folder()) and not is_closed(directory.stat()):
            _close(directory)


def _close(path: Path) -> None:
    """Close a folder to other users and remove their entries. Raises PermissionError if the folder belongs to another
    user: even root does not use other users' folders."""
    if not is_own(path.stat()):
        raise PermissionError(EACCES, "another user's folder", str(path))
    path.chmod(PRIVATE)
    for entry in path.iterdir():
        if not is_own(entry.lstat()):
            shutil.rmtree(entry) if entry.is_dir() and not entry.is_symlink() else entry.unlink()


def require_folder() -> None:
    """Raise MissingError if the cache is off, or its folder cannot be made."""
    if is_off():
        raise MissingError(f"{OFF} is set")
    try:
        make_folder(folder())
    except OSError as error:
        raise MissingError(f"{error.strerror or error}: {folder()}; name another folder with XDG_CACHE_HOME") from error


def keep_only_files(path: Path) -> None:
    """Remove everything except files from a folder that other programs read by file name, because these programs
    would wait for a pipe, and never finish reading a device. Raises OSError."""
    with os.scandir(path) as entries:
        for entry in entries:
            if not entry.is_file(follow_symlinks=False):
                shutil.rmtree(entry) if entry.is_dir(follow_symlinks=False) else Path(entry).unlink()


def is_private(path: Path) -> bool:
    """Whether a file exists that only this user can have written or put there."""
    above = [parent for parent in path.parents if parent.is_relative_to(folder())]
    try:
        status = path.lstat()
        # A pipe would be waited for, and a device read without an end.
        return stat.S_ISREG(status.st_mode) and is_closed(status) and all(is_closed(parent.stat()) for parent in above)
    except OSError:
        return False


def loadable(path: Path) -> Path | None:
    """Return the path of a file to load as code, without links. Return None if anyone but this user and root can have
    written or can replace the file: see `is_private`, and `is_guarded`, which also checks all folders above the
    cache."""
    try:
        whole = path.resolve()
        return whole if is_private(path) and is_guarded(whole) else None
    except OSError:
        return None


def keeps_code() -> bool:
    """Whether the cache may hold code to be loaded: nobody else can replace its folder.

    The cache itself is closed to others when something is put into it.
    """
    try:
        return is_guarded(folder().resolve().parent)
    except OSError:
        return False


@functools.cache
def folder_of_this_process() -> Path:
    """Return a folder for files that cannot be in the cache; the folder is deleted when the process ends."""
    path = tempfile.mkdtemp(prefix="normalbench-")
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return Path(path)


def folder_to_execute_from() -> Path:
    """Return the cache, or a folder of this process if the cache is on a file system that forbids execution or in a
    folder that others can write to.

    Raises:
        OSError: the cache cannot be made, or belongs to another user.
    """
    make_folder(folder())
    return folder_of_this_process() if forbids_execution(folder()) or not keeps_code() else folder()


def key_of(*parts: str | bytes) -> str:
    """Return a key, a hexadecimal digest, that differs if any of the parts differs."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        digest.update(f"{len(data)}:".encode() + data)
    return digest.hexdigest()


def read(key: str) -> dict[str, Any] | None:
    """Return the cached value for a key; None if the value is missing, damaged or not private, or the cache is
    off."""
    if is_off():
        return None
    try:
        if not is_private(_path(key)):
            return None
        kept = json.loads(_path(key).read_text(encoding="utf-8"))
        value = kept["value"]
        is_whole = kept["key"] == key and kept["digest"] == _digest(value)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return value if is_whole and isinstance(value, dict) else None


def figures(key: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """Return the figures for a key as `kept` does, but make them again after `measure_anew`."""
    return _found_or_made(read_figures(key), key, make)


def read_figures(key: str) -> dict[str, Any] | None:
    """Return the cached figures for a key; None if they are missing, or after `measure_anew`."""
    return None if os.environ.get(ANEW) or not key else read(key)


def kept(key: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """Return the cached value for a key. If the value is missing, or the key is empty, make the value, and cache it
    unless the key is empty."""
    return _found_or_made(read(key) if key else None, key, make)


def _found_or_made(content: dict[str, Any] | None, key: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    if content is None:
        content = make()
        if key:
            write(key, content)
    return content


def _digest(value: Any) -> str:
    return key_of(json.dumps(value, sort_keys=True))


def write(key: str, value: dict[str, Any]) -> None:
    """Cache a value under a key; a folder that cannot be written to is not an error."""
    if not is_off():
        with suppress(OSError):
            put(_path(key), json.dumps({"key": key, "digest": _digest(value), "value": value}).encode())


def put(path: Path, data: bytes) -> None:
    """Write a file into the cache in one step, so that readers see either the old or the new file. Raises OSError."""
    make_folder(path.parent)
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
        try:
            file.write(data)
            file.close()
            moved_over(Path(file.name), path)
        finally:
            Path(file.name).unlink(missing_ok=True)


def _path(key: str) -> Path:
    return folder() / key[:2] / f"{key}.json"
