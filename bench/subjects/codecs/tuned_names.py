"""Variants of encodings by name: `stereographic:scale=1.31`, `octahedral:axis=y`, `best_fit:table=scales.npy`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.files import called
from ....encodings.codecs.variants import MARK, TABLE, known_settings, settings_in, variant
from ...ground.choose import unknown_name
from ...ground.output.arrays import DamagedError, read_npy
from ...ground.output.errors import UsageError
from ...ground.spelling import spelled


def tuned(word: str) -> Encoding:
    """Return the encoding for a name with parameters, such as `stereographic:scale=1.31`.

    The parameter `table` names a file that replaces the encoding's own lookup table.

    Raises:
        UsageError: the encoding or a parameter is unknown, a value is invalid or out of range, or the file is not a
            table.
    """
    typed_name = word.partition(MARK)[0]
    name = spelled("encoding", typed_name, ENCODINGS)
    if name is None:
        raise UsageError(f"{word}: {unknown_name('encoding', [typed_name], ENCODINGS)}")
    encoding = ENCODINGS[name]
    try:
        _, values = settings_in(word)
    except ValueError as error:
        raise UsageError(
            f"{word}: give each parameter once after {name}, such as {_example_setting(encoding)}"
        ) from error
    table = values.pop(TABLE, None) if encoding.look_up else None
    try:
        encoding = variant(encoding, values)
    except ValueError as error:
        raise UsageError(f"{word}: {error}") from error
    if table is None:
        return encoding
    return encoding.with_table(_read_table(Path(table), encoding), called(Path(table).name))


def _example_setting(encoding: Encoding) -> str:
    known = [f"{encoding.name}{MARK}{key}={value}" for key, value in known_settings(encoding).items()]
    return known[0] if known else f"NAME:KEY=VALUE; {encoding.name} has no parameters"


def _read_table(path: Path, encoding: Encoding) -> np.ndarray:
    assert encoding.look_up
    published = encoding.tables()[encoding.look_up.sampler]
    try:
        # With room for a header.
        table = read_npy(path, published.nbytes + 4096)
    except DamagedError as error:
        raise UsageError(f"{path}: not a NumPy file of numbers; use a file from `normalbench tune --table`") from error
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from error
    if table.shape != published.shape or table.dtype != published.dtype:
        wanted = f"{published.dtype} of shape {published.shape}"
        raise UsageError(f"{path}: {encoding.name} needs a table of {wanted}, as `normalbench tune --table` writes it")
    if not np.all((table > 0) & (table <= 1)):
        raise UsageError(f"{path}: a table of {encoding.name} must hold scales above 0 and at most 1")
    return table
