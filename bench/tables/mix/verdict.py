"""Whether a codec can be filtered, blended or resolved, from its rows alone; the thresholds are in table.py."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from .table import MOST_ADDED, MOST_JUDGED_DEG, USES, VERDICTS

Row = dict[str, Any]
# What is done to codes, as a reason says it.
DONE: Mapping[str, str] = {
    "filter": "filtered",
    "mip_2x2": "averaged to a mip level",
    "mip_4x4": "averaged to the second mip level",
    "resolve": "resolved",
    "blend": "blended",
    "detail": "blended with a detail",
}


def _excess(row: Row) -> float:
    """The largest error less twice that of the texels alone: once for texels read, once for what is written."""
    return row["angle_max_deg"] - 2 * row["alone_max_deg"]


def _allowed(row: Row) -> float:
    return MOST_ADDED * row["reach_max_deg"]


def fault(row: Row) -> str:
    """Why a row speaks against its codec; empty where it does not."""
    far = f"{row['angle_max_deg']:.3g} degrees off"
    apart = "neighbours" if row["angle_deg"] is None else f"normals {row['angle_deg']:g} degrees apart"
    done = f"{apart} on {row['normals']}, {DONE[row['operation']]}"
    if row["garbage_percent"]:
        pair = f"{row['worst_first']} with {row['worst_second']} gives {row['worst_result']}"
        return f"{done}: {row['garbage_percent']:.2g} % garbage, up to {far}: {pair}"
    if _excess(row) > _allowed(row):
        return f"{done}: up to {far}, {row['alone_max_deg']:.3g} without mixing"
    return ""


def _severity(row: Row) -> tuple[bool, float]:
    return bool(row["garbage_percent"]), _excess(row) / max(row["reach_max_deg"], 1e-6)


def judged(rows: Sequence[Row]) -> list[Row]:
    """The rows with their codec's verdicts, by back end; a use is judged where all of its operations were measured."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(codec_of(row), []).append(row)
    found = {codec: _verdicts(group) for codec, group in groups.items()}
    return [row | found[codec_of(row)] for row in rows]


def codec_of(row: Row) -> tuple[str, ...]:
    """What a verdict is of."""
    return row["encoding"], row["storage"], row["backend"]


def _verdicts(rows: Sequence[Row]) -> Row:
    made: Row = dict.fromkeys(VERDICTS.values())
    reasons = []
    for use, operations in USES.items():
        part = [row for row in rows if row["operation"] in operations and _counts(row)]
        if {row["operation"] for row in part} != set(operations):
            continue
        said = why_not(part)
        made[VERDICTS[use]] = "no" if said else "yes"
        reasons += [said] if said else []
    return made | {"why": "; ".join(dict.fromkeys(reasons)) or None}


def _counts(row: Row) -> bool:
    """Whether a row decides: it has figures, and its neighbours are as close as those of a surface."""
    return row["angle_max_deg"] is not None and (row["angle_deg"] or 0) <= MOST_JUDGED_DEG


def why_not(rows: Sequence[Row]) -> str:
    """The fault of the worst of some rows; empty where none has any."""
    faulty = [row for row in rows if fault(row)]
    return fault(max(faulty, key=_severity)) if faulty else ""


def lines(rows: Sequence[Row]) -> Iterator[Row]:
    """A line for each codec and back end: its verdicts and its worst figures."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        if row["angle_max_deg"] is not None:
            groups.setdefault(codec_of(row), []).append(row)
    for group in groups.values():
        first = group[0]
        line = {name: first[name] for name in ("encoding", "storage", "backend")}
        line |= {name: first[name] for name in VERDICTS.values()}
        line |= {"alone_max_deg": max(row["alone_max_deg"] for row in group)}
        for use, operations in USES.items():
            part = [row["garbage_percent"] for row in group if row["operation"] in operations]
            line[f"{use}_garbage_percent"] = max(part, default=None)
        yield line | {"why": first["why"]}
