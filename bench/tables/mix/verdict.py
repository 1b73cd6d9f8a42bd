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
    """The largest error less geometry's, and less twice that of the texels alone: once read, once written."""
    return row["angle_max_deg"] - row["geometry_max_deg"] - 2 * row["alone_max_deg"]


def _allowed(row: Row) -> float:
    return MOST_ADDED * row["reach_max_deg"]


def is_faulty(row: Row) -> bool:
    """Whether a row speaks against its codec."""
    return bool(row["garbage_percent"]) or _excess(row) > _allowed(row)


def summed_up(row: Row) -> str:
    """What a row is and how far off it is, in a few words."""
    angle = row["angle_deg"]
    apart = "neighbours" if angle is None else f"normals {angle:g} degree{'s' * (angle != 1)} apart"
    far = f"up to {row['angle_max_deg']:.3g} degrees off"
    share = row["garbage_percent"]
    how = f"{share:.{0 if share >= 10 else 1 if share >= 1 else 3}f} % garbage, {far}" if share else far
    return f"{apart} on {row['normals']}, {DONE[row['operation']]}: {how}"


def _reason(row: Row) -> str:
    """The same, and the pair that shows it."""
    if not row["garbage_percent"]:
        return f"{summed_up(row)}, {row['alone_max_deg']:.3g} without mixing"
    return f"{summed_up(row)}: {row['worst_first']} with {row['worst_second']} gives {row['worst_result']}"


def _severity(row: Row) -> tuple[bool, float]:
    return bool(row["garbage_percent"]), _excess(row) / max(row["reach_max_deg"], 1e-6)


def judged(rows: Sequence[Row]) -> list[Row]:
    """The rows with the verdicts of their codec and back end; a use is judged where all of its operations were
    measured."""
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
        part = [row for row in rows if row["operation"] in operations and decides(row)]
        if {row["operation"] for row in part} != set(operations):
            continue
        worst = worst_fault(part)
        made[VERDICTS[use]] = "no" if worst else "yes"
        reasons += [_reason(worst)] if worst else []
    return made | {"why": "; ".join(dict.fromkeys(reasons)) or None}


def decides(row: Row) -> bool:
    """Whether a row decides: it has figures, and its neighbours are as close as those of a surface."""
    return row["angle_max_deg"] is not None and (row["angle_deg"] or 0) <= MOST_JUDGED_DEG


def worst_fault(rows: Sequence[Row]) -> Row | None:
    """The worst of the rows that decide and speak against their codec; None where none does."""
    faulty = [row for row in rows if decides(row) and is_faulty(row)]
    return max(faulty, key=_severity) if faulty else None


def lines(rows: Sequence[Row]) -> Iterator[Row]:
    """A line for each codec and back end: its verdicts, and the worst figures of the rows that decide."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        if decides(row):
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
