"""Agreement and differences between the codes of devices and the codes of the run: sentences and tables from rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.page.codec_key import CodecKey
from ..table import Row, Sheet
from .reading import called

CODEC = ("encoding", "storage", "rounding", "target")
SAME = 100.0
# Devices that a sentence names; the others are counted.
MOST_NAMED = 4


def device_of(row: Row) -> str:
    """Return the name of a row's device, for sentences and column headings."""
    return called(row["device"], row["browser"])


def codec_of(row: Row) -> tuple[Any, ...]:
    """Return the values that identify a row's codec: encoding, storage, rounding and render target."""
    return tuple(row[name] for name in CODEC)


def differs(row: Row) -> bool:
    """Whether any code in a row differs from the run's code."""
    return bool(row["one_step"] or row["further"])


def codec_name(row: Row) -> str:
    """Return the name of a row's codec for sentences, without the rounding if it is the usual one."""
    return CodecKey.of(row).label


def by_device(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return the rows grouped by the name of their device."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(device_of(row), []).append(row)
    return groups


def many(count: int, what: str) -> str:
    """Return a count with its noun, such as `3 codecs` or `1 codec`."""
    return f"{count} {what}" + ("" if count == 1 else "s")


def sentences(rows: Sequence[Row]) -> list[str]:
    """Return sentences: first which devices agree with the run in every code, then a sentence for each other device,
    the worst first, and last a warning if the codes come from several versions of the program."""
    parts = by_device(rows)
    off = {name: part for name, part in parts.items() if any(map(differs, part))}
    whole = [name for name in parts if name not in off]
    first = [_agreement_sentence(whole, [row for name in whole for row in parts[name]])] if whole else []
    worst = sorted(off, key=lambda name: min(row["same_percent"] for row in off[name]))
    lines = [*first, *(f"{name} {difference(off[name])}." for name in worst)]
    return [*lines, *_other_runs(rows)]


def _other_runs(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a warning if the devices ran several versions of the program, whose codes may differ by themselves."""
    versions = len({row.get("sources") for row in rows})
    if versions > 1:
        yield f"The pages come from {versions} versions of the program, whose codes may differ."


def _agreement_sentence(names: Sequence[str], rows: Sequence[Row]) -> str:
    who = _listed(names) if len(names) <= MOST_NAMED else f"{len(names)} devices"
    verb = "agrees" if len(names) == 1 else "agree"
    return f"{who} {verb} with the run in every code of {many(len({codec_of(row) for row in rows}), 'codec')}."


def _listed(names: Sequence[str]) -> str:
    """Return names as one text, joined by semicolons, because names contain commas, and "and" before the last."""
    return "; ".join(names[:-1]) + (" and " if len(names) > 1 else "") + names[-1]


def difference(rows: Sequence[Row]) -> str:
    """Return a sentence without its subject: how a device's codes differ from the run's codes, or that they agree."""
    off = [row for row in rows if differs(row)]
    if not off:
        return f"agrees with the run in every code of {many(len(rows), 'codec')}"
    worst = min(off, key=lambda row: row["same_percent"])
    share = f"{share_of(worst)} of its codes, {_distance_text(worst)}"
    return f"differs in {len(off)} of {many(len(rows), 'codec')}, most in {codec_name(worst)}: {share}"


def share_of(row: Row) -> str:
    """Return the percentage of a row's codes that differ, as text; "less than 0.001%" if it is smaller than that."""
    share = SAME - row["same_percent"]
    return f"{share:.3g}%" if share >= 0.001 else "less than 0.001%"


def _distance_text(row: Row) -> str:
    return f"{row['further']} by more than one step" if row["further"] else "by one step each"


def pivot(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each codec for which any device differs, with a column for each such device: the percentage of
    its codes that differ.

    Rounding and target are columns only if they distinguish codecs.
    """
    shown = [row for row in rows if differs(row)]
    keys = [name for name in CODEC if name in CODEC[:2] or len({row[name] for row in rows}) > 1]
    wanted = dict.fromkeys(map(codec_of, shown))
    shares = {(codec_of(row), device_of(row)): SAME - row["same_percent"] for row in rows}
    about = {codec_of(row): {name: row[name] for name in keys} for row in shown}
    devices = [name for name, part in by_device(rows).items() if any(map(differs, part))]
    return [about[codec] | {name: shares.get((codec, name)) for name in devices} for codec in wanted]


def sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield the sheet of codes that differ from the run's, if any, and the sheet of devices; nothing without rows."""
    if not rows:
        return
    lines = tuple(sentences(rows))
    table = pivot(rows)
    if table:
        yield Sheet("Codes that differ from the run's, in percent, by codec and device", table, said=lines)
    yield Sheet("Devices", overview(rows), said=() if table else lines)


def overview(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each device: for how many codecs it agrees with the run, and where it differs most."""
    return [_overview_row(part) for part in by_device(rows).values()]


def _overview_row(rows: Sequence[Row]) -> Row:
    off = [row for row in rows if differs(row)]
    worst = min(off, key=lambda row: row["same_percent"], default=None)
    quick = fastest(rows)
    about = {"device": rows[0]["device"], "browser": rows[0]["browser"], "codecs": len(rows)}
    about |= {"agree": len(rows) - len(off), "differ": len(off), "further": sum(bool(row["further"]) for row in rows)}
    about |= {"least_same_percent": min(row["same_percent"] for row in rows)}
    about |= {"differs_most": codec_name(worst) if worst else None, "fastest": codec_name(quick) if quick else None}
    return about | {"fastest_ms": time_of(quick) if quick else None, "made": rows[0]["made"]}


def time_of(row: Row) -> float | None:
    """Return the milliseconds to encode and decode together; None if either was not measured."""
    encode, decode = row["encode_ms"], row["decode_ms"]
    return None if encode is None or decode is None else encode + decode


def fastest(rows: Sequence[Row]) -> Row | None:
    """Return the row of the codec that encodes and decodes fastest; None if no time was measured."""
    timed = [(time, index) for index, row in enumerate(rows) if (time := time_of(row)) is not None]
    return rows[min(timed)[1]] if timed else None
