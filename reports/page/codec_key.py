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
        """The codec of a row."""
        return cls(*(str(row.get(name)) for name in cls._fields))

    @property
    def label(self) -> str:
        """What a reader calls it."""
        return " ".join([self.encoding, self.storage, *([self.rounding] if self.rounding != "nearest" else [])])
