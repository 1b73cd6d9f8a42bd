"""Facts about readers' devices, side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..table import Row, Sheet
from .agreement import by_device, device_of, many


def side_by_side(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each fact, with a column for each device; facts that differ between devices come first."""
    values = {(row["name"], device_of(row)): row["value"] for row in rows}
    names, devices = dict.fromkeys(row["name"] for row in rows), list(by_device(rows))
    table = [{"fact": name, **{device: values.get((name, device)) for device in devices}} for name in names]
    return sorted(table, key=lambda row: not _is_told_apart(row))


def _is_told_apart(row: Row) -> bool:
    return len({value for name, value in row.items() if name != "fact" and value is not None}) > 1


def sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield the sheet of facts by device, with a sentence on how many facts differ; nothing without rows."""
    if not rows:
        return
    table, devices = side_by_side(rows), len(by_device(rows))
    apart = sum(map(_is_told_apart, table))
    sentence = f"{many(devices, 'device')}: " + (
        f"they differ in {apart} of {many(len(table), 'fact')}." if devices > 1 else f"{many(len(table), 'fact')}."
    )
    yield Sheet("Facts by device", table, said=(sentence,))
