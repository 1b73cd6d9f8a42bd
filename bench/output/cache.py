"""What was computed once and holds for good, kept in the user's cache folder: one file for each key."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Set for this process and its children where nothing is to be read from the cache, or kept in it.
OFF = "NORMALBENCH_NO_CACHE"


def switch_off() -> None:
    """Do without the cache from here on, in this process and in those that it starts."""
    os.environ[OFF] = "1"


def is_off() -> bool:
    """Whether the cache is not to be used."""
    return bool(os.environ.get(OFF))


def folder() -> Path:
    """Where the cache lies: under XDG_CACHE_HOME, or ~/.cache."""
    home = os.environ.get("XDG_CACHE_HOME", "")
    # The XDG specification has relative paths ignored.
    return (Path(home) if Path(home).is_absolute() else Path("~/.cache").expanduser()) / "normalbench"


def key_of(*parts: str | bytes) -> str:
    """A key that differs wherever one of the parts does."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        digest.update(f"{len(data)}:".encode() + data)
    return digest.hexdigest()


def read(key: str) -> dict[str, Any] | None:
    """The value of a key, or None where there is none, or it is not what was written."""
    if is_off():
        return None
    try:
        kept = json.loads(_path(key).read_text(encoding="utf-8"))
        value = kept["value"]
        is_whole = kept["key"] == key and kept["digest"] == _digest(value)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return value if is_whole and isinstance(value, dict) else None


def kept(key: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """The value of a key, or what is made now, and kept where the key is not empty."""
    found = read(key) if key else None
    if found is None:
        found = make()
        if key:
            write(key, found)
    return found


def _digest(value: Any) -> str:
    return key_of(json.dumps(value, sort_keys=True))


def write(key: str, value: dict[str, Any]) -> None:
    """Keep a value. Readers see the old file or the new one; a folder that cannot be written is no error."""
    if is_off():
        return
    path = _path(key)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=path.parent, encoding="utf-8", delete=False) as file:
            try:
                json.dump({"key": key, "digest": _digest(value), "value": value}, file)
                file.close()
                Path(file.name).replace(path)
            finally:
                Path(file.name).unlink(missing_ok=True)
    except OSError:
        return


def _path(key: str) -> Path:
    return folder() / key[:2] / f"{key}.json"
