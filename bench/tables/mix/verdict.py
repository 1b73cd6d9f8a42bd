"""Verdicts on filtering, blending and resolving a codec, from rows alone; the thresholds are in table.py."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ..table import Row
from .figures import excused
from .table import ACROSS, MOST_ADDED, MOST_JUDGED_DEG, OF_INTEGER, OPERATIONS, USES, VERDICTS

# What is done to codes, as a reason says it.
DONE: Mapping[str, str] = {
    "filter": "filtered",
    "mip_2x2": "averaged to a mip level",
    "mip_4x4": "averaged to the second mip level",
    "resolve": "resolved",
    "blend": "blended",
    "detail": "blended with a detail",
    "upsample": "upsampled",
}


def _excess(row: Row) -> float:
    """Return a row's largest error in degrees, minus the error of geometry, and minus twice the excused part of the
    texels' own error: once for reading and once for writing."""
    return row["angle_max_deg"] - row["geometry_max_deg"] - 2 * excused(row["operation"], row["alone_max_deg"])


def _allowed_deg(row: Row) -> float:
    return MOST_ADDED * row["reach_max_deg"]


def is_faulty(row: Row) -> bool:
    """Whether a row counts against its codec: it has garbage, or its excess error is larger than allowed."""
    return bool(row["garbage_percent"]) or _excess(row) > _allowed_deg(row)


def summed_up(row: Row) -> str:
    """Return a phrase on what a row measures and how large its error is."""
    angle = row["angle_deg"]
    apart = "neighbours" if angle is None else f"normals {angle:g} degree{'s' * (angle != 1)} apart"
    apart = f"an edge of {row['edge_deg']:g} degrees" if row["edge_deg"] else apart
    far = f"up to {row['angle_max_deg']:.3g} degrees off"
    share = row["garbage_percent"]
    how = f"{share:.{0 if share >= 10 else 1 if share >= 1 else 3}f} % garbage, {far}" if share else far
    return f"{apart} on {row['normals']}, {DONE[row['operation']]}: {how}"


def _fault_reason(row: Row) -> str:
    """Return the phrase of `summed_up` with the pair of normals that gives garbage or, without garbage, with the
    error without mixing."""
    if not row["garbage_percent"]:
        return f"{summed_up(row)}, {row['alone_max_deg']:.3g} without mixing"
    return f"{summed_up(row)}: {row['worst_first']} with {row['worst_second']} gives {row['worst_result']}"


def _severity(row: Row) -> tuple[bool, float]:
    """Return whether there is garbage, and the excess error as a multiple of reach_max_deg: larger is worse."""
    return bool(row["garbage_percent"]), _excess(row) / max(row["reach_max_deg"], 1e-6)


def judged(rows: Sequence[Row]) -> list[Row]:
    """Return the rows with the verdicts for their codec and backend; a use is judged only if all of its operations
    were measured."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(codec_of(row), []).append(row)
    verdicts = {codec: _verdict_columns(group) for codec, group in groups.items()}
    return [row | verdicts[codec_of(row)] for row in rows]


def codec_of(row: Row) -> tuple[str, ...]:
    """Return the encoding, storage and backend of a row, for which verdicts are given."""
    return row["encoding"], row["storage"], row["backend"]


def _verdict_columns(rows: Sequence[Row]) -> Row:
    verdicts: Row = {}
    reasons = []
    for suffix, is_decisive in (("", decides), (ACROSS, decides_across)):
        for use, operations in USES.items():
            part = [row for row in rows if row["operation"] in operations and is_decisive(row)]
            column = f"{VERDICTS[use]}{suffix}"
            verdicts[column] = None
            if any(row["operation"] in operations and _is_integer(row, suffix == ACROSS) for row in rows):
                verdicts[column] = "no"
                reasons.append(OF_INTEGER)
            if {row["operation"] for row in part} != set(operations):
                continue
            worst = worst_fault(part)
            verdicts[column] = "no" if worst else "yes"
            reasons += [_fault_reason(worst)] if worst else []
    return verdicts | {"why": "; ".join(dict.fromkeys(reasons)) or None}


def _is_integer(row: Row, is_across: bool) -> bool:
    """Whether a row with an edge (`is_across`), or without an edge, has no figures because its code is an integer."""
    return row.get("skipped") == OF_INTEGER and bool(row["edge_deg"]) == is_across


def decides(row: Row) -> bool:
    """Whether a row decides the verdict inside a surface: it has figures and no edge, and its neighbours are as close
    as on a surface."""
    return row["angle_max_deg"] is not None and not row["edge_deg"] and (row["angle_deg"] or 0) <= MOST_JUDGED_DEG


def decides_across(row: Row) -> bool:
    """Whether a row decides the verdict across an edge: it has figures and an edge."""
    return row["angle_max_deg"] is not None and bool(row["edge_deg"])


def worst_fault(rows: Sequence[Row]) -> Row | None:
    """Return the worst row among those that count against their codec; None if no row does."""
    faulty = [row for row in rows if row["angle_max_deg"] is not None and is_faulty(row)]
    return max(faulty, key=_severity) if faulty else None


def lines(rows: Sequence[Row]) -> Iterator[Row]:
    """Yield a row for each codec and backend: its verdicts, and the worst figures of its deciding rows."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        if decides(row):
            groups.setdefault(codec_of(row), []).append(row)
    for group in groups.values():
        first = group[0]
        line = {name: first[name] for name in ("encoding", "storage", "backend")}
        line |= {name: first[name] for name in (*VERDICTS.values(), f"{VERDICTS['filter']}{ACROSS}")}
        line |= {"alone_max_deg": max(row["alone_max_deg"] for row in group)}
        for use, operations in USES.items():
            part = [row["garbage_percent"] for row in group if row["operation"] in operations]
            line[f"{use}_garbage_percent"] = max(part, default=None)
        yield line | {"why": first["why"]}


def worst_of_each(rows: Sequence[Row]) -> list[Row]:
    """Return the worst row for each operation, codec and backend: the row with the most garbage, then with the
    largest error."""
    worst: dict[tuple[Any, ...], Row] = {}
    for row in rows:
        key = (row["operation"], row["encoding"], row["storage"], row["backend"])
        if row["angle_max_deg"] is not None and (key not in worst or _badness(row) > _badness(worst[key])):
            worst[key] = row
    order = list(OPERATIONS)
    return sorted(worst.values(), key=lambda row: (order.index(row["operation"]), *_badness(row)))


def _badness(row: Row) -> tuple[float, float]:
    return row["garbage_percent"], row["angle_max_deg"]
