"""Arrays from files that may be damaged: their sizes are checked before memory is allocated for them."""

from __future__ import annotations

import errno
import io
import math
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ....encodings.codecs.files import FileError, file_bytes

# Of an archive's arrays together; the largest that this program writes is a few megabytes.
MOST_BYTES = 64 << 20
HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


class DamagedError(ValueError):
    """A file is not what it declares to be."""


def array_of(data: bytes) -> np.ndarray:
    """Return the array in the bytes of an .npy file. Raises DamagedError if the bytes are anything else."""
    try:
        file = io.BytesIO(data)
        shape, is_fortran, dtype = HEADERS[np.lib.format.read_magic(file)](file)
        if dtype.hasobject or math.prod(shape) * dtype.itemsize != len(data) - file.tell():
            raise DamagedError("its size does not match its header")
        return np.frombuffer(data, dtype, offset=file.tell()).reshape(shape, order="F" if is_fortran else "C")
    except Exception as error:  # a header is Python source: of a damaged one anything may come
        raise DamagedError("it is damaged") from error


def _bytes(path: Path, most: int) -> bytes:
    try:
        return file_bytes(path, most)
    except FileError as error:
        if error.errno == errno.EFBIG:
            raise DamagedError(f"it is larger than {most} bytes") from error
        raise


def read_npy(path: Path, most: int) -> np.ndarray:
    """Return the array in an .npy file of at most `most` bytes. Raises OSError or DamagedError."""
    return array_of(_bytes(path, most))


def read_npz(path: Path, names: Sequence[str], most: int = MOST_BYTES) -> list[np.ndarray]:
    """Return the arrays with these names from an .npz file, in the order of the names. Raises OSError, or
    DamagedError if they are missing, damaged, or more than `most` bytes in all."""
    data = _bytes(path, most)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = [archive.getinfo(f"{name}.npy") for name in names]
            if sum(info.file_size for info in infos) > most:
                raise DamagedError(f"it would unpack to more than {most} bytes")
            return [array_of(archive.read(info)) for info in infos]
    except Exception as error:  # of a dozen kinds, by what is damaged
        raise DamagedError("it is damaged") from error
