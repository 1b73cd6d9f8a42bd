"""How the facts of readers' devices are taken from their files, and shown side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..devices.agreement import by_device, device_of, many
from ..devices.reading import fact_rows, newest, steps_of
from ..table import Role, Row, Sheet, Step, Work, each
from .table import TABLE, DeviceFactsOptions

KEYS = [column.name for column in TABLE.of_role(Role.KEY)]


def _steps(options: DeviceFactsOptions, _: object) -> list[Step]:
    return steps_of(options.devices)


def _finish(rows: Sequence[Row]) -> list[Row]:
    return newest(rows, KEYS)


def side_by_side(rows: Sequence[Row]) -> list[Row]:
    """A row for each fact, with a column for each device; the facts that devices differ in come first."""
    found = {(row["name"], device_of(row)): row["value"] for row in rows}
    names, devices = dict.fromkeys(row["name"] for row in rows), list(by_device(rows))
    made = [{"fact": name, **{device: found.get((name, device)) for device in devices}} for name in names]
    return sorted(made, key=lambda row: not _is_told_apart(row))


def _is_told_apart(row: Row) -> bool:
    return len({value for name, value in row.items() if name != "fact" and value is not None}) > 1


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    if not rows:
        return
    table, devices = side_by_side(rows), len(by_device(rows))
    apart = sum(map(_is_told_apart, table))
    said = f"{many(devices, 'device')}: " + (
        f"they differ in {apart} of {many(len(table), 'fact')}." if devices > 1 else f"{many(len(table), 'fact')}."
    )
    yield Sheet("Facts by device", table, said=(said,))


WORK = Work(
    steps=_steps,
    measure=each(lambda device: [TABLE.empty() | row for row in fact_rows(device)]),
    finish=_finish,
    summary=_summary,
    needs=lambda _: frozenset(),
    stays=True,
)
