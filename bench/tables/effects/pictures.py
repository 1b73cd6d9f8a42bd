"""Pictures of effects: writing them into a folder, and finding them there again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from ....reports.charts import pictures
from ....reports.page.codec_key import CodecKey
from ....reports.page.pixels import ImagePixels, Pictured, Subject, read_png
from ...ground.output.writing import files_of, whole_file
from ..shots import name_of_file
from ..table import Row
from .measure import Drawn, in_order

REFERENCE = "reference"
OWN, IMAGE = "effect", "final"
# The share of an effect's own image that is shown no brighter than white.
WHITE = 0.99


def _file_stem(row: Row, of_reference: bool = False) -> str:
    """Return the start of the names of a row's picture files, without the kind of picture."""
    start = [name_of_file(row["effect"]), row["scene"], row["pipeline"]]
    code = [row["depth"].replace("/", "-")] if row["depth"] else [row["encoding"], row["storage"], row["rounding"]]
    return "-".join([*start, *([] if of_reference else [row["layout"], *code])])


def write(folder: Path, row: Row, drawn: Drawn, exact: Drawn) -> None:
    """Write the effect's own image and the final image for a row and for the reference, which rows share."""
    # What few pixels mirror of a lamp would leave all others black.
    peak = float(np.quantile(exact.own, WHITE)) or float(np.max(exact.own)) or 1.0
    for stem, frame in ((_file_stem(row), drawn), (f"{_file_stem(row, True)}-{REFERENCE}", exact)):
        for name, shown in ((OWN, own_picture(frame.own, peak)), (IMAGE, pictures.picture(frame.shown))):
            with whole_file(folder / f"{stem}-{name}.png") as partial_file:
                pictures.write_png(partial_file, shown)


def own_picture(own: np.ndarray, peak: float) -> np.ndarray:
    """Return an effect's own image for display, uint8 of shape (height, width, 3): in sRGB, with values of `peak` and
    above white.

    An image with one channel, such as visibility, becomes linear grey.
    """
    share = np.clip(np.nan_to_num(own) / peak, 0.0, 1.0)
    if own.shape[-1] == 1:
        return pictures.grey(share[..., 0])
    return pictures.picture(share ** (1 / 2.2))


def subjects(folder: Path, rows: Sequence[Row]) -> Iterator[Subject]:
    """Yield a subject for each effect, scene and pipeline in the rows, with its pictures from a folder; no subject if
    the reference picture or all other pictures are missing. File names are looked up in the folder, so that they
    cannot lead out of it."""
    there = files_of(folder)
    groups: dict[str, list[Row]] = {}
    for row in rows:
        if row.get("effect") and row.get("scene") and row.get("pipeline") and "depth" in row and "encoding" in row:
            groups.setdefault(_file_stem(row, True), []).append(row)
    for name, part in groups.items():
        original = there.get(f"{name}-{REFERENCE}-{OWN}.png")
        pictured = [
            picture for rank, row in enumerate(in_order(part)) if (picture := _pictured_or_none(there, row, rank))
        ]
        if original and pictured:
            title = f"{part[0]['effect']} alone, on {part[0]['scene']}"
            yield Subject(title, "image", partial(read_png, original), pictured)


def _pictured_or_none(there: Mapping[str, Path], row: Row, rank: int) -> Pictured | None:
    own = there.get(f"{_file_stem(row)}-{OWN}.png")
    if own is None:
        return None
    key = CodecKey.of(row)
    label = f"depth {row['depth']}" if row["depth"] else key.label
    return Pictured(key, label, "" if row["depth"] else key.label, partial(_pixels, own), rank)


def _pixels(own: Path) -> ImagePixels | None:
    image = read_png(own)
    return None if image is None else ImagePixels(image, None)
