"""Pictures for the encodings that an answer names: writing them into a folder, and finding them there again."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ....encodings.codecs.codec import codec_name
from ....gbuffer.layouts.words import LayoutError
from ....reports.charts import pictures
from ....reports.page.codec_key import CodecKey
from ....reports.page.pixels import ImagePixels, Pictured, Subject, read_png
from ...ground.output.writing import files_of, whole_file
from ...measures.images.turns import VIEW_SPACE
from .. import shots
from ..table import Row
from .answer import AGAINST, BEST, CHEAPER, FEWER_BITS, MORE_EXACT, MOST_EXACT, images, places_of

if TYPE_CHECKING:
    from .images import Images
    from .measure import PickCase

# The answer and what stands next to it are what a reader sees first.
FIRST = 2
PLACES = (BEST, AGAINST, MORE_EXACT, MOST_EXACT, CHEAPER, FEWER_BITS)


def write(folder: Path, chosen: Sequence[PickCase], rows: Sequence[Row], drawing: Images) -> None:
    """Write PNG images for every encoding that has a place in the answer, and for exact normals; encodings that the
    device does not support are left out."""
    poles = {CodecKey.of(row): row.get("image_pole") or VIEW_SPACE for row in rows}
    for case, maker in ((pick_case, maker) for pick_case in placed(chosen, rows) for maker in pick_case.makers):
        # A code that the device has no room for has no image.
        with suppress(LayoutError, *shots.UNMEASURABLE):
            for power, (image, exact) in drawing.shown(case, maker, poles[_key_of_case(case)]).items():
                scene = _scene_stem(maker.name, "" if power is None else f"{power:g}")
                _write(folder / f"{scene}-reference.png", exact)
                _write(folder / _file_name(scene, _key_of_case(case)), image)


def placed(chosen: Sequence[PickCase], rows: Sequence[Row]) -> Iterator[PickCase]:
    """Yield the cases whose codec the answer names, except in other storages of the same bytes."""
    named = {CodecKey.of(row) for row in rows if set(places_of(row)) & set(PLACES)}
    return _among(chosen, named)


def eligible(chosen: Sequence[PickCase], rows: Sequence[Row]) -> Iterator[PickCase]:
    """Yield the cases whose codec is not left out, except in other storages of the same bytes."""
    return _among(chosen, {CodecKey.of(row) for row in rows if not row["left_out"]})


def _among(chosen: Sequence[PickCase], keys: Container[CodecKey]) -> Iterator[PickCase]:
    return (case for case in chosen if not case.is_beside and _key_of_case(case) in keys)


def _key_of_case(case: PickCase) -> CodecKey:
    return CodecKey(case.codec.encoding.name, case.codec.storage.name, str(case.said["rounding"]))


def _file_name(scene: str, key: CodecKey) -> str:
    return f"{scene}-{codec_name(key.encoding, key.storage, key.rounding).replace('/', '-')}-final.png"


def _scene_stem(name: str, power: str) -> str:
    return f"pick-{name}-power{power}" if power else f"pick-{name}"


def _write(path: Path, image: np.ndarray) -> None:
    with whole_file(path) as partial:
        pictures.write_png(partial, pictures.picture(image))


def subjects(folder: Path, rows: Sequence[Row]) -> Iterator[Subject]:
    """Yield a subject for each scene and power, the highest power first, with the pictures in a folder: the codecs by
    storage and place."""
    there = files_of(folder)
    storages = list(dict.fromkeys(row.get("storage") for row in rows))
    kept = [row for row in rows if set(places_of(row)) & set(PLACES)]
    placed = sorted(kept, key=lambda row: (storages.index(row["storage"]), _place_index(row)))
    drawn = dict.fromkeys(key for row in placed for key in images(row))
    scenes = list(dict.fromkeys(scene for scene, _ in drawn))
    for scene, power in sorted(drawn, key=lambda key: (scenes.index(key[0]), -float(key[1] or 0))):
        stem = _scene_stem(scene, power)
        exact = there.get(f"{stem}-reference.png")
        paths = {key: there.get(_file_name(stem, key)) for key in map(CodecKey.of, placed)}
        known = [Pictured(key, key.label, key.label, partial(_pixels, path)) for key, path in paths.items() if path]
        if exact and known:
            where = f"{scene} at power {power}" if power else scene
            yield Subject(f"the answer on {where}", "image", partial(read_png, exact), known, FIRST)


def _place_index(row: Row) -> int:
    return min(PLACES.index(word) for word in places_of(row) if word in PLACES)


def _pixels(path: Path) -> ImagePixels | None:
    image = read_png(path)
    return None if image is None else ImagePixels(image, None)
