"""The loss of accuracy in half arithmetic: its rows compared with the same rows in float32."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.codecs.variants import HALF_NAME
from ..table import Row

# A code survives half arithmetic where its RMS angle grows by no more than this, in percent.
SURVIVES = 10.0


def with_half_loss(rows: Sequence[Row]) -> list[Row]:
    """Return the rows; rows in half arithmetic get the increase of the RMS angle if their float32 row is present."""
    known = {_case_key(row): row["angle_rms_deg"] for row in rows if not _is_half(row)}
    return [row | _loss_column(row, known.get(_case_key(row))) if _is_half(row) else row for row in rows]


def survivors(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return a line for each storage and set: encodings that remain nearly as accurate in half arithmetic, and the
    other encodings."""
    measured_rows = [row for row in rows if row.get("half_loss_percent") is not None]
    return tuple(_loss_lines(measured_rows))


def _loss_lines(rows: Sequence[Row]) -> Iterator[str]:
    for storage, normals in dict.fromkeys((row["storage"], row["normals"]) for row in rows):
        part = [row for row in rows if (row["storage"], row["normals"]) == (storage, normals)]
        losses = {_base_name(row): row["half_loss_percent"] for row in part}
        kept = [name for name, loss in losses.items() if loss <= SURVIVES]
        lost = [f"{name} (+{loss:.3g}%)" for name, loss in losses.items() if loss > SURVIVES]
        sentence = f"In half arithmetic, {storage} on {normals}: the RMS angle of {{}} grows by at most {SURVIVES:g}%"
        yield sentence.format(", ".join(kept) or "no encoding") + (f"; of {', '.join(lost)} by more" if lost else "")


def _is_half(row: Row) -> bool:
    return row["encoding"].endswith(HALF_NAME)


def _base_name(row: Row) -> str:
    return row["encoding"].removesuffix(HALF_NAME)


def _case_key(row: Row) -> tuple[Any, ...]:
    return (_base_name(row), row["storage"], row["rounding"], row["normals"], row["backend"])


def _loss_column(row: Row, exact: float | None) -> Row:
    if not exact or row["angle_rms_deg"] is None:
        return {}
    return {"half_loss_percent": 100.0 * (row["angle_rms_deg"] / exact - 1.0)}
