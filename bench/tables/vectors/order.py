"""The order of codecs of motion vectors."""

from __future__ import annotations

from ....encodings.catalogue import MOTION_ENCODINGS
from ....encodings.storages.storage import MOTION_STORAGES
from ..table import Row


def place(row: Row) -> tuple[int, ...]:
    """Return the position of a row's codec in the catalogues; codecs that the catalogues lack come last."""
    lists = (list(MOTION_ENCODINGS), list(MOTION_STORAGES))
    names = (row["encoding"], row["storage"])
    return tuple(known.index(name) if name in known else len(known) for known, name in zip(lists, names, strict=True))
