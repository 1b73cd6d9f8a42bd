"""Data that the page shows besides the quality rows: maps of errors over the sphere, agreement of backends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ....reports.page.codec_key import CodecKey
from ....reports.page.found import SphereMap
from ....reports.page.verdict import agreement, is_count
from ...ground.output.writing import files_of
from ..table import Row
from . import sphere_maps
from .table import TABLE


def extras(folder: Path, tables: Mapping[str, Sequence[Row]], remarks: list[str]) -> Mapping[str, Any]:  # noqa: ARG001
    """Return the maps of errors over the sphere in a run's folder, as `maps`, and a sentence on how far the figures
    from two backends differ, as `agreement`."""
    rows = tables.get(TABLE.name, ())
    return {"maps": list(_sphere_maps(folder / TABLE.files["maps"], rows)), "agreement": agreement(rows)}


def _sphere_maps(folder: Path, rows: Sequence[Row]) -> Iterator[SphereMap]:
    there = files_of(folder)
    bits = {CodecKey.of(row): row["bits"] for row in rows if is_count(row.get("bits"))}
    for key, count in bits.items():
        path = there.get(sphere_maps.file_name(*key))
        kept = sphere_maps.read_map(path) if path else None
        if kept:
            yield SphereMap(key, count, kept.mean_deg, kept.max_deg, kept.directions)
