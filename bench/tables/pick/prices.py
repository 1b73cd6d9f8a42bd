"""Costs of codecs: executed issue slots, on the most expensive of several GPU families."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ....encodings.codecs.codec import Codec
from ....gbuffer.defines.packings import packing_of
from ...ground.options.gpu_families import usual_stage
from ..cost import measure as cost
from .answer import Row
from .table import READERS


class Costs:
    """Instructions and issue slots of codecs. On a machine without compilers, catalogue codecs have recorded costs,
    and the costs of other codecs are unknown.

    Packing into channels counts; the conversion that a render target performs by itself does not.
    """

    def __init__(self, codecs: Iterable[Codec], families: Sequence[str], readers: int = READERS):
        self._readers = readers
        chosen = list(codecs)
        encodings = list(dict.fromkeys(codec.encoding for codec in chosen))
        packings = {packing_of(codec).name: packing_of(codec) for codec in chosen if codec.storage.is_packed}
        cases = cost.cases(encodings, packings.values(), cost.OPERATIONS)
        self._rows = {family: cost.known_counts(cases, family, usual_stage(family)) for family in families}

    def of(self, codec: Codec) -> Row:
        """Return the cost columns for the GPU family on which the codec costs most; empty if no cost is known."""
        prices = [row for family in self._rows if (row := self._price_columns(family, codec))]
        return max(prices, key=lambda row: (row["slots"] is None, row["slots"] or 0.0), default={})

    def slots_of(self, codec: Codec) -> dict[str, tuple[float | None, float | None]]:
        """Return pairs of the slots to encode and to decode, by GPU family; families without figures are left out."""
        prices = {family: self._price_columns(family, codec) for family in self._rows}
        return {family: (row["encode_slots"], row["decode_slots"]) for family, row in prices.items() if row}

    def _price_columns(self, family: str, codec: Codec) -> Row:
        rows, name = self._rows[family], codec.encoding.name
        parts = [[rows.get((name, operation))] for operation in cost.OPERATIONS]
        if codec.storage.is_packed:
            for part, operation in zip(parts, cost.PACKING_OPERATIONS.values(), strict=True):
                part.append(rows.get((packing_of(codec).name, operation)))
        if any(row is None for part in parts for row in part):
            return {}
        instructions, slots = (
            [_total(part, column) for part in parts] for column in ("instructions", "executed_slots")
        )
        is_known = None not in slots
        return {
            "dearest_family": family,
            "recorded_by": next((row.get("recorded_by") for part in parts for row in part if row), None),
            **dict(zip(("encode_instructions", "decode_instructions"), instructions, strict=True)),
            "instructions": _sum(instructions),
            **dict(zip(("encode_slots", "decode_slots"), slots, strict=True)),
            "slots_once": _sum(slots),
            "slots": slots[0] + self._readers * slots[1] if is_known else None,  # type: ignore[operator]
            "loops": sum(row["loops"] or 0 for part in parts for row in part if row),
        }


def _total(rows: Sequence[Row | None], column: str) -> float | None:
    return _sum([row[column] if row else None for row in rows])


def _sum(figures: Sequence[float | None]) -> float | None:
    known = [figure for figure in figures if figure is not None]
    return round(sum(known), 1) if len(known) == len(figures) else None
