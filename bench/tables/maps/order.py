"""The order of the rows on compressed normal maps."""

from __future__ import annotations

from collections.abc import Sequence

from ..table import Row


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by set and decoder, then by RMS angle in ascending order; rows without figures come last."""
    groups = list(dict.fromkeys(group_of(row) for row in rows))

    def place(row: Row) -> tuple[int, bool, float]:
        rms = row["angle_rms_deg"]
        return groups.index(group_of(row)), rms is None, rms or 0.0

    return sorted(rows, key=place)


def group_of(row: Row) -> tuple[str, str]:
    """Return the set of normals and the decoder of a row, by which rows are grouped."""
    return row["normals"], row["decoder"]
