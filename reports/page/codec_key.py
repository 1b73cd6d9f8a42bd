"""The values that identify a codec in rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class CodecKey(NamedTuple):
    """The encoding, storage and rounding of a codec, which identify it in rows."""

    encoding: str
    storage: str
    rounding: str

    @classmethod
    def of(cls, row: Mapping[str, Any]) -> CodecKey:
        """Return the codec of a row; it rounds to nearest unless the row has another rounding."""
        return cls(str(row.get("encoding")), str(row.get("storage")), str(row.get("rounding") or "nearest"))

    @classmethod
    def said_by(cls, row: Mapping[str, Any]) -> CodecKey | None:
        """Return the codec of a row from any table, as `of` does; None if the row names no encoding or no storage."""
        return cls.of(row) if row.get("encoding") and row.get("storage") else None

    @property
    def label(self) -> str:
        """The encoding, the storage and, unless it is to nearest, the rounding, separated by spaces."""
        return " ".join([self.encoding, self.storage, *([self.rounding] if self.rounding != "nearest" else [])])
