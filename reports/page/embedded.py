"""Pictures that lie in a page: every pixel as it is, in as few bytes as may be."""

from __future__ import annotations

import base64
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image

from .found import CodecKey, Found, PictureSet, Row
from .verdict import is_count, is_number

# What all pictures of a page may take, in bytes of text.
BUDGET = 10 * 2**20
# WebP's own scale of 0 to 6; more takes ten times as long for a hundredth less.
EFFORT = 4
MAX_PIXELS = 2**24


@dataclass(frozen=True)
class Embedded:
    """A picture in a page: what it is of, and its data URI."""

    codec: str
    kind: str
    width: int
    height: int
    uri: str


@dataclass(frozen=True)
class Gallery:
    """A page's pictures, and the names of codecs whose pictures are left out for their size or cannot be read."""

    pictures: Sequence[Embedded]
    left_out: Sequence[str]
    damaged: Sequence[str]

    @property
    def groups(self) -> list[tuple[str, list[Embedded]]]:
        """The pictures by what they are of."""
        groups: dict[str, list[Embedded]] = {}
        for picture in self.pictures:
            groups.setdefault(picture.codec, []).append(picture)
        return list(groups.items())


def data_uri(pixels: Image.Image) -> str:
    """An image as lossless WebP in a data URI."""
    data = BytesIO()
    # Colours of transparent pixels are kept as well.
    pixels.save(data, format="webp", lossless=True, exact=True, method=EFFORT)
    return "data:image/webp;base64," + base64.b64encode(data.getvalue()).decode("ascii")


def small_uri(pixels: np.ndarray) -> str:
    """Pixels of shape (height, width, 4), uint8, in a data URI."""
    return data_uri(Image.fromarray(pixels))


def _read(codec: str, kind: str, path: Path) -> Embedded | None:
    """A picture file; None where it is damaged or larger than a page can show."""
    try:
        with Image.open(path, formats=["PNG"]) as image:
            if image.width * image.height > MAX_PIXELS:
                return None
            uri = data_uri(image if image.mode in ("RGB", "RGBA") else image.convert("RGB"))
            return Embedded(codec, kind, image.width, image.height, uri)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None


def in_order(found: Found) -> list[PictureSet]:
    """Whose pictures come first: the two best of each number of bits and the preferred ones, then the others; fewest
    bits first, the best of those first."""
    rows = {CodecKey.of(row): row for row in found.tables.get("quality", ()) if _is_judged(row)}

    def place(pictures: PictureSet) -> tuple[bool, int, bool, float]:
        row = rows.get(pictures.key)
        if row is None:
            return True, 0, True, 0.0
        better = sum(r["bits"] == row["bits"] and r["psnr_db"] > row["psnr_db"] for r in rows.values())
        asked = pictures.key in found.preferred
        return better > 1 and not asked, row["bits"], not asked, -row["psnr_db"]

    return sorted(found.pictures, key=place)


def _is_judged(row: Row) -> bool:
    return is_count(row.get("bits")) and is_number(row.get("psnr_db"))


def gallery(found: Found, budget: int = BUDGET) -> Gallery:
    """The pictures of as many codecs as fit, all of a codec's or none."""
    several = len({pictures.normals for pictures in found.pictures}) > 1
    wanted: list[tuple[str, Mapping[str, Path]]] = []
    for name, path in found.originals.items():
        wanted.append((f"the normals of {name}", {"normals": path}))
    for pictures in in_order(found):
        wanted.append((pictures.key.label + (f" on {pictures.normals}" if several else ""), pictures.files))
    taken, left_out, damaged, used = [], [], [], 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for label, files in wanted:
            if used >= budget:
                left_out.append(label)
                continue
            made = list(pool.map(lambda item, label=label: _read(label, *item), files.items()))
            good = [picture for picture in made if picture]
            size = sum(len(picture.uri) for picture in good)
            if used + size > budget:
                left_out.append(label)
                used = budget
            else:
                taken, used = taken + good, used + size
            damaged += [label] if len(good) < len(made) else []
    return Gallery(taken, left_out, damaged)
