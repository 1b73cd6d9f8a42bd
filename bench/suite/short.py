"""Each table of a run in short: what people look at first."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from ...encodings.catalogue import ENCODINGS
from ..metrics import published as seeds
from ..results.runs import Row
from ..tables.cost.measure import OPERATIONS
from ..tables.cost.sheets import article_rows, isa_sheet
from ..tables.quality import measure as quality
from ..tables.render.measure import ranked
from ..tables.tangent_frames.command import in_order

# A title, rows, and the columns that a narrow terminal goes without.
Short = Iterator[tuple[str, list[Row], tuple[str, ...]]]


def _quality_in_short(rows: list[Row]) -> Short:
    for (normals, storage), part in _grouped(rows):
        title = f"{normals}, {storage}: dB by back end; angles in degrees, by {part[0]['backend']}"
        yield title, beside(part), ("p99", "psnr_db_glsl", "mean")


def _grouped(rows: Iterable[quality.Row]) -> Iterator[tuple[tuple[str, str], list[quality.Row]]]:
    parts: dict[tuple[str, str], list[quality.Row]] = {}
    for row in rows:
        parts.setdefault((row["normals"], row["storage"]), []).append(row)
    yield from parts.items()


def beside(rows: Iterable[quality.Row]) -> list[quality.Row]:
    """One line for each codec, its back ends beside each other, and the seeds' own figure where they have one."""
    lines: dict[str, quality.Row] = {}
    for row in rows:
        line = lines.setdefault(row["encoding"], {"encoding": row["encoding"], "bits": row["bits"]})
        if row["normals"] == seeds.NORMALS and row["storage"] == seeds.STORAGE:
            line["article_db"] = seeds.PSNR_DB.get(row["encoding"])
        line |= {f"{column}_{row['backend']}": row[column] for column in ("psnr_seed_db", "psnr_db")}
        if row["angle_mean_deg"] is not None and "mean" not in line:
            shown = ("angle_mean_deg", "angle_p99_deg", "angle_max_deg", "effective_bits")
            line |= {column.removeprefix("angle_").removesuffix("_deg"): row[column] for column in shown}
    first = ("encoding", "bits", "article_db")
    found = dict.fromkeys(column for line in lines.values() for column in line)
    order = [column for column in first if column in found] + sorted(c for c in found if c.startswith("psnr"))[::-1]
    order += [column for column in found if column not in order]
    return [{column: line.get(column) for column in order} for line in lines.values()]


def _columns(rows: Iterable[Row], *names: str) -> list[Row]:
    return [{name: row[name] for name in names} for row in rows]


def _render_in_short(rows: list[Row]) -> Short:
    order = sorted((row for row in ranked(rows) if row["psnr_db"] is not None), key=lambda row: -row["psnr_db"])
    shown = _columns(order, "encoding", "storage", "psnr_db", "rank", "normal_psnr_db", "normal_rank")
    yield f"the image: {rows[0]['scene']} by {rows[0]['pipeline']}, dB as displayed", shown, ()


def _passes_in_short(rows: list[Row]) -> Short:
    shown = _columns(rows, "pipeline", "layout", "ms_frame", "ms_frame_spread", "triangles")
    yield f"a frame of {rows[0]['objects']} objects, milliseconds by {rows[0]['clock']}", shown, ("layout",)


def _lights_in_short(rows: list[Row]) -> Short:
    equal: dict[tuple[str, str], Row] = {}
    for row in rows:
        if row["experiment"] == "equal" and row["sum"] == 1:
            line = {"light_buffer": row["light_buffer"], "channel": row["channel"]}
            equal.setdefault((row["light_buffer"], row["channel"]), line)[f"{row['lights']}_lights"] = row["model"]
    yield "lights that sum to 1, what is left of it by the model", list(equal.values()), ()
    frames = [row for row in rows if row["experiment"] == "image" and row["psnr_db"] is not None]
    if frames:
        shown = _columns(frames, "light_buffer", "light_targets", "psnr_db", "held_psnr_db", "beyond_percent")
        yield "a frame under six lamps, dB as displayed; held: where the code can hold the light", shown, ()


def _depth_in_short(rows: list[Row]) -> Short:
    lines: dict[tuple[Any, ...], Row] = {}
    for row in rows:
        if row["distance"] is not None and row["error_max"] is not None and row["backend"] == rows[0]["backend"]:
            line = {"depth": row["depth"], "storage": row["storage"]}
            at = lines.setdefault((row["depth"], row["storage"]), line)
            at[f"at_{row['distance']:g}"] = row["error_max"]
    yield f"the worst position error, near {rows[0]['near']:g}, far {rows[0]['far']:g}", list(lines.values()), ()


def _frames_in_short(rows: list[Row]) -> Short:
    measured = [row for row in in_order(rows) if row["rotation_rms_deg"] is not None]
    chosen = [row for row in measured if row["backend"] == measured[0]["backend"]]
    names = ("encoding", "storage", "bits", "rotation_mean_deg", "rotation_rms_deg", "rotation_max_deg")
    if chosen:
        shown = _columns(chosen, *names, "effective_bits", "limit_rms_deg", "hands_lost")
        yield f"tangent frames, degrees between the true and the decoded one, by {chosen[0]['backend']}", shown, ()


def _cost_in_short(rows: list[Row]) -> Short:
    first = next((row for row in rows if row["stage"]), None)
    if first:
        chosen = [row for row in rows if row["stage"] == first["stage"] and row["encoding"]]
        sheet = isa_sheet(chosen, article_rows(ENCODINGS, OPERATIONS))
        yield f"instructions, {first['stage']}, {first['driver']}; the article's are of ps_3_0", sheet, ()


SHORT = {
    "quality": _quality_in_short,
    "render": _render_in_short,
    "cost": _cost_in_short,
    "lights": _lights_in_short,
    "depth": _depth_in_short,
    "frames": _frames_in_short,
    "passes": _passes_in_short,
}
