"""Pictures of rendered images: writing them into a folder, and finding them there again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from ....gbuffer.frame.plan import LEAST_ROUGHNESS
from ....gbuffer.scenes.files.read import AROUND
from ....reports.charts import pictures
from ....reports.page.codec_key import CodecKey
from ....reports.page.pixels import ImagePixels, Pictured, Subject, read_png
from ....reports.page.verdict import LEADING, is_number
from ...ground.output.writing import files_of, whole_file
from ..shots import name_of_file
from ..table import Row
from .measure import Drawn, shown_scene

# What a row's file names say of its scene, and of what is in its G-buffer.
SCENE = ("scene", "power", "pipeline", "environment", "specular_antialiasing", "least_roughness", "shadow")
CONTENT = ("layout", "encoding", "storage", "rounding", "light_buffer", "light_targets")
REFERENCE = "reference"


def scene_stem(row: Row, content: Sequence[str] = ()) -> str:
    """Return the start of the file name for a row's scene, followed by parts that name its content, if given."""
    power = [] if row["power"] is None else [f"power{row['power']:g}"]
    effects = [name_of_file(row["effects"])] if row.get("effects") else []
    shadow = [] if row["shadow"] else ["unshadowed"]
    return "-".join([row["scene"], *power, *effects, *_surfaces(row), row["pipeline"], *content, *shadow])


def _surfaces(row: Row) -> Iterator[str]:
    """Yield the parts of a file name for the environment and the antialiasing of metallic-roughness surfaces; nothing
    for the defaults."""
    if (around := row.get("environment")) and not around.startswith(f"{AROUND} "):
        yield name_of_file(around)
    if row.get("specular_antialiasing") is False:
        yield "aliased"
    if row.get("least_roughness") not in (None, LEAST_ROUGHNESS):
        yield f"least{row['least_roughness']:g}"


def stem(row: Row) -> str:
    """Return the start of a row's file names, without the kind of picture."""
    if row["layout"] is None:
        return scene_stem(row)
    rounding = [] if row["rounding"] == "nearest" else [row["rounding"]]
    light = f"{row['light_buffer']}x{row['light_targets']}"
    return scene_stem(row, [row["layout"], row["encoding"], row["storage"], *rounding, light])


def write(folder: Path, row: Row, drawn: Drawn, reference: Drawn) -> None:
    """Write pictures of a row's first frame and its errors, and of the reference, which the scene's rows share."""
    images = {f"{stem(row)}-{kind}": pixels for kind, pixels in _named_pictures(drawn, reference).items()}
    # Written anew each time: the folder may hold one of other settings.
    images[f"{scene_stem(row)}-{REFERENCE}"] = pictures.picture(reference.shown)
    for name, pixels in images.items():
        with whole_file(folder / f"{name}.png") as partial:
            pictures.write_png(partial, pixels)


def _named_pictures(drawn: Drawn, reference: Drawn) -> dict[str, np.ndarray]:
    final, apart = pictures.picture(drawn.shown), pictures.difference(drawn.shown, reference.shown)
    flip = {} if drawn.flip is None else {"flip": pictures.grey(drawn.flip)}
    return {"final": final, "difference": apart, **flip}


def subjects(folder: Path, rows: Sequence[Row]) -> Iterator[Subject]:
    """Yield a subject for each scene in the rows, if the folder has its pictures. File names are looked up in the
    folder, so that they cannot lead out of it."""
    there = files_of(folder)
    groups: dict[str, list[Row]] = {}
    for row in rows:
        if all(name in row for name in (*SCENE, *CONTENT)):
            groups.setdefault(scene_stem(row), []).append(row)
    for name, part in groups.items():
        original = there.get(f"{name}-{REFERENCE}.png")
        codecs = [pictured for row, rank in in_order(part) if (pictured := _pictured_or_none(there, row, part, rank))]
        if original and codecs:
            yield Subject(_title(part[0], rows), "image", partial(read_png, original), codecs)


def _title(row: Row, rows: Sequence[Row]) -> str:
    pipeline = f" by {row['pipeline']}" if len({other.get("pipeline") for other in rows}) > 1 else ""
    return f"the image of {shown_scene(row)}{pipeline}" + ("" if row["shadow"] else " without shadows")


def _pictured_or_none(there: Mapping[str, Path], row: Row, part: Sequence[Row], rank: int) -> Pictured | None:
    final = there.get(f"{stem(row)}-final.png")
    flip = there.get(f"{stem(row)}-flip.png")
    key = CodecKey.of(row)
    codec = "" if row["layout"] is None else key.label
    return Pictured(key, _label(row, part), codec, partial(_pixels, final, flip), rank) if final else None


def _label(row: Row, part: Sequence[Row]) -> str:
    """Return a label for a row: the codec, and any other names that distinguish the row."""
    if row["layout"] is None:
        return str(row["pipeline"])
    others = [name for name in ("layout", "light_buffer", "light_targets") if len({other[name] for other in part}) > 1]
    return " ".join([CodecKey.of(row).label, *(str(row[name]) for name in others)])


def in_order(rows: Sequence[Row]) -> list[tuple[Row, int]]:
    """Return the rows of one scene by bits, the best first, each with its rank among rows with the same bits."""

    def bits_and_figure(row: Row) -> tuple[int, float]:
        return row.get("normal_bits") or 0, -row[LEADING] if is_number(row.get(LEADING)) else 0.0

    ordered = sorted(rows, key=bits_and_figure)
    bits = [row.get("normal_bits") for row in ordered]
    return [(row, bits[:i].count(bits[i])) for i, row in enumerate(ordered)]


def _pixels(final: Path, flip: Path | None) -> ImagePixels | None:
    """Return a row's pixels from its picture files; None if the image is damaged, without FLIP if it is missing."""
    image, apart = read_png(final), read_png(flip) if flip else None
    return None if image is None else ImagePixels(image, None if apart is None else apart[..., 0])
