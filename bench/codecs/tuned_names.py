"""Tuned encodings by name: `stereographic:scale=1.31`, `best_fit:table=scales.npy`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.encoding import Encoding
from ...encodings.codecs.files import called
from ..output.arrays import DamagedError, read_npy
from ..output.errors import UsageError

MARK, TABLE = ":", "table"


def tuned(word: str) -> Encoding:
    """The encoding that a name with parameters stands for.

    Raises:
        UsageError: an unknown encoding or parameter, a value that is none or out of range, a file that is not a table.
    """
    name, *settings = word.split(MARK)
    if name not in ENCODINGS:
        raise UsageError(f"{word}: unknown encoding {name!r}; known: {', '.join(ENCODINGS)}")
    encoding = ENCODINGS[name]
    values: dict[str, str] = {}
    for setting in settings:
        key, is_set, value = setting.partition("=")
        if not (is_set and value) or key in values:
            raise UsageError(f"{word}: after {name} come parameters, each once, such as {_example(encoding)}")
        values[key] = value
    table = values.pop(TABLE, None) if encoding.look_up else None
    if values:
        encoding = encoding.with_parameters({key: _value(word, encoding, key, text) for key, text in values.items()})
    if table is None:
        return encoding
    return encoding.with_table(_read_table(Path(table), encoding), called(Path(table).name))


def parameters_of(encoding: Encoding) -> list[str]:
    """What may be said of an encoding by name."""
    return [*encoding.published, *([TABLE] if encoding.look_up else [])]


def _example(encoding: Encoding) -> str:
    known = [f"{encoding.name}{MARK}{key}={value:g}" for key, value in encoding.published.items()]
    known += [f"{encoding.name}{MARK}{TABLE}=FILE.npy"] if encoding.look_up else []
    return known[0] if known else f"those of others: {encoding.name} has none"


def _value(word: str, encoding: Encoding, key: str, text: str) -> float:
    parameter = next((p for p in encoding.parameters if p.name == key), None)
    if not parameter:
        known = ", ".join(parameters_of(encoding)) or "none"
        raise UsageError(f"{word}: {encoding.name} has no parameter {key!r}; known: {known}")
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not parameter.least <= value <= parameter.most:
        raise UsageError(f"{word}: {key} is a number from {parameter.least:g} to {parameter.most:g}, not {text!r}")
    return value


def _read_table(path: Path, encoding: Encoding) -> np.ndarray:
    assert encoding.look_up
    published = encoding.tables()[encoding.look_up.sampler]
    try:
        # With room for a header.
        table = read_npy(path, published.nbytes + 4096)
    except DamagedError as error:
        raise UsageError(f"{path}: not a NumPy file of numbers, as `normalbench tune --table` writes it") from error
    except OSError as error:
        raise UsageError(f"{path}: {error}") from error
    if table.shape != published.shape or table.dtype != published.dtype:
        wanted = f"{published.dtype} of shape {published.shape}"
        raise UsageError(f"{path}: a table of {encoding.name} is {wanted}, as `normalbench tune --table` writes it")
    if not np.all((table > 0) & (table <= 1)):
        raise UsageError(f"{path}: a table of {encoding.name} holds scales above 0 and up to 1")
    return table
