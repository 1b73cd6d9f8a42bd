"""Pictures of codecs on an image set: writing them to a folder, and finding them there again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.storages.words import words
from ....reports.charts import pictures
from ....reports.page.codec_key import CodecKey
from ....reports.page.pixels import MAX_PIXELS, NormalPixels, Pictured, Subject, angle_bytes, read_png
from ....reports.page.verdict import LEADING, is_count, is_number
from ...ground.angles import angles_deg
from ...ground.output.arrays import DamagedError, read_npz
from ...ground.output.writing import files_of, whole_file
from ...measures.live.scenes import write_scene
from ...measures.metrics import published
from ..table import Row
from . import measure

KINDS = ("encoded", "decoded", "error", "power")
PIXELS = ("angle", "codes", "bits")
# Of those arrays: a byte for the angle, and at most three numbers of 32 bits.
MOST_BYTES = MAX_PIXELS * 13 + 2**16


def stem(normals: str, key: CodecKey) -> str:
    """Return the start of a codec's file names for a set, without the kind of file; the slash in the name of a chain
    is replaced."""
    parts = [normals, key.encoding, key.storage, *([] if key.rounding == "nearest" else [key.rounding])]
    return "-".join(parts).replace("/", "_in_")


def write(chosen: Sequence[measure.QualityCase], folder: Path) -> None:
    """Write the pictures of each codec and of each image set's exact normals."""
    _write_codecs(chosen, folder)
    _write_originals(chosen, folder)


def _write_codecs(chosen: Iterable[measure.QualityCase], folder: Path) -> None:
    """Write four PNG files and, unless the image is too large, an array file for each codec on each image set. The
    pixels come from a shader backend if one was requested and can measure them."""
    wanted = {(c.normal_set.name, c.codec): c for c in sorted(chosen, key=lambda c: c.backend, reverse=True)}
    for (normals, codec), case in wanted.items():
        if not case.normal_set.shape:
            continue
        trip = _round_trip(case)
        if not trip:
            continue
        name = stem(normals, CodecKey(codec.encoding.name, codec.storage.name, codec.rounding))
        images = pictures.codec_pictures(trip.normals, trip.encoded, trip.decoded, trip.covered)
        for kind, pixels in images.items():
            _write_png(folder / f"{name}-{kind}.png", pixels)
        if trip.covered.size <= MAX_PIXELS:
            _write_pixels(folder / f"{name}.npz", codec, trip)


def _round_trip(case: measure.QualityCase) -> measure.RoundTrip | None:
    """Return the round trip by the case's backend, otherwise by JAX; None if neither can compute it."""
    for backend in dict.fromkeys((case.backend, "jax")):
        with suppress(*measure.UNMEASURABLE):
            return measure.image_round_trip(replace(case, backend=backend))
    return None


def _write_png(path: Path, pixels: np.ndarray) -> None:
    with whole_file(path) as partial:
        pictures.write_png(partial, pixels)


def _write_pixels(path: Path, codec: Codec, trip: measure.RoundTrip) -> None:
    """Write the angular error and the stored bits of every pixel to an array file (.npz)."""
    with np.errstate(invalid="ignore"):
        angle = angle_bytes(angles_deg(trip.normals, trip.decoded), trip.covered)
    codes, bits = _codes_and_bits(codec, trip.encoded)
    with whole_file(path) as partial, partial.open("wb") as file:
        small = codes.astype(np.min_scalar_type(2 ** max(bits) - 1))
        np.savez_compressed(file, angle=angle, codes=small, bits=np.array(bits, np.uint8))


def _codes_and_bits(codec: Codec, encoded: np.ndarray) -> tuple[np.ndarray, list[int]]:
    """Return the stored bits of every component, uint32 of shape (height, width, components), and the bit count of
    each component. A sign bit is 1 for +1."""
    stored = codec.encoding.components
    planes = [words(encoded[..., i], codec.storage, i) for i in range(stored)]
    planes += [(encoded[..., stored + i] > 0).astype(np.uint32) for i in range(codec.encoding.sign_bits)]
    return np.stack(planes, axis=-1), [*codec.storage.bits[:stored], *[1] * codec.encoding.sign_bits]


def _write_originals(chosen: Sequence[measure.QualityCase], folder: Path) -> None:
    """Write a picture of the exact normals of each image set."""
    for case in {case.normal_set.name: case for case in chosen if case.normal_set.shape}.values():
        n, covered = measure.image_of(case.normal_set)
        _write_png(folder / f"{case.normal_set.name}-normals.png", pictures.normals_picture(n, covered))


def write_scenes(chosen: Sequence[measure.QualityCase], folder: Path) -> None:
    """Write the normals of each image set in the format that a page's laboratory reads."""
    for case in {case.normal_set.name: case for case in chosen if case.normal_set.shape}.values():
        write_scene(case.normal_set.name, *measure.seen(case.normal_set), folder)


def subjects(folder: Path, rows: Sequence[Row]) -> Iterator[Subject]:
    """Yield a subject for each set of normals in the rows, if the folder has its pictures. File names are looked up
    in the folder, so that they cannot lead out of it."""
    there = files_of(folder)
    for normals in dict.fromkeys(str(row.get("normals")) for row in rows):
        original = there.get(f"{normals}-normals.png")
        part = [row for row in rows if str(row.get("normals")) == normals]
        ranked = in_order(part).items()
        codecs = [p for key, rank in ranked if (p := _pictured(there, stem(normals, key), key, rank))]
        if original and codecs:
            yield Subject(f"the normals of {normals}", "normals", partial(read_png, original), codecs)


def _pictured(there: dict[str, Path], name: str, key: CodecKey, rank: int) -> Pictured | None:
    """Return a codec's pictures for the page; None if one of its files is missing."""
    arrays, decoded = there.get(f"{name}.npz"), there.get(f"{name}-decoded.png")
    return Pictured(key, key.label, key.label, partial(_pixels, arrays, decoded), rank) if arrays and decoded else None


def in_order(rows: Sequence[Row]) -> dict[CodecKey, int]:
    """Return the rank of each codec in the rows of one set, ordered by bits and then by accuracy. Rank 0 is the best
    codec at each number of bits, and the second best at the fewest bits; 1 the second best at other numbers of bits;
    2 codecs from the article; 3 all others."""
    figures = {CodecKey.of(row): row for row in rows if is_count(row.get("bits")) and is_number(row.get(LEADING))}
    ranks: dict[CodecKey, int] = {}
    for key, row in sorted(figures.items(), key=lambda item: (item[1]["bits"], -item[1][LEADING])):
        better = sum(figures[other]["bits"] == row["bits"] for other in ranks)
        ranks[key] = 0 if len(ranks) < 2 else better if better < 2 else 2 if key in ARTICLES else 3
    return ranks


ARTICLES = {CodecKey(name, published.STORAGE, "nearest") for name in published.PICTURED}


def _pixels(arrays: Path, decoded: Path) -> NormalPixels | None:
    """Return a codec's pixels from its files; None if the files are damaged or do not match."""
    try:
        angle, codes, bits = read_npz(arrays, PIXELS, MOST_BYTES)
    except (OSError, DamagedError):
        return None
    pixels = read_png(decoded)
    is_right = angle.dtype == np.uint8 and codes.dtype.kind == "u" and bits.dtype == np.uint8
    shapes = pixels is not None and pixels.shape[:2] == angle.shape == codes.shape[:2] and codes.shape[2:] == bits.shape
    known = is_right and shapes and len(bits) and max(bits) <= 32
    return NormalPixels(angle, codes, tuple(map(int, bits)), pixels) if known and pixels is not None else None
