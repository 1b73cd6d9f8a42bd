"""The cost of a codec from the rows of the cost table: its encoding, its storage and its sign bits together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ....encodings.codecs.codec import Codec
from ....gbuffer.defines.packings import SIGN, packing_of
from .measure import PACKING_OPERATIONS, Row

KEY = ("measure", "family", "stage", "operation", "encoding", "storage")


class LeftOutError(Exception):
    """The reason why a codec's cost is not known, in a few words."""


@dataclass(frozen=True)
class Where:
    """The measure of a cost, and the GPU family and shader stage that the compilers target."""

    measure: str
    family: str | None
    stage: str | None


@dataclass(frozen=True)
class CostSum:
    """A total cost, and whether it counts both sides of a branch."""

    cost: float
    branches: bool


class Costs:
    """Rows of the cost table, from which the costs of codecs are added up."""

    def __init__(self, rows: Iterable[Row]):
        self._rows = {tuple(row.get(part) for part in KEY): row for row in rows}

    def of(self, codec: Codec, where: Where, operation: str, column: str) -> CostSum:
        """Return the cost of encoding or decoding with a codec, as the sum of a column over its parts.

        Raises:
            LeftOutError: the codec does not fit in its storage, or the cost of a part is not known or counts a loop
                only once.
        """
        rows = [(sign, self._known_row(key, column)) for sign, key in self._parts(codec, where, operation)]
        cost = sum(sign * row[column] for sign, row in rows)
        return CostSum(cost, any(row.get("branches") for _, row in rows))

    def _parts(self, codec: Codec, where: Where, operation: str) -> list[tuple[int, tuple[Any, ...]]]:
        """Return the keys of the rows whose sum is the cost of a codec's operation, each with its sign, 1 or -1.
        Raises LeftOutError if the codec does not fit in its storage."""
        kind, packed = (where.measure, where.family, where.stage), PACKING_OPERATIONS[operation]
        if codec.misfit:
            raise LeftOutError(f"it does not fit in {codec.storage.name}: {codec.misfit}")
        name = codec.encoding.name
        parts = [(1, (*kind, operation, name, None)), (1, (*kind, packed, None, packing_of(codec).name))]
        if codec.encoding.sign_bits:
            parts += [(sign, (*kind, packed, None, packing.name)) for sign, packing in zip((1, -1), SIGN, strict=True)]
        return parts

    def _known_row(self, key: tuple[Any, ...], column: str) -> Row:
        *_, operation, encoding, storage = key
        row = self._rows.get(key)
        if row is None or row.get(column) is None:
            raise LeftOutError("its cost is not known" if encoding else f"the cost of {storage} is not known")
        if row.get("loops"):
            raise LeftOutError(f"{encoding or storage} {operation} contains a loop, which is counted only once")
        return row
