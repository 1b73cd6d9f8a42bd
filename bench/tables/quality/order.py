"""The order of the quality table for display: by bits, the best first, with the limit below each bit count."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby

from ...measures.metrics.code_limits import HEMISPHERE, SPHERE, code_limit
from ..table import Row

# What a limit row has in common with every row above it, if these have it in common.
SHARED = ("storage", "rounding", "normals", "backend", "count", "device", "rounded_by", "seed", "domain")
# What the limit row says once for all rows.
ONCE = ("limit_mean_deg", "limit_rms_deg", "limit_max_deg", "below_limit", "codes")


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by set in the given order, then by bits, the best first; a codec's backends stay together."""
    sets = list(dict.fromkeys(row["normals"] for row in rows))
    best: dict[tuple, float] = {}
    for row in rows:
        best[_codec_key(row)] = min(best.get(_codec_key(row), math.inf), _error_key(row))
    # A row that a worker was lost for has no bits.
    return sorted(
        rows, key=lambda row: (sets.index(row["normals"]), row["bits"] or 0, best[_codec_key(row)], _codec_key(row))
    )


def _codec_key(row: Row) -> tuple:
    return (row["normals"], row["encoding"], row["storage"], row["rounding"])


def _error_key(row: Row) -> float:
    """Return the RMS angle, from which effective bits are computed; infinity for rows without figures."""
    return math.inf if row["angle_rms_deg"] is None else row["angle_rms_deg"]


def with_limits(rows: Sequence[Row]) -> list[Row]:
    """Return ordered rows, with a row for the limit after each group that shares its set and bits."""
    shared = {column: rows[0][column] for column in SHARED if len({row[column] for row in rows}) == 1}
    return [row for _, group in groupby(rows, _group_key) for row in _rows_with_limit(list(group), shared)]


def _group_key(row: Row) -> tuple:
    return (row["normals"], row["bits"])


def _rows_with_limit(group: list[Row], shared: Row) -> Iterator[Row]:
    yield from group
    if group[0]["bits"] is None:
        return
    bits, domains = group[0]["bits"], {row["domain"] for row in group}
    domain = "hemisphere" if domains == {"hemisphere"} else "sphere"
    least = code_limit(2**bits, HEMISPHERE if domain == "hemisphere" else SPHERE)
    row: Row = dict.fromkeys(group[0]) | {"normals": group[0]["normals"]} | shared
    has_sup = any(row["angle_sup_deg"] is not None for row in group)
    yield row | {
        "encoding": "limit" if group[0]["domain"] else "limit if uniform",
        "bits": bits,
        "domain": domain,
        "angle_mean_deg": least.mean_deg,
        "angle_rms_deg": least.rms_deg,
        "angle_max_deg": least.max_deg,
        "angle_sup_deg": least.max_deg if has_sup else None,
        "effective_bits": float(bits) if group[0]["domain"] else None,
    }
