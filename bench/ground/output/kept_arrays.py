"""Arrays that take long to make, kept in the user's cache folder: one NPZ file per key."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

import numpy as np

from . import cache

Arrays = Mapping[str, np.ndarray]


def kept_arrays(key: str, make: Callable[[], Arrays]) -> Arrays:
    """Return the cached arrays for a key, or make and cache them. A folder that cannot be written to is not an error.

    Args:
        key: lower-case hexadecimal digits, which must differ for different arrays.
    """
    path = cache.folder() / "arrays" / f"{key}.npz"
    arrays = None if cache.is_off() else _read(path)
    if arrays is None:
        arrays = make()
        if not cache.is_off():
            with suppress(OSError):
                cache.put(path, _packed(arrays))
    return arrays


def _read(path: Path) -> Arrays | None:
    """Return the arrays in a file; None if the file is missing, another user may have written it, or its checksum is
    wrong."""
    if not cache.is_private(path):
        return None
    try:
        # np.load would leave a file open that is no archive, and read other kinds.
        with path.open("rb") as stream, np.lib.npyio.NpzFile(stream, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, KeyError, EOFError, NotImplementedError, zipfile.BadZipFile):
        return None


def _packed(arrays: Arrays) -> bytes:
    data = io.BytesIO()
    np.savez(data, **arrays)  # pyright: ignore[reportArgumentType] # no array is called like an option of savez
    return data.getvalue()
