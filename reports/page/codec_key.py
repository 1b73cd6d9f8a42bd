"""What tells codecs apart in rows."""

from __future__ import annotations

from typing import Any, NamedTuple


class CodecKey(NamedTuple):
    """What tells codecs apart in rows."""

    encoding: str
    storage: str
    rounding: str

    @classmethod
    def of(cls, row: dict[str, Any]) -> CodecKey:
        """The codec of a row, which rounds to the nearest unless the row says otherwise."""
        return cls(str(row.get("encoding")), str(row.get("storage")), str(row.get("rounding") or "nearest"))

    @property
    def label(self) -> str:
        """What a reader calls it."""
        return " ".join([self.encoding, self.storage, *([self.rounding] if self.rounding != "nearest" else [])])
