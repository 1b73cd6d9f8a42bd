"""The values that identify a codec in rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class CodecKey(NamedTuple):
    """The values that identify a codec in rows: its encoding, storage and rounding."""

    encoding: str
    storage: str
    rounding: str

    @classmethod
    def of(cls, row: Mapping[str, Any]) -> CodecKey:
        """Return the codec of a row, which rounds to nearest unless the row says otherwise."""
        return cls(str(row.get("encoding")), str(row.get("storage")), str(row.get("rounding") or "nearest"))

    @classmethod
    def said_by(cls, row: Mapping[str, Any]) -> CodecKey | None:
        """Return the codec of a row of any table, which rounds to nearest unless the row says otherwise; None if
        the row does not name an encoding and a storage."""
        return cls.of(row) if row.get("encoding") and row.get("storage") else None

    @property
    def label(self) -> str:
        """The encoding, the storage and, unless it is to the nearest, the rounding, with spaces between them."""
        return " ".join([self.encoding, self.storage, *([self.rounding] if self.rounding != "nearest" else [])])
